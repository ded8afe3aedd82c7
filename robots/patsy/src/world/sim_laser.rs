use super::{Cart, Scenario, motion::Motion, room::furnish};
use apex_nodes::scan::{Point2, Pose2, Scan};
use apex_rt::{Ctx, Event, Out, node};
use apex_sim::{Laser, Random, World};
use core::f32::consts::{FRAC_PI_2, PI};
use serde::{Deserialize, Serialize};

/// Ground truth during a scan.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Scenario of the run.
    pub scenario: Scenario,
    /// Pose of the container's centre in the frame of the scanner, if there is a container.
    pub container: Option<Pose2>,
}

/// Simulated laser scanner in rooms with and without a container cart: a source.
///
/// Plays all scenarios in sequence with `runs` runs each. Every run has its own room and motion. Triggers `command`,
/// the operator's command to begin, with each run, and `done` after the last one. Afterwards it sends ⊥.
#[node]
#[derive(Debug)]
pub struct SimLaser {
    /// Seed of rooms, motions and noise.
    #[param(default = 1)]
    seed: u64,
    /// Number of runs per scenario.
    #[param(default = 20, range = 1..=100_000)]
    runs: u32,
    /// Number of scans per run.
    #[param(default = 50, range = 2..=100_000)]
    frames: u32,
    /// Angle between the first and the last beam.
    #[param(unit = "rad", default = 1.5 * PI, range = 0.1..=6.3)]
    field_of_view: f32,
    /// Angle between consecutive beams.
    #[param(unit = "rad", default = PI / 360.0, range = 0.001..=0.1)]
    resolution: f32,
    /// Standard deviation of a range.
    #[param(unit = "m", default = 0.01, range = 0.0..=1.0)]
    noise: f32,
    /// Probability that a beam measures nothing.
    #[param(default = 0.005, range = 0.0..=1.0)]
    dropout: f32,
    run: Option<Run>,
    runs_started: u64,
    finished: bool,
}

#[node]
impl SimLaser {
    fn process(
        &mut self,
        ctx: &Ctx,
        scan: &mut Out<Scan>,
        truth: &mut Out<Truth>,
        pose: &mut Out<Pose2>,
        command: Event<()>,
        done: Event<()>,
    ) {
        if self.finished {
            return;
        }
        if self.run.as_ref().is_none_or(|run| run.frame >= self.frames) {
            self.run = self.next_run();
            if self.run.is_some() {
                command.emit(());
            }
        }
        let laser = self.laser();
        let Some(run) = &mut self.run else {
            self.finished = true;
            done.emit(());
            return;
        };
        let container = run.advance(self.frames);
        let measured = scan.get_mut();
        measured.stamp = ctx.now();
        laser.measure(&run.world, &Pose2::default(), &mut run.random, measured);
        truth.set(Truth { scenario: run.scenario, container });
        if let Some(container) = container {
            pose.set(container);
        }
    }

    /// Returns `true` if all runs have been played.
    pub fn finished(&self) -> bool {
        self.finished
    }

    fn next_run(&mut self) -> Option<Run> {
        let number = self.runs_started;
        self.runs_started += 1;
        let index = usize::try_from(number / u64::from(self.runs.max(1))).ok()?;
        let scenario = *Scenario::ALL.get(index)?;
        // A random stream for each run, so that one run does not change the next.
        let mut seeds = Random::new(self.seed);
        let mut random = Random::new(seeds.bits() ^ Random::new(number).bits());
        Some(Run::new(scenario, &mut random))
    }

    fn laser(&self) -> Laser {
        Laser {
            field_of_view: self.field_of_view,
            resolution: self.resolution,
            noise: self.noise,
            dropout: self.dropout,
            ..Laser::default()
        }
    }
}

/// One run: a room, possibly with a cart that moves in it.
#[derive(Debug)]
struct Run {
    scenario: Scenario,
    frame: u32,
    random: Random,
    room: World,
    moving: Option<(Motion, Cart)>,
    /// Room with the cart at its present pose.
    world: World,
}

impl Run {
    fn new(scenario: Scenario, random: &mut Random) -> Self {
        let motion = Motion::random(scenario, random);
        let way: Vec<Point2> =
            motion.iter().flat_map(|m| (0..=20).map(|i| m.pose(i as f32 / 20.0).position())).collect();
        let mut room = World::default();
        furnish(&mut room, &way, random);
        let moving = motion.map(|motion| {
            let start = motion.pose(0.0);
            // Between straight ahead and across, like a cart that was left there.
            let castors = [0; 4].map(|_| start.theta + random.uniform(-FRAC_PI_2, FRAC_PI_2));
            (motion, Cart::new(start, castors))
        });
        Self { scenario, frame: 0, random: random.clone(), room, moving, world: World::default() }
    }

    /// Advances to the next of `frames` frames, and returns the pose of the cart.
    fn advance(&mut self, frames: u32) -> Option<Pose2> {
        let t = self.frame as f32 / frames.saturating_sub(1).max(1) as f32;
        self.frame += 1;
        self.world.clone_from(&self.room);
        let (motion, cart) = self.moving.as_mut()?;
        cart.move_to(motion.pose(t));
        cart.add_to(&mut self.world);
        Some(cart.pose())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct, Time};

    fn node(seed: u64) -> SimLaser {
        SimLaser::construct((seed, 2, 3, 1.5 * PI, PI / 360.0, 0.01, 0.005))
    }

    type Firing = (Option<Scan>, Option<Truth>, Option<Pose2>, bool);

    fn fire(node: &mut SimLaser, ms: i64) -> Firing {
        let (mut scan, mut truth, mut pose, mut done) = (Out::new(), Out::new(), Out::new(), None);
        let ctx = Ctx::new(Time::from_millis(ms));
        node.process(&ctx, &mut scan, &mut truth, &mut pose, Event::unconnected(), apex_rt::event(&mut done));
        (scan.get().cloned(), truth.get().copied(), pose.get().copied(), done.is_some())
    }

    #[test]
    fn plays_every_scenario_and_ends_once() {
        let mut node = node(1);
        for i in 0..30 {
            let (scan, truth, pose, done) = fire(&mut node, i);
            let truth = truth.expect("a truth with every scan");
            assert_eq!(truth.scenario, Scenario::ALL[i as usize / 6]);
            assert_eq!(scan.expect("a scan").stamp, Time::from_millis(i));
            assert_eq!((pose, truth.container.is_some()), (truth.container, truth.scenario != Scenario::Empty));
            assert!(!done && !node.finished());
        }
        assert_eq!(fire(&mut node, 30), (None, None, None, true));
        assert!(node.finished());
        assert_eq!(fire(&mut node, 31), (None, None, None, false));
    }

    #[test]
    fn the_same_seed_plays_the_same() {
        let (mut a, mut b, mut c) = (node(5), node(5), node(6));
        let all = |node: &mut SimLaser| (0..30).map(|i| fire(node, i).1).collect::<Vec<_>>();
        assert_eq!(all(&mut a), all(&mut b));
        assert_ne!(all(&mut node(5)), all(&mut c));
    }
}
