use super::{
    dubins::{Curve, advanced, curves},
    vehicle::{Arrival, Articulated, approach_speed, arrival},
};
use crate::{
    map::{Grid, Occupancy},
    math::normalize_angle,
    nav::{
        Clearance, Twist,
        clearance::SLACK,
        latest::{Latest, any_far, both_fresh, fresh},
        near::{GRAZE, Near, Zone},
        twist::Halt,
    },
    scan::{FarFromOrigin, Point2, Pose2},
};
use apex_rt::{Ctx, Event, Time, node};
use libm::{ceilf, fmaxf, sinf};

/// Step of the prediction of the trailer, in m.
const STEP: f32 = 0.1;
/// Step of the search for the nearest point of the curve, in m.
const FINE: f32 = 0.01;
/// Distance ahead that the nearest point of the curve is searched in, in m.
const AHEAD: f32 = 0.3;
/// Number of positions where the straight line to the container may begin, and the distance between them, in m.
const LINES: (u8, f32) = (13, 0.25);
/// Gains of the offset (1/m²) and of the heading (1/m) from the curve: the offset decays within half a metre.
const GAINS: [f32; 2] = [8.0, 5.0];
/// Largest offset of the trailer's rear from the centre line at the end of a plan, in m.
const STRAIGHT: f32 = 0.02;
/// Largest offset from the curve, in m. Farther away, another one is planned.
const OFF_CURVE: f32 = 0.2;
/// Time for which the vehicle waits for a container, in s.
const WAITS: f32 = 2.0;

/// Steers a tractor with a passively steered trailer beneath a container, along a planned curve.
///
/// The ports are those of [`ReactiveApproach`](super::ReactiveApproach). At the first container, and whenever the
/// container turns out to be elsewhere, the node plans the way of tractor and trailer: the shortest of the Dubins
/// curves to a line before the container, on which the predicted trailer comes into line, is never bent by more than
/// `max_bend`, and touches nothing of the container but the free strip between its wheels. `missed` comes if there is
/// no such curve, if the vehicle is beside its goal at the end, or if no container comes in the first two seconds.
/// Without both poses, or with poses older than `max_age`, the vehicle stands still.
///
/// `ground` is a map in the frame of `base`, in which the place of the container is free. It may be ⊥, as clouds come
/// less often than poses. If the vehicle would not keep the `clearance` from the hazards of it on the rest of the
/// curve, another curve is planned that leads around, if there is one. That the vehicle stops before hazards is the
/// task of a [`SweepStop`](super::super::SweepStop) with the same clearance behind this node.
#[node]
#[derive(Debug, Clone)]
pub struct PlannedApproach {
    /// Radius of the curves.
    #[param(unit = "m", default = 0.8, range = 0.1..=10.0)]
    radius: f32,
    /// Maximum angle between tractor and trailer.
    #[param(unit = "rad", default = 1.0, range = 0.1..=1.5)]
    max_bend: f32,
    /// Maximum speed.
    #[param(unit = "m/s", default = 0.5, range = 0.001..=10.0)]
    max_speed: f32,
    /// Minimum speed.
    #[param(unit = "m/s", default = 0.03, range = 0.001..=1.0)]
    min_speed: f32,
    /// Deceleration before the goal.
    #[param(unit = "m/s^2", default = 0.2, range = 0.01..=10.0)]
    deceleration: f32,
    /// Shape of the vehicle.
    #[param(default = Articulated::PATSY)]
    vehicle: Articulated,
    /// Length of the container.
    #[param(unit = "m", default = 1.2, range = 0.0..=10.0)]
    container_length: f32,
    /// Width of the container.
    #[param(unit = "m", default = 0.76, range = 0.0..=10.0)]
    container_width: f32,
    /// Width of the free strip between its wheels, including castors that are turned.
    #[param(unit = "m", default = 0.43, range = 0.0..=10.0)]
    free_width: f32,
    /// Distance kept from the container beside the strip.
    #[param(unit = "m", default = 0.05, range = 0.0..=10.0)]
    margin: f32,
    /// Maximum change of the container's pose without another plan, in position (m) and in heading (rad).
    #[param(default = 0.05, range = 0.001..=1.0)]
    replan: f32,
    /// Maximum offset of the vehicle from the middle of the container at the end, along its axis.
    #[param(unit = "m", default = 0.05, range = 0.001..=1.0)]
    tolerance: f32,
    /// Maximum offset across.
    #[param(unit = "m", default = 0.05, range = 0.001..=1.0)]
    across: f32,
    /// Distances kept from hazards.
    #[param(default = Clearance::PATSY)]
    clearance: Clearance,
    /// Maximum age of the poses.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    container: Option<Pose2>,
    /// Time of the first firing of an approach.
    began: Option<Time>,
    plan: Option<Plan>,
    ground: Latest<Grid<Occupancy>>,
    /// Hazards near the vehicle.
    near: Near,
    halt: Halt,
}

