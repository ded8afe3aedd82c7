use super::{Contact, Fault, FaultKind, Field, Kind, Report};
use apex_nodes::{
    map::{Grid, Occupancy, Raster, Signs},
    nav::Twist,
    scan::{Point2, Pose2},
};
use apex_rt::Time;
use apex_sim::{Differential, HeldTwist, Limits, Odometry, OdometryNoise, Shared, Simulation, stream};
use std::time::Duration;

/// Radius of the robot, in m.
pub const RADIUS: f32 = 0.22;
/// Step of the simulation.
const STEP: Duration = Duration::from_millis(10);
/// Time without a twist after which the motors brake.
const COMMAND_TIMEOUT: Duration = Duration::from_millis(300);
/// Limits of the base.
const LIMITS: Limits = Limits { speed: 0.8, acceleration: 1.0, turn: 2.0, turn_acceleration: 6.0 };
/// Distance between the wheels, in m.
const TRACK: f32 = 0.34;
/// Distance from the station within which a robot that stands is charged, in m.
const DOCKED: f32 = 0.4;
/// Speed of a robot that stands, in m/s and rad/s.
const STANDS: f32 = 0.01;
/// Charge of a battery that is low, and of one that is full.
const LOW: f32 = 0.5;
const FULL: f32 = 0.98;
/// Time in which an empty battery is full.
const CHARGING: Duration = Duration::from_secs(90);
/// Side of the cells in which the explored area is measured, in m.
const CELL: f32 = 0.2;

/// Options of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Seed of the field and of all noise.
    pub seed: u64,
    /// Time in which a full battery is empty.
    pub life: Duration,
    /// Error of the wheels, as a multiple of that of a Pioneer 2.
    pub drift: f32,
    /// Faults of the robot's devices.
    pub faults: Vec<Fault>,
    /// `true` for motors that keep the last twist, as many do, instead of braking if none comes.
    pub keeps_twist: bool,
}

/// A battery of six minutes.
impl Default for Options {
    fn default() -> Self {
        Self { seed: 1, life: Duration::from_secs(360), drift: 0.5, faults: vec![], keeps_twist: false }
    }
}

/// World of one seed.
#[derive(Debug)]
pub struct State {
    now: Time,
    seed: u64,
    /// Field.
    pub field: Field,
    base: Differential,
    command: HeldTwist,
    odometry: Odometry,
    wheels: Pose2,
    faults: Vec<Fault>,
    life: Duration,
    charge: f32,
    /// `true` from a low battery on until it is full.
    is_spent: bool,
    touches: bool,
    report: Report,
    map: Grid<Occupancy>,
    /// Objects of each kind that the robot knows, in the frame of the station.
    known: [Signs; Kind::ALL.len()],
}

/// World that all drivers of the robot share.
pub type Planet = Shared<State>;

impl State {
    /// Creates the world of a seed.
    pub fn new(options: &Options) -> Self {
        let field = Field::new(&mut stream(options.seed, 1));
        let base = Differential { pose: field.station, twist: Twist::ZERO, limits: LIMITS, track: TRACK };
        let noise = OdometryNoise::PIONEER.times(options.drift);
        Self {
            now: Time::ZERO,
            seed: options.seed,
            field,
            base,
            command: HeldTwist::new((!options.keeps_twist).then_some(COMMAND_TIMEOUT)),
            odometry: Odometry::new(noise, stream(options.seed, 2).bits()),
            wheels: Pose2::default(),
            faults: options.faults.clone(),
            life: options.life,
            charge: 1.0,
            is_spent: false,
            touches: false,
            report: Report { least_charge: 1.0, ..Report::default() },
            map: Grid::default(),
            known: Default::default(),
        }
    }

    /// Seed of the world.
    pub const fn seed(&self) -> u64 {
        self.seed
    }

    /// Report up to now.
    pub const fn report(&self) -> &Report {
        &self.report
    }

    /// Map that the robot has made, in the frame of the station.
    pub const fn map(&self) -> &Grid<Occupancy> {
        &self.map
    }

    /// True pose of the robot.
    pub const fn pose(&self) -> Pose2 {
        self.base.pose
    }

    /// True velocity of the robot.
    pub const fn twist(&self) -> Twist {
        self.base.twist
    }

    /// Returns `true` while the robot has a fault of this kind.
    pub fn has(&self, kind: FaultKind) -> bool {
        self.faults.iter().any(|fault| fault.is_on(kind, self.now))
    }

    /// Pose by the wheels, relative to the station.
    pub const fn wheels(&self) -> Pose2 {
        self.wheels
    }

    /// Charge of the battery, from 1 (full) to 0 (empty).
    pub const fn charge(&self) -> f32 {
        self.charge
    }

    /// Sets the twist of the motors.
    pub fn drive(&mut self, twist: Twist) {
        self.command.set(twist, self.now);
    }

    /// Takes the map of the robot.
    pub fn take_map(&mut self, map: &Grid<Occupancy>) {
        self.map.clone_from(map);
    }

    /// Objects of each kind that the robot knows, in the frame of the station.
    pub const fn known(&self) -> &[Signs; Kind::ALL.len()] {
        &self.known
    }

