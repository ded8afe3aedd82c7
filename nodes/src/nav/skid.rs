use super::{
    FollowingLaw, Path, Projection, Twist,
    latest::{Latest, any_far, fresh},
    path::nearest_on,
    progress::{End, Progress, RESUMES},
    twist::{Halt, braking_speed},
};
use crate::{
    map::{Grid, Occupancy},
    math::normalize_angle,
    scan::{BeamDirections, FarFromOrigin, Point2, Pose2, Scan},
};
use apex_rt::{Ctx, Event, Time, node};
use core::f32::consts::PI;
use libm::{coshf, fabsf, fmaxf, fminf, sinf, sqrtf, tanhf};

/// Half of the length on which direction and curvature of a path are measured, in m.
const CHORD: f32 = 0.4;
/// Distance between the places of a path at which its curvature and the map are looked at, in m.
const PROBE: f32 = 0.2;
/// Distance from the side of the robot within which what stands there is in its way, in m.
const BESIDE: f32 = 0.05;
/// Time after which the robot begins to brake, in s.
const LATENCY: f32 = 0.1;
/// Distance from the end up to which the last points are passed one by one, in m.
const CORNER: f32 = 0.05;

/// Follows a path with a skid-steered robot that drives fast (Huskić, Buck, Zell 2017).
///
/// The error of the pose is that in the frame of the path at the projection of the robot: its offset y and its
/// direction θ against the tangent. The direction that leads back to the path is δ = −`approach`·tanh(y), and the
/// angular velocity κ·v·cos θ + dδ/dt − `gain`·(θ − δ) makes both errors vanish. The speed is `speed`/(1 + |`slip`·κ|),
/// times the exponential law of [`FollowingLaw`] with the turning of the path within `look_ahead`, the rotation of the
/// robot and the distance from the end. It is limited so that neither the curve at hand nor those ahead take more than
/// `side_acceleration`, as a robot that turns fast slides and tips; so that the robot can stop at the end, beyond which
/// nothing was planned; and by what `scan` sees within `clearance` of the path: from there the robot stops `margin`
/// before it.
///
/// A path at `follow` is followed forward, and one at `back` backward; a new one replaces the present one, and the
/// robot goes on at its speed. `pose` is in the frame of the path. `scan` is in the frame of the robot, and `map` in
/// that of the path: a path over an occupied cell is blocked. Without a pose that is younger than `max_age` the robot
/// stands. The node sends twists while it has a path, and drops it when the robot
///
/// - has `reached` its end up to `tolerance`; with a `linger` it brakes there for as long, before it drops the path,
/// - is `blocked`: for longer than `blocked_timeout`, an obstacle is on the path, or it makes no progress for longer
///   than `patience`, or the path is not finite,
/// - is `off_path`: farther than `max_offset` from the path,
/// - has been deactivated for `linger`: until then another path may come, so that the robot need not stop in between.
///
/// Stops and fails while the pose is more than 100 km from the origin. That the robot stops before obstacles, and
/// without scans, is the task of a [`SafetyField`](super::SafetyField).
#[node]
#[derive(Debug, Clone)]
pub struct SkidFollower {
    /// Speed on a straight path.
    #[param(unit = "m/s", default = 1.0, range = 0.0..=10.0)]
    speed: f32,
    /// Minimum speed on the path.
    #[param(unit = "m/s", default = 0.1, range = 0.001..=1.0)]
    min_speed: f32,
    /// Maximum acceleration and planned deceleration.
    #[param(unit = "m/s^2", default = 1.5, range = 0.01..=100.0)]
    acceleration: f32,
    /// Maximum acceleration to the side in a curve.
    #[param(unit = "m/s^2", default = 1.8, range = 0.01..=100.0)]
    side_acceleration: f32,
    /// Maximum angular velocity.
    #[param(unit = "rad/s", default = 1.6, range = 0.0..=20.0)]
    max_rotation: f32,
    /// Greatest angle towards the path (θ_a).
    #[param(unit = "rad", default = 0.8, range = 0.0..=1.5)]
    approach: f32,
    /// Angular velocity per error of the direction (k₂).
    #[param(unit = "1/s", default = 2.5, range = 0.0..=100.0)]
    gain: f32,
    /// Distance of the instantaneous centre of rotation of a side from the middle, which slip moves outward (y_ICR).
    #[param(unit = "m", default = 0.4, range = 0.0..=10.0)]
    slip: f32,
    /// Gain of the slowdown by curves ahead (K_κ).
    #[param(unit = "1/rad", default = 0.25, range = 0.0..=100.0)]
    turning_gain: f32,
    /// Gain of the slowdown by the robot's own rotation (K_ω).
    #[param(unit = "s/rad", default = 0.1, range = 0.0..=100.0)]
    rotation_gain: f32,
    /// Gain of the slowdown near the end (K_g).
    #[param(unit = "m", default = 0.15, range = 0.0..=100.0)]
    goal_gain: f32,
    /// Length of the path ahead that is examined for curves and obstacles.
    #[param(unit = "m", default = 4.0, range = 0.1..=100.0)]
    look_ahead: f32,
    /// Distance of obstacles from the path up to which they are on it: half of the robot's width, and more.
    #[param(unit = "m", default = 0.42, range = 0.0..=10.0)]
    clearance: f32,
    /// Width of the robot.
    #[param(unit = "m", default = 0.61, range = 0.01..=20.0)]
    width: f32,
    /// Distance from the beginning of a path up to which the robot was beside what the scan sees there: it is on the
    /// path only within half of `width`, and 5 cm more. What is occupied on the map does not count there. A planner
    /// that lets the robot get away from what is that close does the same.
    #[param(unit = "m", default = 0.3, range = 0.0..=20.0)]
    stands: f32,
    /// Distance from an obstacle on the path, along it, at a stop, counted from the middle of the robot.
    #[param(unit = "m", default = 0.7, range = 0.0..=10.0)]
    margin: f32,
    /// Remaining length of the path at which the end is reached.
    #[param(unit = "m", default = 0.3, range = 0.001..=10.0)]
    tolerance: f32,
    /// Maximum distance from the path. Beyond it the robot gives up with `off_path`.
    #[param(unit = "m", default = 1.2, range = 0.01..=100.0)]
    max_offset: f32,
    /// Time that an obstacle may be on the path.
    #[param(unit = "s", default = 0.4, range = 0.0..=600.0)]
    blocked_timeout: f32,
    /// Time that the robot may go without progress.
    #[param(unit = "s", default = 1.5, range = 0.0..=600.0)]
    patience: f32,
    /// Time for which the robot goes on along its path after the activity has left.
    #[param(unit = "s", default = 0.0, range = 0.0..=10.0)]
    linger: f32,
    /// Maximum age of poses, scans and maps.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    path: Path,
    is_back: bool,
    progress: Progress,
    /// Time, speed and angular velocity of the last command.
    last: Option<(Time, f32, f32)>,
    scan: Latest<Scan>,
    map: Latest<Grid<Occupancy>>,
    /// Time up to which the robot goes on without activity, or at the end of the path, once that has begun.
    until: Option<Option<Time>>,
    is_at_end: bool,
    halt: Halt,
    directions: BeamDirections,
}