/// Planned curve and how far it has been driven.
#[derive(Debug, Clone, Copy)]
struct Plan {
    /// Container that the curve leads to.
    container: Pose2,
    curve: Curve,
    /// Distance driven on the curve, in m.
    driven: f32,
}

#[node]
impl PlannedApproach {
    fn process(
        &mut self,
        ctx: &Ctx,
        base: Option<&Pose2>,
        trailer: Option<&Pose2>,
        container: Option<&Pose2>,
        ground: Option<&Grid<Occupancy>>,
        reached: Event<()>,
        #[failure] missed: Event<()>,
    ) -> Result<Option<Twist>, FarFromOrigin> {
        if ctx.active() && any_far([base, trailer, container]) {
            return self.halt.far();
        }
        Ok(self.step(ctx, [base, trailer], container, ground, [reached, missed]))
    }

    fn step(
        &mut self,
        ctx: &Ctx,
        [base, trailer]: [Option<&Pose2>; 2],
        container: Option<&Pose2>,
        ground: Option<&Grid<Occupancy>>,
        [reached, missed]: [Event<()>; 2],
    ) -> Option<Twist> {
        if !ctx.active() {
            return self.halt.rest();
        }
        self.container = fresh(ctx, container, self.max_age).copied().or(self.container);
        let axes = both_fresh(ctx, [base, trailer], self.max_age);
        let waited = ctx.now().since(*self.began.get_or_insert(ctx.now())).as_secs_f32();
        let Some(((base, trailer), container)) = axes.zip(self.container) else {
            if self.container.is_none() && waited > WAITS {
                missed.emit(());
            }
            return self.halt.drive(Twist::ZERO);
        };
        let vehicle = &self.vehicle;
        let rear = container.to_inner(vehicle.rear_most(trailer));
        match arrival(&base.relative_to(&container), rear, vehicle.axis(), [self.tolerance, self.across]) {
            Arrival::Reached => {
                reached.emit(());
                return self.halt.drive(Twist::ZERO);
            }
            Arrival::Missed if self.is_past(base, &container) => {
                missed.emit(());
                return self.halt.drive(Twist::ZERO);
            }
            _ => {}
        }
        self.ground.update(ctx, ground, self.max_age);
        let Some(plan) = self.planned(ctx, [base, trailer], container) else {
            missed.emit(());
            return self.halt.drive(Twist::ZERO);
        };
        let twist = self.follow(base, &plan);
        self.plan = Some(plan);
        self.halt.drive(twist)
    }

    /// Forgets the container and the plan of the last approach.
    #[on_activate]
    fn forget(&mut self) {
        (self.container, self.began, self.plan) = (None, None, None);
    }

    /// Returns `true` at the end of the curve. Before, the vehicle may pass the container.
    fn is_past(&self, base: &Pose2, container: &Pose2) -> bool {
        let Some(plan) = &self.plan else { return false };
        let at_goal = base.relative_to(container).position() - Point2::new(self.vehicle.axis(), 0.0);
        plan.curve.length() - plan.driven < self.tolerance || at_goal.norm() < 2.0 * self.tolerance
    }

    /// The plan for the present pose, or `None` if there is no way.
    fn planned(&mut self, ctx: &Ctx, axes: [&Pose2; 2], container: Pose2) -> Option<Plan> {
        let [base, trailer] = axes;
        let Some(mut plan) = self.plan else { return self.plan(ctx, axes, container) };
        plan.driven = nearest(&plan.curve, plan.driven, base);
        let off = base.relative_to(&plan.curve.at(plan.driven).0);
        let moved = container.relative_to(&plan.container);
        let is_same = moved.position().norm() <= self.replan && moved.theta.abs() <= self.replan;
        if is_same && off.position().norm() <= OFF_CURVE {
            let zone = self.look(ctx, axes, 0.0);
            if self.is_open(&zone, &plan.curve, plan.driven, trailer.theta) {
                return Some(plan);
            }
        }
        // Near the goal only straight lines are left; without one, the old curve is the best that there is.
        self.plan(ctx, axes, container).or(Some(plan))
    }

