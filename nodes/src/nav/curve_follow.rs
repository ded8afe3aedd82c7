use super::{
    Articulated, Clearance, Path, Projection, Twist,
    latest::{Latest, any_far, fresh},
    near::{GRAZE, Near, Zone, seen},
    outline::{Axes, Outline},
    progress::{End, Progress, RESUMES},
    twist::Halt,
};
use crate::{
    map::{Grid, Occupancy},
    math::normalize_angle,
    scan::{BeamDirections, FarFromOrigin, Pose2, Scan},
};
use apex_rt::{Ctx, Event, Time, node};
use libm::{atanf, fabsf, fmaxf, fminf, sqrtf};

/// Distance between predicted places, in m.
const STEP: f32 = 0.1;
/// Half of the length on which direction and curvature of a path are measured, in m: its points are 0.1 m apart.
const CHORD: f32 = 0.15;
/// Distance from the end up to which the last points are passed one by one, in m.
const CORNER: f32 = 0.01;

/// Follows a path of [`CurvePlanner`](super::CurvePlanner) forward with a tractor and its trailer.
///
/// The vehicle steers with the curvature of the path, and back to it: its direction is that of the path less
/// atan(`convergence` · offset). Where it will be on the next `look_ahead` m, with its trailer and its load, is
/// predicted with the same law. It slows down for the curves on this way, before its end, before points of the scans
/// that its outline would come within `margin` of, and before hazards on `ground`, to which it keeps the `clearance`:
/// such a map is that of `HazardMap`, in the frame of `odometry`.
///
/// `pose` is that of the tractor in the frame of the path, `trailer` the pose of the trailer's axis in the frame of the
/// tractor; while one of them is missing or older than `max_age`, the vehicle stands still. `ahead` and `behind` are
/// scans in the frames of the tractor and of the trailer, without the load; before the first ones, and the first
/// `ground`, no obstacle is known. That the vehicle stops before obstacles, and without scans, is the task of a
/// [`TrailerField`](super::TrailerField). A new path replaces the current one. The node sends twists while it has a
/// path, and drops it when the vehicle
/// * has `reached` its end up to `tolerance`, where it stops,
/// * is `blocked`: for longer than `blocked_timeout`, an obstacle is on its way, or it makes no progress for longer
///   than `patience`, or the path is not finite,
/// * is `off_path`: farther than `max_offset` from the path,
/// * is deactivated.
///
/// Stops and fails while the pose is more than 100 km from the origin.
#[node]
#[derive(Debug, Clone)]
pub struct CurveFollower {
    /// Shape of the vehicle.
    #[param]
    vehicle: Articulated,
    /// Length of the load, whose middle is above that of the straight vehicle.
    #[param(unit = "m", default = 0.0, range = 0.0..=10.0)]
    load_length: f32,
    /// Width of the load; 0 for none.
    #[param(unit = "m", default = 0.0, range = 0.0..=10.0)]
    load_width: f32,
    /// Smallest radius of a curve: less than that of the planner, so that the vehicle can steer back to the path.
    #[param(unit = "m", default = 0.7, range = 0.01..=100.0)]
    radius: f32,
    /// Speed on a straight way.
    #[param(unit = "m/s", default = 0.5, range = 0.0..=10.0)]
    speed: f32,
    /// Minimum speed on the path.
    #[param(unit = "m/s", default = 0.05, range = 0.001..=1.0)]
    min_speed: f32,
    /// Maximum acceleration and planned deceleration.
    #[param(unit = "m/s^2", default = 0.5, range = 0.01..=100.0)]
    acceleration: f32,
    /// Maximum acceleration to the side in a curve.
    #[param(unit = "m/s^2", default = 0.5, range = 0.01..=100.0)]
    side_acceleration: f32,
    /// Rate at which the vehicle turns back to a path at whose side it is: the direction per offset.
    #[param(unit = "1/m", default = 1.5, range = 0.0..=100.0)]
    convergence: f32,
    /// Curvature per error of the direction.
    #[param(unit = "1/m", default = 3.5, range = 0.0..=100.0)]
    steering: f32,
    /// Time in which the vehicle carries out a change of its curvature.
    #[param(unit = "s", default = 0.15, range = 0.0..=10.0)]
    lag: f32,
    /// Length of the way that is predicted.
    #[param(unit = "m", default = 2.5, range = 0.0..=100.0)]
    look_ahead: f32,
    /// Distance of the outline from points of the scans at which nothing is on the way.
    #[param(unit = "m", default = 0.02, range = 0.0..=10.0)]
    margin: f32,
    /// Distances kept from hazards.
    #[param(default = Clearance::PATSY)]
    clearance: Clearance,
    /// Remaining length of the path at which the end is reached.
    #[param(unit = "m", default = 0.05, range = 0.001..=10.0)]
    tolerance: f32,
    /// Maximum distance from the path. Beyond it the vehicle gives up with `off_path`.
    #[param(unit = "m", default = 1.0, range = 0.01..=100.0)]
    max_offset: f32,
    /// Time that an obstacle may be on the way.
    #[param(unit = "s", default = 2.0, range = 0.0..=600.0)]
    blocked_timeout: f32,
    /// Time that the vehicle may go without progress.
    #[param(unit = "s", default = 2.0, range = 0.0..=600.0)]
    patience: f32,
    /// Maximum age of poses and scans.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    path: Path,
    progress: Progress,
    /// Time and speed of the last command.
    last: Option<(Time, f32)>,
    scans: [Latest<Scan>; 2],
    ground: Latest<Grid<Occupancy>>,
    /// Points of the scans near the way.
    near: Near,
    /// Hazards near the way.
    hazards: Near,
    halt: Halt,
    directions: [BeamDirections; 2],
}

