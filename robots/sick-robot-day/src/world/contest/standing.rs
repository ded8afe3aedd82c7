use super::{Hall, Report, START};
use apex_rt::{Ctx, Outputs, Time, node};
use apex_sim::NotLevel;

/// Hall of a seed: a source that sends it once. Drivers that get it are in the same hall.
#[node]
#[derive(Debug)]
pub struct OpenHall {
    /// Seed of the hall.
    #[param(default = 1)]
    seed: u64,
    is_open: bool,
}

#[node]
impl OpenHall {
    fn process(&mut self) -> Result<Option<Hall>, NotLevel> {
        let is_new = !core::mem::replace(&mut self.is_open, true);
        is_new.then(|| Hall::new(self.seed, vec![])).transpose()
    }
}

/// Standing of our robot in a hall: a source.
#[node]
#[derive(Debug)]
pub struct Scoreboard {
    hall: Option<Hall>,
}

/// Standing of our robot.
#[derive(Debug, Clone, Copy, PartialEq, Default, Outputs)]
pub struct Standing {
    /// Number of cubes delivered to the right station.
    pub points: Option<u64>,
    /// Number of cubes delivered to another station, and of collisions that our robot caused.
    pub faults: Option<u64>,
    /// Mean time from one cube that was put in or taken out to the next; the present one counts as soon as it takes
    /// longer.
    #[unit("s")]
    pub pace: Option<f64>,
}

#[node]
impl Scoreboard {
    /// Enters a hall.
    #[slot]
    fn hall(&mut self, hall: &Hall) {
        self.hall = Some(hall.clone());
    }

    fn process(&mut self, ctx: &Ctx) -> Standing {
        let Some(hall) = &self.hall else { return Standing::default() };
        let contest = hall.at(ctx.now());
        let report = contest.report();
        Standing {
            points: Some(report.points() as u64),
            faults: Some((report.penalties() + report.caused()) as u64),
            pace: Some(pace(report, ctx.now())),
        }
    }
}

fn pace(report: &Report, now: Time) -> f64 {
    let seconds = |time: Time| time.since(START).as_secs_f64();
    let served = report.fetches.len() + report.deliveries.len();
    let last = report.fetches.iter().copied().chain(report.deliveries.iter().map(|delivery| delivery.at)).max();
    let so_far = last.map_or(0.0, |last| seconds(last) / served as f64);
    so_far.max(seconds(now) / (served + 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::contest::Delivery;

    #[test]
    fn the_pace_is_that_of_the_last_service_or_of_the_one_that_takes_longer() {
        let at = Time::from_secs;
        let mut report = Report::default();
        assert_eq!(pace(&report, at(31)), 30.0);
        report.fetches.push(at(41));
        assert_eq!(pace(&report, at(42)), 40.0);
        report.deliveries.push(Delivery { at: at(61), station: 1, cube: 1 });
        assert_eq!(pace(&report, at(70)), 30.0);
        assert_eq!(pace(&report, at(121)), 40.0);
    }
}