#[node]
impl SkidFollower {
    #[allow(clippy::too_many_arguments, reason = "they are the ports")]
    fn process(
        &mut self,
        ctx: &Ctx,
        pose: Option<&Pose2>,
        scan: Option<&Scan>,
        map: Option<&Grid<Occupancy>>,
        reached: Event<()>,
        #[failure] blocked: Event<()>,
        #[failure] off_path: Event<()>,
    ) -> Result<Option<Twist>, FarFromOrigin> {
        self.scan.update(ctx, scan, self.max_age);
        self.map.update(ctx, map, self.max_age);
        self.end_lingering(ctx.now());
        if self.path.points.is_empty() {
            return Ok(self.halt.rest());
        }
        if any_far([pose]) {
            return self.halt.far();
        }
        Ok(self.step(ctx, fresh(ctx, pose, self.max_age), [reached, blocked, off_path]))
    }

    /// Takes a path, which is followed forward.
    #[slot]
    fn follow(&mut self, path: &Path, ctx: &Ctx) {
        self.begin(path, false, ctx.now());
    }

    /// Takes a path, which is followed backward.
    #[slot]
    fn back(&mut self, path: &Path, ctx: &Ctx) {
        self.begin(path, true, ctx.now());
    }

    /// Drops the path at once: another node takes over.
    #[slot]
    fn stop(&mut self) {
        self.path.points.clear();
    }