/// Prediction of a way.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Outlook {
    /// Curvature with which the vehicle goes on, in 1/m.
    curvature: f32,
    /// Highest speed, in m/s.
    speed: f32,
    /// `true` if something is on the way.
    is_obstructed: bool,
}

#[node]
impl CurveFollower {
    #[allow(clippy::too_many_arguments, reason = "they are the ports")]
    fn process(
        &mut self,
        ctx: &Ctx,
        pose: Option<&Pose2>,
        trailer: Option<&Pose2>,
        path: Option<&Path>,
        ahead: Option<&Scan>,
        behind: Option<&Scan>,
        ground: Option<&Grid<Occupancy>>,
        odometry: Option<&Pose2>,
        reached: Event<()>,
        #[failure] blocked: Event<()>,
        #[failure] off_path: Event<()>,
    ) -> Result<Option<Twist>, FarFromOrigin> {
        if let Some(path) = path {
            self.begin(path, ctx.now());
        }
        if self.path.points.is_empty() {
            return Ok(self.halt.rest());
        }
        if any_far([pose]) {
            return self.halt.far();
        }
        for (last, scan) in self.scans.iter_mut().zip([ahead, behind]) {
            last.update(ctx, scan, self.max_age);
        }
        self.ground.update(ctx, ground, self.max_age);
        let [pose, trailer, odometry] = [pose, trailer, odometry].map(|pose| fresh(ctx, pose, self.max_age));
        Ok(self.step(ctx, pose.zip(trailer), odometry, [reached, blocked, off_path]))
    }

    fn step(
        &mut self,
        ctx: &Ctx,
        places: Option<(&Pose2, &Pose2)>,
        odometry: Option<&Pose2>,
        ends: [Event<()>; 3],
    ) -> Option<Twist> {
        let Some((pose, hitch)) = places else {
            self.last = None;
            self.progress.pause();
            return self.halt.drive(Twist::ZERO);
        };
        let axes = self.axes(pose, hitch);
        let Some(projection) = self.path.project(pose.position(), self.progress.segment, CORNER) else {
            // The path is not finite.
            return self.give_up_with(End::Blocked, ends);
        };
        self.progress.segment = projection.segment;
        self.find_near(ctx, &axes);
        self.find_hazards(ctx, &axes, odometry.map(|odometry| self.axes(odometry, hitch)));
        let outlook = self.predict(axes, projection);
        match self.end(&projection, &outlook, ctx.now()) {
            None => {
                let twist = self.drive(&outlook, ctx.now());
                self.halt.drive(twist)
            }
            Some(end) => self.give_up_with(end, ends),
        }
    }

    fn give_up_with(&mut self, end: End, ends: [Event<()>; 3]) -> Option<Twist> {
        end.tell(ends);
        self.give_up();
        self.halt.drive(Twist::ZERO)
    }

    /// Drops the path.
    #[on_deactivate]
    fn give_up(&mut self) {
        self.path.points.clear();
    }

