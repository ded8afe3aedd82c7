use super::{Belief, Contact, Ending, Fault, FaultKind, Loss, Report};
use apex_nodes::{
    frames::{Pose3, Rotation},
    localize::TangentPlane,
    nav::Twist,
    persons::Person,
    scan::{Point2, Pose2, wrap_angle},
};
use apex_rt::Time;
use apex_sim::{
    HeldTwist, Limits, Random, Shared, Simulation,
    outdoor::{
        Attitude, Gnss, GnssErrors, Imu, ImuErrors, Passersby, Runner, Sample, SkidBase, SkidShape, Terrain, Track,
        Walker,
    },
};
use std::{collections::VecDeque, time::Duration};

/// Step of the simulation.
const STEP: Duration = Duration::from_millis(10);
/// Number of poses that are kept for a turn of the scanner of 100 ms.
const SAMPLES: usize = 11;
/// Time without a twist after which the motors brake.
const COMMAND_TIMEOUT: Duration = Duration::from_millis(300);
/// Limits of the base.
const LIMITS: Limits = Limits { speed: 3.0, acceleration: 2.5, turn: 3.0, turn_acceleration: 8.0 };
/// Distance of the robot behind the runner at the beginning, in m.
const BEHIND: f32 = 4.0;
/// Distance of the place at which the robot believes the runner to be, up to which it knows it, in m.
const KNOWS: f32 = 1.5;
/// Depth of a ditch in which a wheel is stuck, in m.
const STUCK: f32 = 0.25;
/// Speed from which on the robot drives, in m/s.
const DRIVES: f32 = 0.05;
/// Time in which the robot comes to a runner who has arrived, and after which a runner is lost for good.
const COMES: Duration = Duration::from_secs(10);
const FOR_GOOD: f32 = 60.0;
/// Distance of a robot that has come, in m.
const WITH: f32 = 6.0;

/// Latitude and longitude of the origin of the world, in rad: 48.53° north, 9.06° east.
const ORIGIN: [f64; 2] = [0.847_008, 0.158_127];

/// Options of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Seed of the country, the runner, the passers-by and all noise.
    pub seed: u64,
    /// Length of the track, in m.
    pub length: f32,
    /// `true` if people cross the track, and stand beside it.
    pub people: bool,
    /// Fault of a sensor.
    pub fault: Option<Fault>,
}

/// A track of 1.7 km with people.
impl Default for Options {
    fn default() -> Self {
        Self { seed: 1, length: 1700.0, people: true, fault: None }
    }
}

/// World of one seed.
#[derive(Debug)]
pub struct State {
    now: Time,
    seed: u64,
    /// Track.
    pub track: Track,
    /// Ground, and what stands on it.
    pub terrain: Terrain,
    runner: Runner,
    passersby: Option<Passersby>,
    base: SkidBase,
    command: HeldTwist,
    samples: VecDeque<Sample>,
    /// Pose by wheels and gyroscope, and by wheels alone.
    odometry: Pose2,
    wheels: Pose2,
    noise: Random,
    wheel_noise: Random,
    bias: f32,
    fault: Option<Fault>,
    people: Vec<Walker>,
    touches: bool,
    arrived: Option<Time>,
    lost: Option<(Time, Point2)>,
    report: Report,
}

/// World that all drivers of the robot share.
pub type Field = Shared<State>;

impl State {
    /// Creates the world of a seed.
    pub fn new(options: &Options) -> Self {
        let mut random = stream(options.seed, 0);
        let track = Track::new(&mut random, options.length);
        let terrain = Terrain::around(&track, &mut random);
        let runner = Runner::new(&track, f32::INFINITY, &mut random);
        let passersby = options.people.then(|| Passersby::new(&track, &terrain, &mut random));
        let start = track.way(-BEHIND);
        let heading = (track.way(0.0) - start).angle();
        let pose = Pose2::new(start.x, start.y, heading);
        let base = SkidBase::new(pose, LIMITS, SkidShape::SUMMIT, &terrain);
        let sample = Sample { pose, attitude: base.attitude };
        let mut noise = stream(options.seed, 1);
        let bias = noise.normal(0.0004);
        Self {
            now: Time::ZERO,
            seed: options.seed,
            track,
            terrain,
            people: vec![runner.walker],
            runner,
            passersby,
            base,
            command: HeldTwist::new(Some(COMMAND_TIMEOUT)),
            samples: std::iter::repeat_n(sample, SAMPLES).collect(),
            odometry: Pose2::default(),
            wheels: Pose2::default(),
            noise,
            wheel_noise: stream(options.seed, 14),
            bias,
            fault: options.fault,
            touches: false,
            arrived: None,
            lost: None,
            report: Report::default(),
        }
    }