    /// Goes on for a moment.
    #[on_deactivate]
    fn leave(&mut self) {
        self.until = Some(None);
    }

    fn end_lingering(&mut self, now: Time) {
        let linger = core::time::Duration::from_secs_f32(self.linger.max(0.0));
        if let Some(until) = &mut self.until
            && now >= *until.get_or_insert(now + linger)
        {
            self.until = None;
            self.path.points.clear();
        }
    }

    /// Begins a path. A robot that was driving just before goes on at its speed.
    fn begin(&mut self, path: &Path, is_back: bool, now: Time) {
        let goes_on = |at: Time| now.since(at).as_secs_f32() <= RESUMES;
        self.last = self.last.filter(|(at, ..)| goes_on(*at) && self.is_back == is_back);
        self.is_back = is_back;
        (self.until, self.is_at_end) = (None, false);
        self.path.take(path);
        self.progress = Progress::default();
    }

    fn step(&mut self, ctx: &Ctx, pose: Option<&Pose2>, ends: [Event<()>; 3]) -> Option<Twist> {
        let Some(pose) = pose else {
            self.last = None;
            self.progress.pause();
            return self.halt.drive(Twist::ZERO);
        };
        let Some(projection) = self.path.project(pose.position(), self.progress.segment, CORNER) else {
            // The path is not finite.
            return self.give_up_with(End::Blocked, ends);
        };
        self.progress.segment = projection.segment;
        let free = self.free_length(ctx, pose, &projection);
        match self.end(&projection, free.is_finite(), ctx.now()) {
            Some(End::Reached) if self.linger > 0.0 => self.arrive(ends),
            Some(end) => return self.give_up_with(end, ends),
            None => {}
        }
        let twist = self.drive(pose, &projection, free, ctx.now());
        self.halt.drive(twist)
    }

    fn give_up_with(&mut self, end: End, ends: [Event<()>; 3]) -> Option<Twist> {
        end.tell(ends);
        self.path.points.clear();
        self.halt.drive(Twist::ZERO)
    }

    /// Tells that the end is reached, from where the next path may lead on before the robot stands.
    fn arrive(&mut self, ends: [Event<()>; 3]) {
        if !self.is_at_end {
            End::Reached.tell(ends);
            (self.is_at_end, self.until) = (true, Some(None));
        }
    }

    /// Length of the path up to an obstacle, in m; infinite if there is none within the look-ahead.
    fn free_length(&mut self, ctx: &Ctx, pose: &Pose2, projection: &Projection) -> f32 {
        let reach = fminf(self.look_ahead, projection.remaining);
        let mut free = f32::INFINITY;
        let mut directions = core::mem::take(&mut self.directions);
        if let Some(scan) = self.scan.young(ctx, self.max_age) {
            let (sight, frame) = (self.look_ahead + self.clearance, pose.transform());
            let beside = fminf(self.clearance, 0.5 * self.width + BESIDE);
            for (_, point) in directions.points(scan).filter(|(_, point)| point.norm_squared() <= sight * sight) {
                let point = frame.to_outer(point);
                let clearance = if self.is_at_begin(point) { beside } else { self.clearance };
                free = fminf(free, self.along(point, projection, reach, clearance));
            }
        }
        self.directions = directions;
        if let Some(map) = self.map.young(ctx, self.max_age) {
            let mut ahead = 0.0;
            while ahead < reach && ahead < free {
                let place = self.path.ahead(projection, ahead);
                let cell = map.raster().cell(place);
                let is_occupied = cell.and_then(|cell| map.get(cell)).is_some_and(|cell| cell.is_obstacle());
                if is_occupied && !self.is_at_begin(place) {
                    free = fminf(free, ahead);
                }
                ahead += PROBE;
            }
        }
        free
    }