    /// Takes the objects of a kind that the robot knows.
    pub fn take_objects(&mut self, kind: Kind, objects: &Signs) {
        self.known[kind as usize].clone_from(objects);
    }

    /// Notes that the robot is at home, and nothing is left.
    pub fn finish(&mut self) {
        let distance = self.distance_from_station();
        self.report.finished.get_or_insert((self.now, distance));
    }

    /// Distance of the robot from its place at the station, in m.
    pub fn distance_from_station(&self) -> f32 {
        (self.base.pose.position() - self.field.station.position()).norm()
    }

    /// Share of the ground that is not covered by things, and that the map shows as free.
    pub fn explored(&self) -> f32 {
        let size = self.field.half.scaled(2.0 / CELL);
        let corner = self.field.half.scaled(-1.0);
        let raster = Raster { corner, resolution: CELL, width: size.x as usize, height: size.y as usize };
        let cells = (0..raster.width * raster.height).map(|i| (i % raster.width, i / raster.width));
        let places = cells.map(|(x, y)| corner + Point2::new(x as f32 + 0.5, y as f32 + 0.5).scaled(CELL));
        let ground: Vec<Point2> = places.filter(|place| self.is_ground(*place)).collect();
        let frame = self.field.station.transform();
        let is_known = |place: &&Point2| self.map.at(frame.to_inner(**place)) == Some(&Occupancy::Free);
        ground.iter().filter(is_known).count() as f32 / ground.len().max(1) as f32
    }

    /// Returns `true` on ground on which the robot has room.
    fn is_ground(&self, place: Point2) -> bool {
        self.field.world.clearance(place) > RADIUS
    }

    fn step(&mut self) {
        self.now += STEP;
        self.step_battery();
        let before = self.base.clone();
        let command = if self.charge > 0.0 { self.command.at(self.now) } else { Twist::ZERO };
        self.base.step(&command, STEP.as_secs_f32());
        self.stop_at_things(&before);
        self.wheels = self.odometry.measure(&before.pose, &self.base.pose);
        self.report.driven += (self.base.pose.position() - before.pose.position()).norm();
        if self.now.as_nanos() % 500_000_000 == 0 {
            self.report.trajectory.push(self.base.pose);
        }
    }

    fn step_battery(&mut self) {
        let stands = self.base.twist.x.abs() <= STANDS && self.base.twist.omega.abs() <= STANDS;
        let is_charging = stands && self.distance_from_station() <= DOCKED;
        let dt = STEP.as_secs_f32();
        let gain = if is_charging { dt / CHARGING.as_secs_f32() } else { -dt / self.life.as_secs_f32() };
        self.charge = (self.charge + gain).clamp(0.0, 1.0);
        self.is_spent |= self.charge < LOW;
        if self.is_spent && self.charge >= FULL {
            self.is_spent = false;
            self.report.charges.push(self.now);
        }
        self.report.least_charge = self.report.least_charge.min(self.charge);
    }

    /// Stops the base where it would drive into something.
    fn stop_at_things(&mut self, before: &Differential) {
        let gap = |base: &Differential| self.field.world.clearance(base.pose.position()) - RADIUS;
        let (was, is) = (gap(before), gap(&self.base));
        let touches = is <= 0.0 && is < was;
        if touches {
            if !self.touches {
                self.report.contacts.push(Contact { at: self.now, place: self.base.pose.position() });
            }
            self.base.pose = Pose2 { theta: self.base.pose.theta, ..before.pose };
            self.base.twist.x = 0.0;
        }
        // It has to get away before it touches something again.
        self.touches = touches || (self.touches && is <= 0.02);
    }
}

impl Simulation for State {
    fn advance(&mut self, now: Time) {
        while self.now + STEP <= now {
            self.step();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn driven(twist: Twist, seconds: i64, life: u64) -> State {
        let mut state = State::new(&Options { life: Duration::from_secs(life), ..Options::default() });
        for tenth in 0..10 * seconds {
            state.advance(Time::from_millis(100 * tenth));
            state.drive(twist);
        }
        state
    }

    #[test]
    fn a_blind_robot_touches_something_and_its_battery_gets_empty() {
        let state = driven(Twist::new(0.5, 0.0, 0.0), 60, 40);
        assert_eq!((state.report().contacts.len(), state.charge()), (1, 0.0));
        assert!(state.report().driven > 1.0 && state.report().trajectory.len() > 100);
    }

    #[test]
    fn a_robot_at_the_station_stays_charged() {
        let state = driven(Twist::ZERO, 60, 40);
        assert_eq!((state.charge(), state.explored(), state.report().charges.len()), (1.0, 0.0, 0));
    }

    #[test]
    fn the_whole_map_is_the_whole_field() {
        let mut state = driven(Twist::ZERO, 1, 40);
        let raster = Raster { corner: Point2::new(-40.0, -40.0), resolution: 1.0, width: 80, height: 80 };
        state.take_map(&Grid::new(raster, Occupancy::Free).expect("small"));
        assert_eq!(state.explored(), 1.0);
    }
}