    /// Random numbers for a sensor.
    pub fn stream(&self, number: u64) -> Random {
        stream(self.seed, number)
    }

    /// Plane of the world on the earth, whose x axis points to the east.
    pub fn plane() -> TangentPlane {
        TangentPlane::new(ORIGIN[0], ORIGIN[1])
    }

    /// Inertial sensor of the robot.
    pub fn imu(&self) -> Imu {
        Imu::new(ImuErrors::RAZOR, self.stream(12))
    }

    /// Receiver of satellite navigation of the robot.
    pub fn gnss(&self) -> Gnss {
        Gnss::new(GnssErrors::NEO_M8, Self::plane(), self.stream(13))
    }

    /// Report up to now.
    pub const fn report(&self) -> &Report {
        &self.report
    }

    /// True pose of the robot.
    pub const fn pose(&self) -> Pose2 {
        self.base.pose
    }

    /// Runner and passers-by: the runner is the first one.
    pub fn people(&self) -> &[Walker] {
        &self.people
    }

    /// Poses during the last turn of the scanner.
    pub fn samples(&mut self) -> &[Sample] {
        self.samples.make_contiguous()
    }

    /// Pose by wheels and gyroscope, with the inclination that the inertial sensor measures.
    pub fn odometry(&mut self) -> Pose3 {
        let Attitude { roll, pitch, .. } = self.base.attitude;
        let [roll, pitch] = [roll, pitch].map(|angle| f64::from(angle + self.noise.normal(0.004)));
        let Pose2 { x, y, theta } = self.odometry;
        Pose3::new([f64::from(x), f64::from(y), 0.0], Rotation::from_rpy(roll, pitch, f64::from(theta)))
    }

    /// Pose that the wheels sum up, which begins at the origin.
    pub const fn wheels(&self) -> Pose2 {
        self.wheels
    }

    /// Returns `true` while a sensor has a fault of this kind.
    pub fn has_fault(&self, kind: FaultKind) -> bool {
        self.fault.is_some_and(|fault| fault.is_on(kind, self.now))
    }

    /// Compares where the robot believes to be in the world with where it is.
    pub fn locate(&mut self, pose: &Pose2) {
        let error = (pose.position() - self.base.pose.position()).norm();
        self.report.located.push([error, wrap_angle(pose.theta - self.base.pose.theta)]);
    }

    /// Sets the twist of the motors.
    pub fn drive(&mut self, twist: Twist) {
        self.command.set(twist, self.now);
    }

    /// Compares where the robot believes the runner to be with where the runner is. `pose` is that of the robot in the
    /// frame of the person.
    pub fn judge(&mut self, person: Option<&Person>, pose: &Pose2) {
        if self.report.ending.is_some() {
            return;
        }
        let believed = person.map(|person| self.base.pose.to_outer(pose.to_inner(person.position)));
        let belief = self.belief(believed);
        if self.report.beliefs.last().is_none_or(|(_, last)| *last != belief) {
            self.report.beliefs.push((self.now, belief));
        }
        if belief == Belief::Right {
            self.report.found.get_or_insert(self.now);
            self.end_loss();
        } else if self.report.found.is_some() {
            self.lost.get_or_insert((self.now, self.base.pose.position()));
        }
    }

    fn belief(&self, place: Option<Point2>) -> Belief {
        let Some(place) = place else { return Belief::Unknown };
        let is_there = |person: &Walker| (person.position - place).norm() <= KNOWS;
        match self.people.iter().position(is_there) {
            Some(0) => Belief::Right,
            Some(_) => Belief::Another,
            None => Belief::Elsewhere,
        }
    }

    fn end_loss(&mut self) {
        if let Some((from, place)) = self.lost.take() {
            self.report.losses.push(Loss { from, lasted: self.now.since(from).as_secs_f32(), place });
        }
    }

