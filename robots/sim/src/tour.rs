use crate::{Building, Differential, Laser, Limits, Odometry, OdometryNoise, Random};
use apex_nodes::{
    io::ReadError,
    map::{Cell, Grid, Occupancy},
    math::normalize_angle,
    nav::{Path, Planner, Smoothing, Terrain, Twist},
    scan::{Pose2, Scan},
};
use apex_rt::{Ctx, Out, Time, node};
use core::{f32::consts::PI, fmt};

/// Radius of the robot, in m.
const RADIUS: f32 = 0.3;
/// Distance between walls, furniture and the goals of the tour from the start, in m.
const FARTHER: f32 = 8.0;
/// Distance of the point on the path that the robot turns to, in m.
const AHEAD: f32 = 0.5;
/// Maximum step of the simulation, in s.
const STEP: f32 = 0.02;
const SMOOTHING: Smoothing = Smoothing { spacing: 0.1, rounds: 20 };
const LIMITS: Limits = Limits { speed: 0.9, acceleration: 1.0, turn: 1.5, turn_acceleration: 4.0 };

/// Robot with a laser scanner that drives from one random place of a building to the next, on planned paths.
#[derive(Debug, Clone)]
pub struct Tour {
    building: Building,
    free: Grid<Occupancy>,
    planner: Planner,
    path: Path,
    /// Next point of the path.
    next: usize,
    base: Differential,
    odometry: Odometry,
    laser: Laser,
    random: Random,
}

impl Tour {
    /// Places the robot anywhere in the building. Its odometry has the errors of a Pioneer 2, multiplied by `drift`.
    /// Returns `None` if the building has no free place.
    pub fn new(building: Building, laser: Laser, drift: f32, seed: u64) -> Option<Self> {
        let free = building.free_map(RADIUS)?;
        let base = Differential { pose: Pose2::default(), twist: Twist::ZERO, limits: LIMITS, track: 0.5 };
        let mut tour = Self {
            building,
            free,
            planner: Planner::default(),
            path: Path::default(),
            next: 0,
            base,
            odometry: Odometry::new(OdometryNoise::PIONEER.times(drift), seed.wrapping_add(1)),
            laser,
            random: Random::new(seed),
        };
        tour.carry();
        Some(tour)
    }

    /// Building of the tour.
    pub const fn building(&self) -> &Building {
        &self.building
    }

    /// True pose of the robot.
    pub const fn pose(&self) -> &Pose2 {
        &self.base.pose
    }

    /// Carries the robot to a random place. Its wheels do not notice.
    pub fn carry(&mut self) {
        self.base.pose = self.place();
        self.base.twist = Twist::ZERO;
        self.path.points.clear();
        self.next = 0;
    }

    /// Random free pose.
    fn place(&mut self) -> Pose2 {
        let cells = self.free.cells().len() as u64;
        let width = self.free.raster().width;
        // The largest region is not empty.
        loop {
            let at = (self.random.bits() % cells.max(1)) as usize;
            let cell = Cell::new(at % width, at / width);
            if self.free.get(cell) == Some(&Occupancy::Free) {
                let centre = self.free.raster().centre(cell);
                return Pose2::new(centre.x, centre.y, self.random.uniform(-PI, PI));
            }
        }
    }

    /// Drives for some time, in s. Returns the odometry.
    pub fn drive(&mut self, seconds: f32) -> Pose2 {
        let steps = (seconds / STEP).ceil().clamp(1.0, 1e5);
        let before = self.base.pose;
        let mut measured = self.odometry.measure(&before, &before);
        for _ in 0..steps as u32 {
            let pose = self.base.pose;
            let twist = self.twist();
            self.base.step(&twist, seconds / steps);
            measured = self.odometry.measure(&pose, &self.base.pose);
        }
        measured
    }

    /// Measures a scan at the pose of the robot.
    pub fn scan(&mut self, scan: &mut Scan) {
        self.laser.measure(&self.building.world, &self.base.pose, &mut self.random, scan);
    }

    /// Twist along the path, towards a point some way ahead.
    fn twist(&mut self) -> Twist {
        let here = self.base.pose.position();
        while self.path.points.get(self.next).is_some_and(|point| (*point - here).norm() < AHEAD) {
            self.next += 1;
        }
        let Some(&target) = self.path.points.get(self.next) else {
            self.plan();
            return Twist::ZERO;
        };
        let turn = normalize_angle(&((target - here).angle() - self.base.pose.theta));
        let speed = if turn.abs() < 0.8 { LIMITS.speed * turn.cos() } else { 0.0 };
        Twist::new(speed, 0.0, (2.0 * turn).clamp(-LIMITS.turn, LIMITS.turn))
    }

    /// Plans a path to a random place that is not too near.
    fn plan(&mut self) {
        for _ in 0..20 {
            let goal = self.place();
            let start = self.base.pose;
            if (goal.position() - start.position()).norm() < FARTHER {
                continue;
            }
            // The start may be just outside of the free places: the robot cuts corners.
            let terrain = Terrain { map: &self.free, costs: None, unknown_is_open: false };
            if self.planner.plan(&terrain, &start, &goal, SMOOTHING, &mut self.path).is_ok() {
                self.next = 0;
                return;
            }
        }
        // Stuck beside the free places: back to the nearest one.
        self.escape();
    }