    /// Returns `true` for a place beside which the robot stood when the path was planned.
    fn is_at_begin(&self, place: Point2) -> bool {
        self.path.points.first().is_some_and(|begin| (place - *begin).norm_squared() <= self.stands * self.stands)
    }

    /// Length of the path up to a point that is within `clearance` m of it, in m; infinite for one beside it, or behind
    /// the robot.
    fn along(&self, point: Point2, projection: &Projection, reach: f32, clearance: f32) -> f32 {
        let (mut passed, mut last) = (0.0, projection.point);
        for next in &self.path.points[projection.segment + 1..] {
            if passed > reach {
                break;
            }
            let nearest = nearest_on(last, *next, point);
            let along = passed + (nearest - last).norm();
            // What is beside the robot is not ahead of it.
            if (point - nearest).norm() <= clearance && along > 0.0 {
                return along;
            }
            passed += (*next - last).norm();
            last = *next;
        }
        f32::INFINITY
    }

    fn end(&mut self, projection: &Projection, is_obstructed: bool, now: Time) -> Option<End> {
        if projection.remaining <= self.tolerance {
            return Some(End::Reached);
        }
        if projection.distance > self.max_offset {
            return Some(End::OffPath);
        }
        self.progress.advance(projection.remaining + projection.distance, now);
        self.progress.obstruct(is_obstructed, now);
        self.progress.is_blocked(self.blocked_timeout, self.patience, now).then_some(End::Blocked)
    }

    /// Direction and curvature of the path at a distance ahead, in rad and in 1/m.
    fn course(&self, projection: &Projection, ahead: f32) -> (f32, f32) {
        let at = |d: f32| self.path.ahead(projection, ahead + d);
        let (into, out) = ((at(0.0) - at(-CHORD)).angle(), (at(CHORD) - at(0.0)).angle());
        ((at(CHORD) - at(-CHORD)).angle(), normalize_angle(&(out - into)) / CHORD)
    }

    fn drive(&mut self, pose: &Pose2, projection: &Projection, free: f32, now: Time) -> Twist {
        let (elapsed, before, rotation) =
            self.last.map_or((0.0, 0.0, 0.0), |(at, speed, rotation)| (now.since(at).as_secs_f32(), speed, rotation));
        let (tangent, curvature) = self.course(projection, 0.0);
        let speed = self.wanted_speed(projection, curvature, rotation, free);
        let speed = speed.clamp(before - 3.0 * self.acceleration * elapsed, before + self.acceleration * elapsed);
        let speed = fmaxf(speed, 0.0);
        // Backward, the robot moves in the direction opposite to its heading.
        let heading = if self.is_back { pose.theta + PI } else { pose.theta };
        let error = normalize_angle(&(heading - tangent));
        let y = projection.offset;
        let wanted = -self.approach * tanhf(y);
        let cosh = coshf(y.clamp(-20.0, 20.0));
        let wanted_rate = -self.approach * speed * sinf(error) / (cosh * cosh);
        let advance = speed * libm::cosf(error);
        let turn = curvature * advance + wanted_rate - self.gain * normalize_angle(&(error - wanted));
        let most = fminf(self.max_rotation, self.side_acceleration / fmaxf(speed, 0.1));
        let turn = turn.clamp(-most, most);
        self.last = Some((now, speed, turn));
        Twist::new(if self.is_back { -speed } else { speed }, 0.0, turn)
    }