    fn step(&mut self) {
        self.now += STEP;
        let dt = STEP.as_secs_f32();
        let others = self.passersby.as_ref().map_or(&[][..], |people| people.walkers());
        self.runner.step(dt, &self.track, others);
        if let Some(passersby) = &mut self.passersby {
            passersby.step(dt, self.runner.distance(), self.base.pose.position());
        }
        self.people.clear();
        self.people.push(self.runner.walker);
        if let Some(passersby) = &self.passersby {
            self.people.extend_from_slice(passersby.walkers());
        }
        self.move_base(dt);
        self.samples.pop_front();
        self.samples.push_back(Sample { pose: self.base.pose, attitude: self.base.attitude });
        self.note();
        self.report.ending = self.ending();
        if self.report.ending.is_some() {
            self.end_loss();
        }
    }

    fn move_base(&mut self, dt: f32) {
        let twist = self.command.at(self.now);
        let before = self.base.clone();
        let free = self.clearance();
        self.base.step(&twist, dt, &self.terrain);
        let (gap, is_person) = self.clearance();
        let touches = gap <= 0.0 && gap < free.0;
        let speed = before.twist.velocity().norm();
        if touches {
            if !self.touches && speed > DRIVES {
                let place = self.base.pose.position();
                self.report.contacts.push(Contact { at: self.now, place, speed, is_person });
            }
            self.base = before.clone();
            (self.base.twist, self.base.wheels) = (Twist::ZERO, Twist::ZERO);
        }
        // It has to get away before it touches something again.
        self.touches = gap <= 0.05 && (touches || self.touches);
        // The wheels do not tell the slip; the gyroscope drifts.
        let turn = wrap_angle(self.base.pose.theta - before.pose.theta);
        let turn = turn + (self.bias + self.noise.normal(0.01)) * dt;
        let way = self.base.wheels.x * dt * (1.0 + self.noise.normal(0.02));
        self.odometry = moved(&self.odometry, way, turn);
        let by_wheels = self.base.wheels.omega * dt * (1.0 + self.wheel_noise.normal(0.02));
        self.wheels = moved(&self.wheels, way, by_wheels);
        self.report.driven += (self.base.pose.position() - before.pose.position()).norm();
    }

    /// Distance of the outline of the robot from the nearest thing or person, in m, and `true` for a person.
    fn clearance(&self) -> (f32, bool) {
        let here = self.base.pose.position();
        let things = self.terrain.near(here, 3.0).filter(|thing| thing.radius_at_ground() > 0.0);
        let things = things.map(|thing| (self.base.clearance(thing.at, thing.radius_at_ground()), false));
        let near = self.people.iter().filter(|person| (person.position - here).norm() < 3.0);
        let persons = near.map(|person| (self.base.clearance(person.position, Walker::RADIUS), true));
        things.chain(persons).fold((f32::INFINITY, false), |a, b| if b.0 < a.0 { b } else { a })
    }

    fn note(&mut self) {
        self.report.ran = self.runner.distance();
        self.report.fastest = self.report.fastest.max(self.base.twist.x);
        self.report.load_transfer = self.report.load_transfer.max(self.base.load_transfer());
        let tick = self.now.as_nanos() / STEP.as_nanos() as i64;
        if tick % 10 == 0 && self.report.found.is_some() {
            let distance = (self.runner.walker.position - self.base.pose.position()).norm();
            self.report.distances.push(distance);
        }
        if tick % 50 == 0 {
            self.report.trajectory.push((self.now, self.base.pose));
            self.report.runner.push(self.runner.walker.position);
        }
        if self.runner.has_arrived() {
            self.arrived.get_or_insert(self.now);
        }
    }

    fn ending(&self) -> Option<Ending> {
        if self.base.is_tipped {
            return Some(Ending::Tipped);
        }
        if self.base.contacts().iter().any(|wheel| self.terrain.depth(*wheel) > STUCK) {
            return Some(Ending::Fell);
        }
        if self.lost.is_some_and(|(from, _)| self.now.since(from).as_secs_f32() > FOR_GOOD) {
            return Some(Ending::Lost);
        }
        let is_over = self.arrived.is_some_and(|at| self.now.since(at) > COMES);
        let distance = (self.runner.walker.position - self.base.pose.position()).norm();
        // The track is closed: who never left is near its end, too.
        let is_there = distance <= WITH && self.report.driven > 0.5 * self.report.ran && self.lost.is_none();
        is_over.then_some(if is_there { Ending::Arrived } else { Ending::LeftBehind })
    }