    /// Shortest curve beneath the container on which the trailer fits, around hazards if that is possible.
    fn plan(&mut self, ctx: &Ctx, axes: [&Pose2; 2], container: Pose2) -> Option<Plan> {
        let (zone, [base, trailer]) = (self.look(ctx, axes, SLACK), axes);
        let goal = self.vehicle.axis();
        let (mut best, mut open): (Option<Curve>, Option<Curve>) = (None, None);
        let is_shorter = |curve: &Curve, than: Option<Curve>| than.is_none_or(|than| curve.length() < than.length());
        for line in 0..LINES.0 {
            let straight = LINES.1 * f32::from(line);
            let begin = container.compose(&Pose2::new(goal - straight, 0.0, 0.0));
            for curve in curves(base, &begin, self.radius, straight) {
                let [is_best, is_new] = [best, open].map(|than| is_shorter(&curve, than));
                let is_open = is_new && self.is_open(&zone, &curve, 0.0, trailer.theta);
                if (is_best || is_open) && self.fits(&curve, trailer.theta, &container) {
                    best = if is_best { Some(curve) } else { best };
                    open = if is_open { Some(curve) } else { open };
                }
            }
        }
        open.or(best).map(|curve| Plan { container, curve, driven: 0.0 })
    }

    /// Finds the hazards near the vehicle. Returns the zone that has to be free of them, `slack` m wider than that of
    /// the clearance.
    fn look(&mut self, ctx: &Ctx, axes: [&Pose2; 2], slack: f32) -> Zone {
        let (axes, vehicle, clearance) = (axes.map(|axis| *axis), self.vehicle, self.clearance.widened(slack));
        let zone = clearance.zone(vehicle, false);
        let ground = self.ground.young(ctx, self.max_age).into_iter();
        let hazards = ground.flat_map(|map| clearance.hazards(map, vehicle, &axes, false));
        self.near.find(&zone, &axes, f32::INFINITY, hazards);
        zone
    }

    /// Returns `true` if the vehicle meets no hazard on the rest of a curve.
    fn is_open(&self, zone: &Zone, curve: &Curve, driven: f32, mut heading: f32) -> bool {
        let (vehicle, rest) = (&self.vehicle, fmaxf(curve.length() - driven, 0.0));
        let steps = ceilf(rest / STEP);
        (1..=steps as u16).all(|i| {
            let way = rest * f32::from(i) / steps;
            let (pose, curvature) = curve.at(driven + way);
            let bend = normalize_angle(&(pose.theta - heading));
            heading += vehicle.trailer_rotation(1.0, curvature, bend) * rest / steps;
            !self.near.is_met(zone, &[pose, vehicle.trailer(&pose, heading)], way, GRAZE)
        })
    }

    /// Returns `true` if tractor and trailer touch nothing on the curve and are in line at its end.
    fn fits(&self, curve: &Curve, trailer: f32, container: &Pose2) -> bool {
        let vehicle = &self.vehicle;
        let (mut base, mut heading) = (curve.start.relative_to(container), trailer - container.theta);
        for (curvature, length) in curve.parts {
            let steps = libm::ceilf(length / STEP);
            let step = if steps > 0.0 { length / steps } else { 0.0 };
            for _ in 0..steps as u16 {
                let bend = normalize_angle(&(base.theta - heading));
                if bend.abs() > self.max_bend && !is_relaxing(bend, curvature, vehicle) {
                    return false;
                }
                let turn = vehicle.trailer_rotation(1.0, curvature, bend);
                heading += turn * step;
                base = advanced(&base, curvature, step);
                if self.touches(&base, heading) {
                    return false;
                }
            }
        }
        vehicle.rear_most(&vehicle.trailer(&base, heading)).y.abs() <= STRAIGHT
    }

    /// Returns `true` if the vehicle reaches into the container beside the free strip. Poses are in the frame of the
    /// container.
    fn touches(&self, base: &Pose2, heading: f32) -> bool {
        let (x, y) = (0.5 * self.container_length + self.margin, 0.5 * self.container_width + self.margin);
        if base.position().norm() > x + y + self.vehicle.length() {
            return false;
        }
        let blocked = |p: Point2| p.x.abs() <= x && p.y.abs() <= y && p.y.abs() > 0.5 * self.free_width;
        self.vehicle.outline(base, heading).into_iter().any(blocked)
    }

