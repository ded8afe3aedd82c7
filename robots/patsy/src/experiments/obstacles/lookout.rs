use crate::{
    lookout::LookOut,
    world::{Scene, Thing, tractor},
};
use apex_nodes::{
    nav::Twist,
    persons::Persons,
    scan::{Pose2, Scan},
};
use apex_rt::Time;
use core::{f32::consts::PI, fmt};

/// End of a drive straight on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It stopped.
    Stopped,
    /// It drove over the thing.
    RunOver,
    /// It did not meet anything.
    Passed,
}

/// Period of the program in ms, and number of periods between two clouds.
const PERIOD: i64 = 80;
const CLOUD: i64 = 3;
/// Steps of the simulation in a period.
const STEPS: u8 = 4;
/// Distance of the thing, and of the end of the way, in m.
const PLACE: f32 = 3.0;
const END: f32 = 3.6;
/// Time after which a vehicle that is not at the end has stopped, in s.
const LONGEST: f32 = 20.0;
/// Greatest distance of the thing from the middle of the way, in m.
const ASIDE: f32 = 0.18;

/// Drives towards a thing that lies in the way, in a random direction, or over a free floor.
pub fn drive_on(thing: Option<Thing>, speed: f32, seed: u64) -> Outcome {
    let mut scene = Scene::new(seed);
    scene.camera.rays = 2;
    let place = Pose2::new(PLACE, scene.uniform(ASIDE), scene.uniform(PI));
    if let Some(thing) = thing {
        scene.place_at(thing, &place);
    }
    let mut vehicle = tractor(Pose2::default());
    let mut program = Box::new(LookOut::new());
    for period in 0..(LONGEST * 1000.0) as i64 / PERIOD {
        let now = Time::from_millis(period * PERIOD);
        let (base, trailer) = (vehicle.base.pose, vehicle.trailer_pose());
        let inputs = program.inputs();
        // All inputs are empty: the last reaction has taken the tokens.
        if period % CLOUD == 0 {
            let _ = inputs.cloud.put(scene.take_from(&base, now).cloud);
        }
        let _ = (inputs.odometry.put(base), inputs.trailer.put(trailer), inputs.twist.put(Twist::new(speed, 0.0, 0.0)));
        let _ = (inputs.scan.put(open(now)), inputs.persons.put(Persons::default()));
        program.react(now);
        let twist = program.outputs().limited.unwrap_or_default();
        for _ in 0..STEPS {
            vehicle.step(&twist, PERIOD as f32 * 1e-3 / f32::from(STEPS));
        }
        let parts = vehicle.footprints();
        if thing.is_some() && parts.iter().any(|part| part.distance(place.position()) <= 0.0) {
            return Outcome::RunOver;
        }
        if vehicle.base.pose.x > END {
            return Outcome::Passed;
        }
    }
    Outcome::Stopped
}

/// Scan of a scanner that works and has nothing within range.
fn open(stamp: Time) -> Scan {
    let mut scan = Scan { stamp, ..Scan::default() };
    scan.ranges.extend([f32::INFINITY]);
    scan
}

/// Outcomes by thing.
#[derive(Debug, Clone, Default)]
pub struct LookoutTable {
    /// Thing, if there was one, and outcome.
    pub drives: Vec<(Option<Thing>, Outcome)>,
}

impl LookoutTable {
    /// Things of the rows, and nothing in the last one.
    pub fn things() -> impl Iterator<Item = Option<Thing>> {
        Thing::LITTLE.map(Some).into_iter().chain([None])
    }

    fn count(&self, thing: Option<Thing>, outcome: Outcome) -> usize {
        self.drives.iter().filter(|drive| **drive == (thing, outcome)).count()
    }
}

impl fmt::Display for LookoutTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<16}{:>10}{:>10}{:>10}", "drives towards", "stopped", "run over", "passed")?;
        for thing in Self::things() {
            let name = thing.map_or_else(|| "nothing".to_owned(), |thing| format!("{thing:?}").to_lowercase());
            write!(f, "\n{name:<16}")?;
            for outcome in [Outcome::Stopped, Outcome::RunOver, Outcome::Passed] {
                write!(f, "{:>10}", self.count(thing, outcome))?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_stops_before_a_glass_but_not_before_nothing() {
        assert_eq!(drive_on(Some(Thing::Glass), 0.7, 1), Outcome::Stopped);
        assert_eq!(drive_on(None, 0.7, 1), Outcome::Passed);
    }

    #[test]
    fn the_table_counts_each_thing_apart() {
        let table = LookoutTable { drives: vec![(Some(Thing::Cable), Outcome::RunOver), (None, Outcome::Passed)] };
        let text = table.to_string();
        let row = |name| text.lines().find(|line| line.starts_with(name)).expect("a row").split_whitespace().skip(1);
        assert!(row("cable").eq(["0", "1", "0"]) && row("nothing").eq(["0", "0", "1"]), "{text}");
    }
}