    /// Ends a run whose time is over.
    pub fn end(&mut self) {
        self.end_loss();
        self.report.ending.get_or_insert(Ending::Time);
    }
}

impl Simulation for State {
    /// Advances to a time, unless the run has ended.
    fn advance(&mut self, now: Time) {
        while self.now + STEP <= now && self.report.ending.is_none() {
            self.step();
        }
    }
}

/// Pose after a way straight ahead, in m, with a turn in rad.
fn moved(pose: &Pose2, way: f32, turn: f32) -> Pose2 {
    let half = Pose2::new(pose.x, pose.y, pose.theta + 0.5 * turn);
    let at = half.to_outer(Point2::new(way, 0.0));
    Pose2::new(at.x, at.y, apex_nodes::math::normalize_angle(&(pose.theta + turn)))
}

/// Random numbers of a seed for a purpose.
fn stream(seed: u64, number: u64) -> Random {
    Random::new(seed.wrapping_mul(0x9e37_79b9).wrapping_add(number.wrapping_mul(0x85eb_ca6b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field() -> State {
        State::new(&Options { seed: 3, length: 400.0, ..Options::default() })
    }

    #[test]
    fn a_robot_that_stands_is_left_behind() {
        let mut state = field();
        state.advance(Time::from_secs(1000));
        assert_eq!(state.report().ending, Some(Ending::LeftBehind));
        assert!(state.report().contacts.is_empty() && state.report().driven < 0.1);
    }

    #[test]
    fn a_robot_that_drives_on_blindly_comes_to_grief() {
        let ends = (0..8).map(|i| {
            let mut state = field();
            for ms in (0..120_000).step_by(100) {
                state.advance(Time::from_millis(ms));
                state.drive(Twist::new(2.0, 0.0, 0.3 - 0.08 * i as f32));
            }
            (state.report().contacts.len(), state.report().ending)
        });
        let grief = ends.filter(|(contacts, ending)| *contacts > 0 || *ending == Some(Ending::Fell)).count();
        assert!(grief >= 2, "{grief}");
    }

    #[test]
    fn only_a_right_belief_counts_as_known() {
        let mut state = field();
        state.advance(Time::from_secs(1));
        let pose = Pose2::new(7.0, -2.0, 0.4);
        let place = state.base.pose.to_inner(state.runner.walker.position);
        let right = Person { position: pose.to_outer(place), ..Person::default() };
        let wrong = Person { position: right.position + Point2::new(2.0, 0.0), ..right };
        state.judge(Some(&wrong), &pose);
        assert_eq!((state.report().found, state.lost.is_some()), (None, false), "it has not been found yet");
        state.judge(Some(&right), &pose);
        assert_eq!(state.report().found, Some(Time::from_secs(1)));
        state.judge(Some(&wrong), &pose);
        state.advance(Time::from_secs(3));
        state.judge(None, &pose);
        state.judge(Some(&right), &pose);
        assert_eq!(state.report().losses.iter().map(|loss| loss.lasted).collect::<Vec<_>>(), [2.0]);
        let other = pose.to_outer(state.base.pose.to_inner(state.people[1].position));
        state.judge(Some(&Person { position: other, ..right }), &pose);
        let beliefs = [Belief::Elsewhere, Belief::Right, Belief::Elsewhere, Belief::Unknown, Belief::Right];
        let beliefs = beliefs.into_iter().chain([Belief::Another]);
        assert!(state.report().beliefs.iter().map(|(_, belief)| *belief).eq(beliefs));
    }

    #[test]
    fn the_same_seed_is_the_same_run() {
        let run = || {
            let mut state = field();
            for ms in (0..20_000).step_by(100) {
                state.advance(Time::from_millis(ms));
                state.drive(Twist::new(1.0, 0.0, 0.2));
            }
            (state.base.pose, state.wheels, state.people().to_vec())
        };
        assert_eq!(run(), run());
    }
}
