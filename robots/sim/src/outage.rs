//! Sensors that fail at random times, and how long a robot moves without them. What counts is the true motion of the
//! simulated robot, whose base should keep the last twist.

use crate::Random;
use apex_nodes::nav::Twist;
use apex_rt::Time;
use std::{fmt, time::Duration};

/// Speed, in m/s, and angular velocity, in rad/s, up to which a robot stands.
const STANDS: [f32; 2] = [0.01, 0.02];
/// Duration of an outage, and of the time between two of them, in s.
const SECONDS: [f32; 2] = [1.0, 6.0];

/// Kind of a fault, and what a robot promises about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Promise {
    /// Name of the fault.
    pub fault: &'static str,
    /// Period of the sensor.
    pub period: Duration,
    /// Behaviour of the robot without the sensor.
    pub stops: Stops,
}

/// Behaviour of a robot without a sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stops {
    /// It stands from this time after the last good measurement on.
    Within(Duration),
    /// Each of its motions ends within this time. After a pause it tries again, as it cannot tell whether it moves.
    Tries(Duration),
    /// It does not need the sensor to drive.
    No,
}

/// Time in which a sensor has a fault.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outage {
    /// Number of the [`Promise`].
    pub kind: usize,
    /// Start of the fault.
    pub from: Time,
    /// End of the fault.
    pub until: Time,
}

/// Outages at random times of a run, one after the other, each of one of so many kinds.
pub fn outages(seed: u64, kinds: usize, [start, end]: [Time; 2]) -> Vec<Outage> {
    let mut random = Random::new(seed.wrapping_mul(0x9e37_79b9).wrapping_add(57));
    let pause = |random: &mut Random| Duration::from_millis((1e3 * random.uniform(SECONDS[0], SECONDS[1])) as u64);
    let (mut outages, mut now) = (vec![], start);
    if kinds == 0 {
        return outages;
    }
    loop {
        let from = now + pause(&mut random);
        let until = from + pause(&mut random);
        if until > end {
            return outages;
        }
        outages.push(Outage { kind: (random.bits() % kinds as u64) as usize, from, until });
        now = until;
    }
}

/// Measures how long a robot moves in outages.
#[derive(Debug, Clone)]
pub struct MotionWatch {
    promises: Vec<Promise>,
    outages: Vec<Outage>,
    /// Time since which the robot moves.
    since: Option<Time>,
    /// Longest motion in each outage; none if it did not move.
    longest: Vec<Option<Duration>>,
}

impl MotionWatch {
    /// Creates a watch for a run with these outages.
    pub fn new(promises: &[Promise], outages: Vec<Outage>) -> Self {
        let longest = vec![None; outages.len()];
        Self { promises: promises.to_vec(), outages, since: None, longest }
    }

    /// Notes the true velocity of the robot at a time.
    pub fn see(&mut self, now: Time, twist: &Twist) {
        if twist.velocity().norm() <= STANDS[0] && twist.omega.abs() <= STANDS[1] {
            self.since = None;
            return;
        }
        let since = *self.since.get_or_insert(now);
        let present = self.outages.iter().position(|outage| outage.from <= now && now < outage.until);
        let Some(index) = present else { return };
        let Outage { kind, from, .. } = self.outages[index];
        let Promise { period, stops, .. } = self.promises[kind];
        let last = last_before(from, period);
        let begin = if matches!(stops, Stops::Tries(_)) { last.max(since) } else { last };
        let longest = &mut self.longest[index];
        *longest = (*longest).max(Some(now.since(begin)));
    }

    /// Outages in which the robot moved longer than it promises, with the length of that motion.
    pub fn broken(&self) -> Vec<(Outage, Duration)> {
        let all = self.outages.iter().zip(&self.longest);
        let is_broken = |outage: &Outage, longest| self.promises[outage.kind].is_broken_by(longest);
        all.filter_map(|(outage, longest)| longest.filter(|time| is_broken(outage, *time)).map(|time| (*outage, time)))
            .collect()
    }
}

/// Time of the last measurement before a fault.
fn last_before(from: Time, period: Duration) -> Time {
    let nanos = i64::try_from(period.as_nanos()).unwrap_or(i64::MAX).max(1);
    Time::from_nanos((from.as_nanos() - 1).div_euclid(nanos) * nanos)
}