    /// Begins a path. A vehicle that was driving just before goes on at its speed.
    fn begin(&mut self, path: &Path, now: Time) {
        self.last = self.last.filter(|(at, _)| now.since(*at).as_secs_f32() <= RESUMES);
        self.path.take(path);
        self.progress = Progress::default();
    }

    /// Poses of the axes of the vehicle.
    fn axes(&self, pose: &Pose2, hitch: &Pose2) -> Axes {
        [*pose, self.vehicle.trailer(pose, pose.theta + hitch.theta)]
    }

    /// Finds the points of the scans that may be on the way.
    fn find_near(&mut self, ctx: &Ctx, axes: &Axes) {
        let (zone, margin) = (self.zone(), self.margin);
        let scans = self.scans.iter().zip(&mut self.directions).zip(axes);
        let places = scans.filter_map(|((scan, directions), axis)| {
            Some(seen(scan.young(ctx, self.max_age)?, directions, axis, margin))
        });
        self.near.find(&zone, axes, self.look_ahead, places.flatten());
    }

    /// Finds the hazards that may be on the way. `there` are the axes in the frame of the ground.
    fn find_hazards(&mut self, ctx: &Ctx, axes: &Axes, there: Option<Axes>) {
        let Self { vehicle, clearance, look_ahead, .. } = *self;
        let ground = self.ground.young(ctx, self.max_age).zip(there.as_ref());
        let here = axes[0].transform();
        let hazards = ground.into_iter().flat_map(|(map, there)| {
            let (hazards, there) = (clearance.hazards(map, vehicle, there, false), there[0].transform());
            hazards.map(move |(place, margin)| (here.to_outer(there.to_inner(place)), margin))
        });
        self.hazards.find(&clearance.zone(vehicle, false), axes, look_ahead, hazards);
    }

    /// Predicts the way of the vehicle.
    fn predict(&self, mut axes: Axes, mut projection: Projection) -> Outlook {
        let curvature = self.curvature(&axes[0], &projection);
        let most = |distance: f32, speed: f32| sqrtf(speed * speed + 2.0 * self.acceleration * fmaxf(distance, 0.0));
        let mut outlook =
            Outlook { curvature, speed: fminf(self.speed, self.in_curve(curvature)), is_obstructed: false };
        let zones = [(&self.near, self.zone()), (&self.hazards, self.clearance.zone(self.vehicle, false))];
        let (mut driven, mut turn) = (0.0, curvature);
        let way = fminf(self.look_ahead, projection.remaining - self.tolerance);
        while driven < way {
            let twist = Twist::new(1.0, 0.0, turn);
            let now = axes;
            axes = self.vehicle.places(&now, &twist, STEP).next().unwrap_or(now);
            driven += STEP;
            if zones.iter().any(|(near, zone)| near.is_met(zone, &axes, driven, GRAZE)) {
                outlook.speed = fminf(outlook.speed, most(driven - STEP, 0.0));
                outlook.is_obstructed = true;
                break;
            }
            let Some(next) = self.path.project(axes[0].position(), projection.segment, CORNER) else { break };
            projection = next;
            turn = self.curvature(&axes[0], &projection);
            outlook.speed = fminf(outlook.speed, most(driven, self.in_curve(turn)));
        }
        outlook.speed = fminf(outlook.speed, most(way, 0.0));
        outlook
    }

    /// Curvature with which the vehicle keeps to the path, in 1/m.
    fn curvature(&self, pose: &Pose2, projection: &Projection) -> f32 {
        let at = |ahead: f32| self.path.ahead(projection, ahead);
        let chord = |from: f32, to: f32| (at(to) - at(from)).angle();
        let tangent = chord(-CHORD, CHORD);
        let preview = self.lag * self.last.map_or(0.0, |(_, speed)| speed);
        let turn = normalize_angle(&(chord(preview, preview + CHORD) - chord(preview - CHORD, preview)));
        let wanted = tangent - atanf(self.convergence * projection.offset);
        let curvature = turn / CHORD + self.steering * normalize_angle(&(wanted - pose.theta));
        let most = 1.0 / self.radius;
        curvature.clamp(-most, most)
    }

    /// Highest speed in a curve, in m/s.
    fn in_curve(&self, curvature: f32) -> f32 {
        sqrtf(self.side_acceleration / fmaxf(fabsf(curvature), 1e-3))
    }