    /// Moves the robot to the middle of the nearest free cell, less than half a metre away.
    fn escape(&mut self) {
        let here = self.base.pose.position();
        let raster = *self.free.raster();
        let free =
            self.free.iter().filter(|(_, place)| **place == Occupancy::Free).map(|(cell, _)| raster.centre(cell));
        if let Some(near) = free.min_by(|a, b| (*a - here).norm_squared().total_cmp(&(*b - here).norm_squared())) {
            (self.base.pose.x, self.base.pose.y) = (near.x, near.y);
        }
    }
}

/// Error of a tour that cannot begin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TourError {
    /// The plan cannot be read.
    Plan(ReadError),
    /// The building has no free place.
    NoPlace,
}

impl fmt::Display for TourError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plan(error) => error.fmt(f),
            Self::NoPlace => f.write_str("the plan has no room that is large enough for the robot"),
        }
    }
}

impl core::error::Error for TourError {}

/// Simulated robot with wheel odometry and a laser scanner that drives around in a building (see [`Tour`]). It is a
/// source, and needs a period, for example `every 100ms`.
///
/// Fails once if the plan is not a building.
#[node]
#[derive(Debug, Clone)]
pub struct BuildingTour {
    /// DXF file of the building (see [`Building::read`]).
    #[param]
    plan: &'static str,
    /// Pieces of furniture that are not on the plan, approximately.
    #[param(default = 300)]
    furniture: usize,
    /// Error of the wheel odometry, as a multiple of that of a Pioneer 2.
    #[param(default = 1.0, range = 0.0..=10.0)]
    drift: f32,
    /// Seed of furniture, start, goals and errors.
    #[param(default = 1)]
    seed: u64,
    tour: Option<Tour>,
    failed: bool,
    last: Option<Time>,
}

#[node]
impl BuildingTour {
    fn process(
        &mut self,
        ctx: &Ctx,
        odometry: &mut Out<Pose2>,
        scan: &mut Out<Scan>,
        pose: &mut Out<Pose2>,
    ) -> Result<(), TourError> {
        if self.failed {
            return Ok(());
        }
        let mut tour = match self.tour.take() {
            Some(tour) => tour,
            None => self.begin().inspect_err(|_| self.failed = true)?,
        };
        let elapsed = self.last.map_or(0.0, |last| ctx.now().since(last).as_secs_f32());
        self.last = Some(ctx.now());
        odometry.set(tour.drive(elapsed));
        scan.get_mut().stamp = ctx.now();
        tour.scan(scan.get_mut());
        pose.set(*tour.pose());
        self.tour = Some(tour);
        Ok(())
    }

    /// Carries the robot to a random place.
    #[slot]
    fn carry(&mut self) {
        if let Some(tour) = &mut self.tour {
            tour.carry();
        }
    }

    fn begin(&self) -> Result<Tour, TourError> {
        let mut building = Building::read(self.plan).map_err(TourError::Plan)?;
        building.furnish(self.furniture, &mut Random::new(self.seed));
        Tour::new(building, Laser::default(), self.drift, self.seed).ok_or(TourError::NoPlace)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::office_file;
    use apex_rt::Construct;

    #[test]
    fn the_robot_drives_through_the_building_without_touching_anything() {
        let mut building = Building::read(office_file()).expect("the plan");
        building.furnish(300, &mut Random::new(2));
        let mut tour = Tour::new(building, Laser::default(), 0.0, 2).expect("a place");
        let (mut way, mut nearest, mut last) = (0.0, f32::MAX, *tour.pose());
        for _ in 0..1200 {
            tour.drive(0.1);
            way += (tour.pose().position() - last.position()).norm();
            nearest = nearest.min(tour.building().world.clearance(tour.pose().position()));
            last = *tour.pose();
        }
        assert!(way > 50.0 && nearest > 0.2, "{way} m, {nearest} m from the nearest thing");
    }

    #[test]
    fn the_wheels_do_not_notice_that_the_robot_is_carried() {
        let mut node = BuildingTour::construct((office_file(), 10, 0.0, 3));
        let fire = |node: &mut BuildingTour, ms: i64| {
            let (mut odometry, mut scan, mut pose) = (Out::new(), Out::new(), Out::new());
            node.process(&Ctx::new(Time::from_millis(ms)), &mut odometry, &mut scan, &mut pose).expect("a building");
            assert!(scan.get().is_some_and(|scan: &Scan| scan.points().count() > 400));
            (*odometry.get().expect("odometry"), *pose.get().expect("a pose"))
        };
        let before = fire(&mut node, 0);
        node.carry();
        let after = fire(&mut node, 10);
        assert!((before.0.position() - after.0.position()).norm() < 0.05);
        assert!((before.1.position() - after.1.position()).norm() > 0.5);
    }

    #[test]
    fn a_wrong_plan_is_reported_once() {
        let mut node = BuildingTour::construct(("/nowhere/plan.dxf", 10, 0.0, 3));
        let mut fire = || node.process(&Ctx::new(Time::ZERO), &mut Out::new(), &mut Out::new(), &mut Out::new());
        assert!(matches!(fire(), Err(TourError::Plan(_))) && fire().is_ok());
    }
}