    /// Twist along the plan.
    fn follow(&self, base: &Pose2, plan: &Plan) -> Twist {
        let (pose, curvature) = plan.curve.at(plan.driven);
        let off = base.relative_to(&pose);
        let left = plan.curve.length() - plan.driven;
        let speed = approach_speed(left, self.deceleration, [self.min_speed, self.max_speed]);
        let bend = curvature - GAINS[0] * off.y - GAINS[1] * sinf(off.theta);
        let sharpest = 2.0 / self.radius;
        Twist::new(speed, 0.0, speed * bend.clamp(-sharpest, sharpest))
    }
}

/// Returns `true` if a bend becomes smaller on a curve.
fn is_relaxing(bend: f32, curvature: f32, vehicle: &Articulated) -> bool {
    let change = curvature - vehicle.trailer_rotation(1.0, curvature, bend);
    change * bend < 0.0
}

/// Distance along the curve of the point nearest to the vehicle, not before `driven`.
fn nearest(curve: &Curve, driven: f32, base: &Pose2) -> f32 {
    let off = |distance: f32| (curve.at(distance).0.position() - base.position()).norm_squared();
    let candidates = (0..=(AHEAD / FINE) as u8).map(|i| driven + FINE * f32::from(i));
    candidates.min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(driven)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        map::Raster,
        nav::{outline::Outline, payload::ReactiveApproach},
    };
    use apex_rt::{Construct, Time};
    use core::f32::consts::{FRAC_PI_2, PI};

    const CONTAINER: Pose2 = Pose2::new(4.0, 0.0, 0.0);

    fn planned() -> PlannedApproach {
        PlannedApproach::construct((
            0.8,
            1.0,
            0.5,
            0.03,
            0.2,
            Articulated::PATSY,
            1.2,
            0.76,
            0.43,
            0.05,
            0.05,
            0.05,
            0.05,
            Clearance::PATSY,
            0.5,
        ))
    }

    fn reactive() -> ReactiveApproach {
        ReactiveApproach::construct((0.7, 1.8, 0.6, 0.5, 0.05, 0.5, 0.5, 0.4, 1.0, Articulated::PATSY, 0.05, 0.5))
    }

    /// Drives until the end, or for 100 s. Returns the pose of the base and whether it was reached or missed.
    fn drive(
        mut process: impl FnMut(&Pose2, &Pose2, Event<()>, Event<()>) -> Option<Twist>,
        start: Pose2,
    ) -> (Pose2, bool, bool) {
        let (mut base, mut heading) = (start, start.theta);
        for _ in 0..2000 {
            let (mut reached, mut missed) = (None, None);
            let trailer = Articulated::PATSY.trailer(&base, heading);
            let twist = process(&base, &trailer, apex_rt::event(&mut reached), apex_rt::event(&mut missed));
            if reached.is_some() || missed.is_some() {
                return (base, reached.is_some(), missed.is_some());
            }
            let Twist { x, omega, .. } = twist.expect("a twist while it is active");
            heading += Articulated::PATSY.trailer_rotation(x, omega, base.theta - heading) * 0.05;
            base = advanced(&base, if x > 0.0 { omega / x } else { 0.0 }, 0.05 * x);
        }
        (base, false, false)
    }

    fn active() -> Ctx {
        Ctx::new(Time::ZERO).of_node(true)
    }

    #[test]
    fn both_drive_beneath_a_container_ahead() {
        let (mut a, mut b) = (planned(), reactive());
        let (ahead, to) = (Pose2::new(0.0, 0.0, 0.0), Some(&CONTAINER));
        for start in [ahead, Pose2::new(0.0, 0.2, 0.0), Pose2::new(-1.0, -0.5, 0.1)] {
            a.forget();
            let (end, reached, _) = drive(|p, t, r, m| a.step(&active(), [Some(p), Some(t)], to, None, [r, m]), start);
            assert!(reached && (end.x - 4.0 - Articulated::PATSY.axis()).abs() < 0.06, "{end:?}");
        }
        let (end, reached, _) =
            drive(|p, t, r, m| b.process(&active(), Some(p), Some(t), to, r, m).unwrap_or(None), ahead);
        assert!(reached && end.y.abs() < 0.06, "{end:?}");
    }

    #[test]
    fn the_plan_comes_from_the_side_and_from_behind() {
        let mut node = planned();
        for start in [Pose2::new(2.0, 4.0, 0.5), Pose2::new(2.5, -1.0, FRAC_PI_2), Pose2::new(6.0, 1.0, PI)] {
            node.forget();
            // The container is seen once.
            let mut container = Some(&CONTAINER);
            let (end, reached, _) =
                drive(|p, t, r, m| node.step(&active(), [Some(p), Some(t)], container.take(), None, [r, m]), start);
            assert!(reached && end.y.abs() < 0.03 && end.theta.abs() < 0.03, "{end:?} from {start:?}");
        }
    }

    #[test]
    fn a_container_that_turns_out_to_be_elsewhere_is_approached_there() {
        let (mut node, mut firing) = (planned(), 0);
        let moved = Pose2::new(4.1, 0.3, 0.1);
        let (end, reached, _) = drive(
            |p, t, r, m| {
                firing += 1;
                let container = if firing < 40 { CONTAINER } else { moved };
                node.step(&active(), [Some(p), Some(t)], Some(&container), None, [r, m])
            },
            Pose2::new(0.0, 0.0, 0.0),
        );
        assert!(reached && end.relative_to(&moved).y.abs() < 0.03, "{end:?}");
    }

    #[test]
    fn no_way_is_reported_and_bad_poses_stop() {
        let nothing = || Event::unconnected();
        let (mut node, at) = (planned(), Pose2::default());
        node.free_width = 0.3;
        let mut missed = None;
        let (to, here) = (Some(&CONTAINER), Some(&at));
        let twist = node.step(&active(), [here; 2], to, None, [nothing(), apex_rt::event(&mut missed)]);
        assert_eq!((twist, missed.is_some()), (Some(Twist::ZERO), true));
        let (mut a, mut b) = (planned(), reactive());
        for odd in [None, Some(&Pose2::new(f32::NAN, 0.0, 0.0))] {
            let stands = Some(Twist::ZERO);
            assert_eq!(a.step(&active(), [odd, here], to, None, [nothing(), nothing()]), stands);
            assert_eq!(a.step(&active(), [here, odd], to, None, [nothing(), nothing()]), stands);
            assert_eq!(b.process(&active(), here, here, odd, nothing(), nothing()), Ok(stands));
        }
        let inactive = Ctx::new(Time::ZERO);
        assert_eq!(planned().step(&inactive, [here; 2], to, None, [nothing(), nothing()]), None);
        assert_ne!(a.step(&active(), [here; 2], to, None, [nothing(), nothing()]), Some(Twist::ZERO));
        let halted = a.step(&inactive, [None; 2], None, None, [nothing(), nothing()]);
        assert_eq!(halted, Some(Twist::ZERO), "it stops when it is interrupted");
    }

    #[test]
    fn an_obstacle_before_the_container_is_driven_around() {
        let raster = Raster { corner: Point2::new(-2.0, -3.0), resolution: 0.05, width: 140, height: 120 };
        let mut map = Grid::new(raster, Occupancy::Free).expect("small");
        let thing = Point2::new(1.0, 0.02);
        *map.get_mut(raster.cell(thing).expect("inside")).expect("inside") = Occupancy::Occupied;
        let nearest = |ground: Option<&Grid<Occupancy>>| {
            let (mut node, mut firing, mut nearest) = (planned(), 0, f32::INFINITY);
            let (end, reached, _) = drive(
                |p, t, r, m| {
                    // A cloud with each third pose; the thing is seen when the vehicle has begun to drive.
                    firing += 1;
                    let ground = ground.filter(|_| firing % 3 == 2);
                    nearest = nearest.min(Outline::new(Articulated::PATSY, [0.0; 2]).distance(&[*p, *t], thing));
                    node.step(&active(), [Some(p), Some(t)], Some(&CONTAINER), ground, [r, m])
                },
                Pose2::new(-0.5, 0.0, 0.0),
            );
            assert!(reached && end.y.abs() < 0.05, "{end:?}");
            nearest
        };
        let [without, with] = [None, Some(&map)].map(nearest);
        assert!(without < 0.0 && with > 0.08, "{without} m, {with} m");
    }

    #[test]
    fn the_tolerance_along_the_container_is_kept() {
        let mut node = planned();
        node.tolerance = 0.02;
        let (end, reached, _) = drive(
            |p, t, r, m| node.step(&active(), [Some(p), Some(t)], Some(&CONTAINER), None, [r, m]),
            Pose2::new(0.0, 0.1, 0.0),
        );
        assert!(reached && (end.x - 4.0 - Articulated::PATSY.axis()).abs() <= 0.02, "{end:?}");
    }
}