impl Promise {
    fn is_broken_by(&self, time: Duration) -> bool {
        match self.stops {
            Stops::Within(stated) | Stops::Tries(stated) => time > stated,
            Stops::No => false,
        }
    }
}

/// Table of many runs: what the robot promises about each kind of outage, and what it did.
#[derive(Debug)]
pub struct OutageTable<'a>(pub &'a [MotionWatch]);

impl fmt::Display for OutageTable<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(first) = self.0.first() else { return Ok(()) };
        writeln!(
            f,
            "{:<22}{:<24}{:>8}{:>8}{:>8}{:>10}",
            "fault", "promised", "outages", "moving", "longer", "longest"
        )?;
        for (kind, promise) in first.promises.iter().enumerate() {
            let of_run = |watch: &MotionWatch| {
                let all = watch.outages.clone().into_iter().zip(watch.longest.clone());
                all.filter(|(outage, _)| outage.kind == kind).map(|(_, longest)| longest).collect::<Vec<_>>()
            };
            let times: Vec<Option<Duration>> = self.0.iter().flat_map(of_run).collect();
            let moving: Vec<Duration> = times.iter().copied().flatten().collect();
            let longer = moving.iter().filter(|time| promise.is_broken_by(**time)).count();
            let longest = moving.iter().max().map_or("-".to_owned(), |time| format!("{:.2} s", time.as_secs_f64()));
            let promised = promise.stops.to_string();
            write!(f, "{:<22}{promised:<24}{:>8}{:>8}", promise.fault, times.len(), moving.len())?;
            writeln!(f, "{longer:>8}{longest:>10}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Stops {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Within(time) => write!(f, "stands after {:.2} s", time.as_secs_f64()),
            Self::Tries(time) => write!(f, "moves {:.2} s at a time", time.as_secs_f64()),
            Self::No => f.write_str("drives on"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    static PROMISES: [Promise; 3] = [
        Promise { fault: "blind", period: ms(100), stops: Stops::Within(ms(500)) },
        Promise { fault: "frozen", period: ms(100), stops: Stops::Tries(ms(500)) },
        Promise { fault: "deaf", period: ms(100), stops: Stops::No },
    ];

    /// Watch of a fault from 2 s to 4 s. The robot moves up to `until`, and from 3 s to 3.2 s again.
    fn watch(kind: usize, until: i64) -> MotionWatch {
        let outage = Outage { kind, from: Time::from_secs(2), until: Time::from_secs(4) };
        let mut watch = MotionWatch::new(&PROMISES, vec![outage]);
        for now in (0..5000).step_by(10) {
            let moves = now < until || (3000..3200).contains(&now);
            watch.see(Time::from_millis(now), &Twist::new(0.0, 0.0, if moves { 0.5 } else { 0.01 }));
        }
        watch
    }

    #[test]
    fn the_time_counts_from_the_last_measurement_before_the_fault() {
        for (kind, until, longest) in [(0, 1000, 1290), (1, 1000, 190), (1, 2410, 500), (1, 2500, 590), (2, 2500, 1290)]
        {
            let watch = watch(kind, until);
            assert_eq!(watch.longest, [Some(ms(longest))], "{kind} {until}");
            assert_eq!(watch.broken().len(), usize::from(kind < 2 && longest > 500), "{kind} {until}");
        }
        let text = OutageTable(&[watch(1, 2500), watch(1, 1000)]).to_string();
        let row = "frozen                moves 0.50 s at a time         2       2       1    0.59 s\n";
        assert!(text.contains(row), "{text}");
    }

    #[test]
    fn outages_differ_by_seed_and_do_not_overlap() {
        let run = [Time::from_secs(1), Time::from_secs(60)];
        let all: Vec<Vec<Outage>> = (0..50).map(|seed| outages(seed, 3, run)).collect();
        assert!(all.iter().all(|of| of.len() >= 4 && of.windows(2).all(|pair| pair[0].until < pair[1].from)));
        assert!(all.windows(2).all(|pair| pair[0] != pair[1]) && all[7] == outages(7, 3, run));
        assert_eq!(outages(1, 0, run), []);
    }
}