    fn wanted_speed(&self, projection: &Projection, curvature: f32, rotation: f32, free: f32) -> f32 {
        let law = FollowingLaw {
            convergence: 0.0,
            speed: self.speed / (1.0 + fabsf(self.slip * curvature)),
            min_speed: self.min_speed,
            turning_gain: self.turning_gain,
            rotation_gain: self.rotation_gain,
            obstacle_gain: 0.0,
            goal_gain: self.goal_gain,
        };
        let turning = self.path.turning(projection, self.look_ahead);
        let mut speed = law.speed(turning, rotation, f32::INFINITY, projection.remaining);
        let mut ahead = 0.0;
        while ahead < fminf(self.look_ahead, projection.remaining) {
            let (_, curvature) = self.course(projection, ahead);
            let in_curve = self.side_acceleration / fmaxf(fabsf(curvature), 1e-3);
            speed = fminf(speed, sqrtf(in_curve + 2.0 * self.acceleration * ahead));
            ahead += 2.0 * PROBE;
        }
        let way = fminf(fmaxf(free - self.margin, 0.0), projection.remaining);
        fminf(speed, braking_speed(way, self.acceleration, LATENCY))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Raster;
    use apex_rt::{Construct, event};
    use core::f32::consts::TAU;

    fn node(speed: f32, linger: f32) -> SkidFollower {
        SkidFollower::construct((
            speed, 0.1, 1.5, 1.8, 1.6, 0.8, 2.5, 0.4, 0.25, 0.1, 0.15, 4.0, 0.42, 0.61, 0.3, 0.7, 0.3, 1.2, 0.4, 1.5,
            linger, 0.5,
        ))
    }

    /// Path along arcs of a curvature in 1/m and a length in m, with points 0.2 m apart.
    fn path(start: Pose2, arcs: &[(f32, f32)]) -> Path {
        let (mut pose, mut points) = (start, vec![start.position()]);
        for (curvature, length) in arcs {
            for _ in 0..libm::roundf(length / 0.2) as usize {
                pose = pose.compose(&Pose2::new(0.2, 0.0, 0.2 * curvature));
                points.push(pose.position());
            }
        }
        Path { points, heading: pose.theta }
    }

    /// Robot that turns too little and drifts sideways in curves.
    struct Robot {
        node: SkidFollower,
        pose: Pose2,
        twist: Twist,
        ms: i64,
        obstacles: Vec<Point2>,
        map: Option<Grid<Occupancy>>,
    }

    impl Robot {
        fn new(node: SkidFollower, pose: Pose2) -> Self {
            Self { node, pose, twist: Twist::ZERO, ms: 0, obstacles: vec![], map: None }
        }

        fn react(&mut self, path: Option<&Path>, back: Option<&Path>) -> (Option<Twist>, Option<End>) {
            let ctx = Ctx::new(Time::from_millis(self.ms));
            let mut scan = Scan {
                angle_min: -PI,
                angle_increment: TAU / 360.0,
                range_max: 20.0,
                stamp: ctx.now(),
                ..Scan::default()
            };
            scan.ranges.extend([f32::INFINITY; 360]);
            for place in &self.obstacles {
                let place = self.pose.to_inner(*place);
                scan.ranges[libm::roundf((place.angle() + PI) / scan.angle_increment) as usize % 360] = place.norm();
            }
            let (mut reached, mut blocked, mut off) = (None, None, None);
            path.into_iter().for_each(|path| self.node.follow(path, &ctx));
            back.into_iter().for_each(|path| self.node.back(path, &ctx));
            let twist = self.node.process(
                &ctx,
                Some(&self.pose),
                Some(&scan),
                self.map.as_ref(),
                event(&mut reached),
                event(&mut blocked),
                event(&mut off),
            );
            let ends = [(reached, End::Reached), (blocked, End::Blocked), (off, End::OffPath)];
            (twist.expect("near the origin"), ends.into_iter().find_map(|(event, end)| event.map(|()| end)))
        }

        fn drive(&mut self, twist: Twist) {
            for _ in 0..5 {
                let follow = |now: f32, wanted: f32| now + 0.15 * (wanted - now);
                self.twist = Twist::new(follow(self.twist.x, twist.x), 0.0, follow(self.twist.omega, twist.omega));
                let turn = 0.85 * self.twist.omega;
                self.pose = self.pose.compose(&Pose2::new(0.01 * self.twist.x, 0.01 * 0.06 * turn, 0.01 * turn));
            }
            self.ms += 50;
        }

        /// Follows a path to its end; calls `watch` after each step.
        fn follow(&mut self, path: Option<&Path>, back: Option<&Path>, mut watch: impl FnMut(&Pose2, Twist)) -> End {
            let (mut twist, mut end) = self.react(path, back);
            for _ in 0..2000 {
                if let Some(end) = end {
                    return end;
                }
                self.drive(twist.unwrap_or(Twist::ZERO));
                watch(&self.pose, self.twist);
                (twist, end) = self.react(None, None);
            }
            panic!("the path does not end");
        }
    }

    #[test]
    fn fast_on_a_straight_and_slow_in_curves() {
        let bends = path(Pose2::default(), &[(0.0, 15.0), (0.5, 3.0), (-0.5, 3.0), (0.0, 12.0)]);
        let mut robot = Robot::new(node(2.5, 0.0), Pose2::new(0.0, 0.3, 0.0));
        let (mut fastest, mut side, mut off) = (0.0_f32, 0.0_f32, 0.0_f32);
        let mut segment = 0;
        let end = robot.follow(Some(&bends), None, |pose, twist| {
            fastest = fastest.max(twist.x);
            side = side.max((twist.x * twist.omega).abs());
            let projection = bends.project(pose.position(), segment, CORNER).expect("on it");
            segment = projection.segment;
            if pose.x > 4.0 {
                off = off.max(projection.distance);
            }
        });
        assert_eq!(end, End::Reached);
        assert!(fastest > 1.9 && side < 2.0 && off < 0.35, "{fastest} m/s, {side} m/s², {off} m");
    }

    /// Nothing beyond the end of a path was looked at when it was planned.
    #[test]
    fn it_stands_where_its_path_ends() {
        for linger in [0.0, 1.0] {
            let straight = path(Pose2::default(), &[(0.0, 8.0)]);
            let mut robot = Robot::new(node(2.5, linger), Pose2::default());
            let (mut fastest, mut farthest) = (0.0_f32, 0.0_f32);
            let end = robot.follow(Some(&straight), None, |_, twist| fastest = fastest.max(twist.x));
            robot.node.leave();
            let mut ends = vec![end];
            for _ in 0..30 {
                let (twist, end) = robot.react(None, None);
                robot.drive(twist.unwrap_or(Twist::ZERO));
                farthest = farthest.max(robot.pose.x);
                ends.extend(end);
            }
            assert!(fastest > 2.0 && (7.5..8.1).contains(&farthest), "{linger}: {fastest} m/s, {farthest} m");
            assert_eq!(ends, [End::Reached], "{linger}");
            assert_eq!(robot.react(None, None).0, None, "{linger}");
        }
    }

    #[test]
    fn it_backs_up_along_a_path() {
        let back = path(Pose2::new(0.0, 0.0, PI), &[(0.0, 2.0), (0.4, 2.0), (0.0, 1.0)]);
        let mut robot = Robot::new(node(0.6, 0.0), Pose2::new(0.0, 0.1, 0.0));
        let end = robot.follow(None, Some(&back), |_, twist| assert!(twist.x <= 0.0));
        let off = (robot.pose.position() - back.points[back.points.len() - 1]).norm();
        assert!(end == End::Reached && off < 0.5, "{end:?} {off}");
    }

    #[test]
    fn it_stops_before_an_obstacle_on_the_path_and_passes_one_beside_it() {
        let straight = path(Pose2::default(), &[(0.0, 14.0)]);
        for (y, expected) in [(0.2, End::Blocked), (0.8, End::Reached)] {
            let mut robot = Robot::new(node(2.5, 0.0), Pose2::default());
            robot.node.blocked_timeout = 20.0;
            robot.obstacles.push(Point2::new(9.0, y));
            let end = robot.follow(Some(&straight), None, |_, _| ());
            assert_eq!(end, expected);
            assert!(end == End::Reached || (7.5..8.4).contains(&robot.pose.x), "{}", robot.pose.x);
        }
    }

    /// Things that the planner lets the robot get away from are not in its way.
    #[test]
    fn it_gets_away_from_what_it_stands_beside() {
        let straight = path(Pose2::default(), &[(0.0, 4.0)]);
        let raster = Raster { corner: Point2::new(-6.0, -6.0), resolution: 0.1, width: 120, height: 120 };
        let ends = |stands: f32, seen: Point2, marked: Point2| {
            let mut robot = Robot::new(node(1.0, 0.0), Pose2::default());
            robot.node.stands = stands;
            robot.obstacles.push(seen);
            let mut map = Grid::new(raster, Occupancy::Free).expect("small");
            *raster.cell(marked).and_then(|cell| map.get_mut(cell)).expect("on the map") = Occupancy::Occupied;
            robot.map = Some(map);
            robot.follow(Some(&straight), None, |_, _| ())
        };
        let (far, beside, ahead) = (Point2::new(5.0, 5.0), Point2::new(0.3, 0.39), Point2::new(0.52, 0.03));
        for (seen, marked) in [(beside, far), (far, ahead), (beside, ahead)] {
            assert_eq!(ends(0.3, seen, marked), End::Blocked, "{seen:?} {marked:?}");
            assert_eq!(ends(0.7, seen, marked), End::Reached, "{seen:?} {marked:?}");
        }
        // What it would run into, and what stands farther away.
        for (seen, marked) in
            [(Point2::new(0.5, 0.3), far), (Point2::new(2.0, 0.39), far), (far, Point2::new(2.0, 0.0))]
        {
            assert_eq!(ends(0.7, seen, marked), End::Blocked, "{seen:?} {marked:?}");
        }
    }

    #[test]
    fn it_goes_on_for_a_moment_without_activity() {
        for (linger, lasts) in [(0.0, 0), (0.3, 7)] {
            let mut robot = Robot::new(node(1.0, linger), Pose2::default());
            let straight = path(Pose2::default(), &[(0.0, 14.0)]);
            let mut twist = robot.react(Some(&straight), None).0;
            for _ in 0..40 {
                robot.drive(twist.expect("it drives"));
                twist = robot.react(None, None).0;
            }
            robot.node.leave();
            let mut moves = 0_i32;
            for _ in 0..20 {
                twist = robot.react(None, None).0;
                moves += i32::from(twist.is_some_and(|twist| twist.x > 0.0));
                robot.drive(twist.unwrap_or(Twist::ZERO));
            }
            assert!((lasts - 1..=lasts).contains(&moves), "{linger}: {moves}");
        }
    }

    #[test]
    fn beside_its_path_it_gives_up() {
        let straight = path(Pose2::default(), &[(0.0, 14.0)]);
        let mut robot = Robot::new(node(1.0, 0.0), Pose2::new(0.0, 2.0, 0.0));
        assert_eq!(robot.follow(Some(&straight), None, |_, _| ()), End::OffPath);
        let odd = Path { points: vec![Point2::default(), Point2::new(f32::NAN, 0.0)], heading: 0.0 };
        assert_eq!(robot.follow(Some(&odd), None, |_, _| ()), End::Blocked);
    }
}