    fn end(&mut self, projection: &Projection, outlook: &Outlook, now: Time) -> Option<End> {
        if projection.remaining <= self.tolerance {
            return Some(End::Reached);
        }
        if projection.distance > self.max_offset {
            return Some(End::OffPath);
        }
        self.progress.advance(projection.remaining + projection.distance, now);
        self.progress.obstruct(outlook.is_obstructed, now);
        self.progress.is_blocked(self.blocked_timeout, self.patience, now).then_some(End::Blocked)
    }

    fn drive(&mut self, outlook: &Outlook, now: Time) -> Twist {
        let (elapsed, before) = self.last.map_or((0.0, 0.0), |(at, speed)| (now.since(at).as_secs_f32(), speed));
        let speed = fminf(fmaxf(outlook.speed, self.min_speed), before + self.acceleration * elapsed);
        self.last = Some((now, speed));
        Twist::new(speed, 0.0, outlook.curvature * speed)
    }

    fn zone(&self) -> Zone {
        Zone::new(Outline::new(self.vehicle, [self.load_length, self.load_width]), 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{map::Raster, scan::Point2};
    use apex_rt::Construct;
    use core::f32::consts::{FRAC_PI_2, PI, TAU};

    const VEHICLE: Articulated = Articulated::PATSY;

    fn node() -> CurveFollower {
        let limits = (0.6, 0.7, 0.05, 0.6, 0.5);
        CurveFollower::construct((
            VEHICLE,
            0.0,
            0.0,
            limits.0,
            limits.1,
            limits.2,
            limits.3,
            limits.4,
            1.5,
            3.5,
            0.15,
            2.5,
            0.02,
            Clearance::PATSY,
            0.1,
            1.0,
            0.5,
            2.0,
            0.5,
        ))
    }

    /// Path along arcs of a curvature in 1/m and a length in m, with points 0.1 m apart.
    fn path(start: Pose2, arcs: &[(f32, f32)]) -> Path {
        let (mut pose, mut points) = (start, vec![start.position()]);
        for (curvature, length) in arcs {
            for _ in 0..libm::roundf(length / 0.1) as usize {
                pose = pose.compose(&Pose2::new(0.1, 0.0, 0.1 * curvature));
                points.push(pose.position());
            }
        }
        Path { points, heading: pose.theta }
    }

    /// Scan that measures these places in the frame of the scanner.
    fn scan(places: &[Point2]) -> Scan {
        let mut scan = Scan { angle_min: -PI, angle_increment: TAU / 720.0, range_max: 20.0, ..Scan::default() };
        scan.ranges.extend([10.0; 720]);
        for place in places {
            let beam = libm::roundf((place.angle() + PI) / scan.angle_increment) as usize % 720;
            scan.ranges[beam] = place.norm();
        }
        scan
    }

    /// A straight vehicle whose motors take 0.1 s to follow a twist, and which gets one every 80 ms.
    struct Robot {
        node: CurveFollower,
        pose: Pose2,
        trailer: f32,
        twist: Twist,
        ms: i64,
        /// Map in the frame of odometry, which began at (7, 7).
        ground: Option<Grid<Occupancy>>,
    }

    impl Robot {
        fn new(node: CurveFollower, pose: Pose2) -> Self {
            Self { node, pose, trailer: pose.theta, twist: Twist::ZERO, ms: 0, ground: None }
        }

        fn react(&mut self, path: Option<&Path>, obstacles: &[Point2]) -> (Option<Twist>, Option<End>) {
            let ctx = Ctx::new(Time::from_millis(self.ms));
            let behind = VEHICLE.trailer(&self.pose, self.trailer);
            let see = |axis: &Pose2| {
                let places: Vec<Point2> = obstacles.iter().map(|place| axis.to_inner(*place)).collect();
                Scan { stamp: ctx.now(), ..scan(&places) }
            };
            let (ahead, back, hitch) = (see(&self.pose), see(&behind), behind.relative_to(&self.pose));
            let odometry = Pose2::new(7.0, 7.0, 0.0).compose(&self.pose);
            let (mut reached, mut blocked, mut off) = (None, None, None);
            let (a, b, c) = (apex_rt::event(&mut reached), apex_rt::event(&mut blocked), apex_rt::event(&mut off));
            let (pose, hitch, ahead, back) = (Some(&self.pose), Some(&hitch), Some(&ahead), Some(&back));
            let (ground, odometry) = (self.ground.as_ref(), Some(&odometry));
            let twist = self.node.process(&ctx, pose, hitch, path, ahead, back, ground, odometry, a, b, c);
            let twist = twist.expect("near the origin");
            let ends = [(reached, End::Reached), (blocked, End::Blocked), (off, End::OffPath)];
            (twist, ends.into_iter().find_map(|(event, end)| event.map(|()| end)))
        }

        fn drive(&mut self, twist: Twist) {
            for _ in 0..4 {
                let follow = |now: f32, wanted: f32| now + 0.2 * (wanted - now);
                self.twist = Twist::new(follow(self.twist.x, twist.x), 0.0, follow(self.twist.omega, twist.omega));
                let bend = self.pose.theta - self.trailer;
                self.trailer += 0.02 * VEHICLE.trailer_rotation(self.twist.x, self.twist.omega, bend);
                self.pose = self.pose.compose(&Pose2::new(0.02 * self.twist.x, 0.0, 0.02 * self.twist.omega));
            }
            self.ms += 80;
        }

        /// Follows a path to its end; calls `watch` after each step.
        fn follow(&mut self, path: &Path, obstacles: &[Point2], mut watch: impl FnMut(&Pose2, Twist)) -> End {
            let mut reaction = self.react(Some(path), obstacles);
            for _ in 0..2000 {
                let (twist, end) = reaction;
                let twist = twist.expect("it sends twists while it drives");
                if let Some(end) = end {
                    assert_eq!(twist, Twist::ZERO);
                    assert_eq!(self.react(None, obstacles), (None, None));
                    return end;
                }
                self.drive(twist);
                watch(&self.pose, self.twist);
                reaction = self.react(None, obstacles);
            }
            panic!("it does not come to an end");
        }
    }

    /// Distance of a place from a path.
    fn off(path: &Path, place: Point2) -> f32 {
        let pairs = path.points.windows(2);
        pairs.map(|ends| (super::super::path::nearest_on(ends[0], ends[1], place) - place).norm()).fold(9.0, f32::min)
    }

    #[test]
    fn it_keeps_to_the_sharpest_curves_of_the_planner() {
        for arcs in
            [[(0.0, 2.0), (1.4, 1.2), (-1.4, 2.2), (0.0, 2.0)], [(1.25, 2.0), (-1.25, 2.0), (1.25, 2.0), (0.0, 1.0)]]
        {
            let way = path(Pose2::new(1.0, 2.0, 0.5), &arcs);
            let mut robot = Robot::new(node(), Pose2::new(1.0, 2.0, 0.5));
            let (mut worst, mut fastest): (f32, f32) = (0.0, 0.0);
            let end = robot.follow(&way, &[], |pose, twist| {
                worst = worst.max(off(&way, pose.position()));
                fastest = fastest.max(twist.x);
            });
            assert_eq!(end, End::Reached);
            assert!(worst < 0.05 && fastest > 0.6, "{worst} m off at up to {fastest} m/s");
        }
    }

    #[test]
    fn it_comes_back_to_its_path_and_stops_at_its_end() {
        let way = path(Pose2::default(), &[(0.0, 6.0)]);
        let mut robot = Robot::new(node(), Pose2::new(0.0, 0.3, 0.2));
        let mut last = 9.0;
        assert_eq!(robot.follow(&way, &[], |_, twist| last = twist.x), End::Reached);
        let Pose2 { x, y, theta } = robot.pose;
        assert!((5.85..6.0).contains(&x) && y.abs() < 0.02 && theta.abs() < 0.03, "{x} m, {y} m, {theta}");
        assert!(last < 0.2, "{last} m/s");
    }

    #[test]
    fn it_slows_down_before_what_its_load_would_touch_in_a_curve() {
        // On the inner side of the curve, beside the way of the tractor.
        let (way, corner) = (path(Pose2::default(), &[(0.0, 2.0), (1.4, 1.1), (0.0, 2.0)]), Point2::new(2.28, 0.5));
        for (load, stops) in [([0.0; 2], false), ([1.2, 0.7], true)] {
            let load = CurveFollower { load_length: load[0], load_width: load[1], ..node() };
            let mut robot = Robot::new(load, Pose2::default());
            let mut last = 9.0;
            let end = robot.follow(&way, &[corner], |_, twist| last = twist.x);
            assert_eq!(end == End::Blocked, stops, "{end:?} at {:?}", robot.pose);
            assert!(!stops || robot.pose.x < 2.2, "{:?}", robot.pose);
        }
    }

    #[test]
    fn it_stops_before_a_hazard_on_the_ground() {
        let raster = Raster { corner: Point2::new(4.0, 4.0), resolution: 0.05, width: 160, height: 120 };
        let end = |y: f32, kind: Occupancy| {
            let mut ground = Grid::new(raster, Occupancy::Free).expect("small");
            let cell = raster.cell(Point2::new(10.02, 7.02 + y)).expect("inside");
            *ground.get_mut(cell).expect("inside") = kind;
            let mut robot = Robot::new(node(), Pose2::default());
            robot.ground = Some(ground);
            let end = robot.follow(&path(Pose2::default(), &[(0.0, 4.5)]), &[], |_, _| ());
            (end, robot.pose.x)
        };
        for kind in [Occupancy::Occupied, Occupancy::Unknown] {
            let (outcome, x) = end(0.0, kind);
            assert!(outcome == End::Blocked && (1.8..2.6).contains(&x), "{outcome:?} at {x} m");
        }
        assert_eq!(end(0.4, Occupancy::Occupied).0, End::Reached);
    }

    #[test]
    fn a_new_path_does_not_stop_it() {
        let way = path(Pose2::default(), &[(0.0, 20.0)]);
        let mut robot = Robot::new(node(), Pose2::default());
        let mut twist = robot.react(Some(&way), &[]).0.expect("it drives");
        for step in 0..40 {
            robot.drive(twist);
            twist = robot.react((step == 30).then_some(&way), &[]).0.expect("it drives");
        }
        assert!(twist.x > 0.65, "{twist:?}");
        robot.ms += 2000;
        assert!(robot.react(Some(&way), &[]).0.expect("it drives").x < 0.2);
    }

    #[test]
    fn it_gives_up_far_from_its_path_and_without_progress() {
        let way = path(Pose2::default(), &[(0.0, 5.0)]);
        let mut robot = Robot::new(node(), Pose2::new(2.0, 1.5, 0.0));
        assert_eq!(robot.react(Some(&way), &[]).1, Some(End::OffPath));
        let mut robot = Robot::new(node(), Pose2::new(0.0, 0.0, FRAC_PI_2));
        let mut ends = vec![robot.react(Some(&way), &[]).1];
        for _ in 0..30 {
            robot.ms += 80;
            ends.push(robot.react(None, &[]).1);
        }
        assert_eq!(ends.iter().flatten().collect::<Vec<_>>(), [&End::Blocked]);
        let nowhere = Path { points: vec![Point2::default(), Point2::new(f32::NAN, 0.0)], heading: 0.0 };
        assert_eq!(robot.react(Some(&nowhere), &[]).1, Some(End::Blocked));
        assert_eq!(robot.react(Some(&Path::default()), &[]), (None, None));
    }

    #[test]
    fn it_stands_without_poses() {
        let (mut node, way) = (node(), path(Pose2::default(), &[(0.0, 5.0)]));
        let hitch = Pose2::new(-0.65, 0.0, 0.0);
        let none = Event::unconnected;
        let mut fire = |ms: i64, pose: Option<&Pose2>, path: Option<&Path>| {
            let ctx = Ctx::new(Time::from_millis(ms));
            node.process(&ctx, pose, Some(&hitch), path, None, None, None, None, none(), none(), none())
        };
        let (here, far) = (Pose2::default(), Pose2::new(2e5, 0.0, 0.0));
        assert!(fire(0, Some(&here), Some(&way)).is_ok_and(|twist| twist.is_some()));
        assert!(fire(80, Some(&here), None).is_ok_and(|twist| twist.is_some_and(|twist| twist.x > 0.0)));
        assert_eq!(fire(160, None, None), Ok(Some(Twist::ZERO)));
        assert_eq!(fire(240, Some(&Pose2::new(f32::NAN, 0.0, 0.0)), None), Ok(Some(Twist::ZERO)));
        assert_eq!(fire(320, Some(&far), None), Err(FarFromOrigin));
    }
}
