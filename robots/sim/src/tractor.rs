use crate::{FloorPlan, Footprint, Lift, Limits, Odometry, OdometryNoise, PlanError, Tractor};
use apex_nodes::{
    nav::{Articulated, Twist},
    scan::Pose2,
};
use apex_rt::{Ctx, Event, Out, Time, node};

/// Maximum step of the simulation, in s.
const STEP: f32 = 0.01;

/// Simulated tractor with a passively steered trailer and a lift in a drawn world (thesis 6.7). It is a source with
/// slots for twists and for the lift.
///
/// Stands at the start of the [`FloorPlan`] with its trailer in line. Stops at obstacles, and when twists no longer
/// come for `command_timeout`. `raise` lifts a container that stands above it: from then on, until it is down again,
/// the vehicle has the footprint of the container, too, which turns with the trailer. It needs a period, for example
/// `every 50ms`.
#[node]
#[derive(Debug, Clone)]
pub struct TractorBase {
    /// Drawing of the world.
    #[param]
    world: &'static str,
    /// Shape of the vehicle.
    #[param(default = Articulated::PATSY)]
    vehicle: Articulated,
    /// Length of a container.
    #[param(unit = "m", default = 1.2, range = 0.01..=10.0)]
    load_length: f32,
    /// Width of a container.
    #[param(unit = "m", default = 0.7, range = 0.01..=10.0)]
    load_width: f32,
    /// Maximum speed.
    #[param(unit = "m/s", default = 1.0, range = 0.0..=10.0)]
    speed: f32,
    /// Maximum acceleration.
    #[param(unit = "m/s^2", default = 1.0, range = 0.01..=100.0)]
    acceleration: f32,
    /// Maximum angular velocity.
    #[param(unit = "rad/s", default = 2.0, range = 0.0..=20.0)]
    turn: f32,
    /// Time that the lift takes.
    #[param(unit = "s", default = 3.0, range = 0.0..=600.0)]
    lift_duration: f32,
    /// Error of the wheel odometry, as a multiple of that of a Pioneer 2; 0 is exact.
    #[param(default = 0.0, range = 0.0..=10.0)]
    drift: f32,
    /// Time that the vehicle goes on without a new twist; 0 for a vehicle that keeps the last one, as many do.
    #[param(unit = "s", default = 0.5, range = 0.0..=60.0)]
    command_timeout: f32,
    /// Seed of the odometry errors.
    #[param(default = 1)]
    seed: u64,
    moving: Option<Moving>,
    failed: bool,
    is_raised: bool,
    command: Twist,
    commanded: Option<Time>,
}

#[derive(Debug, Clone)]
struct Moving {
    plan: FloorPlan,
    vehicle: Tractor,
    lift: Lift,
    odometry: Odometry,
    last: Time,
}

#[node]
impl TractorBase {
    /// Sends the pose of the tractor's axis in the world (`pose`), that of the trailer's axis (`trailer`), and the pose
    /// by wheel odometry relative to the start (`odometry`). `lift_done` comes when the lift arrives, with `true` if it
    /// is up.
    fn process(
        &mut self,
        ctx: &Ctx,
        pose: &mut Out<Pose2>,
        trailer: &mut Out<Pose2>,
        odometry: &mut Out<Pose2>,
        lift_done: Event<bool>,
    ) -> Result<(), PlanError> {
        if self.failed {
            return Ok(());
        }
        let now = ctx.now();
        let mut moving = match self.moving.take() {
            Some(moving) => moving,
            None => self.begin(now).inspect_err(|_| self.failed = true)?,
        };
        let elapsed = now.since(moving.last).as_secs_f32();
        moving.last = now;
        moving.lift.is_raised = self.is_raised;
        if moving.lift.step(elapsed) {
            lift_done.emit(self.is_raised);
        }
        let is_young = |then| now.since(then).as_secs_f32() <= self.command_timeout;
        let fresh = self.commanded.is_some_and(|then| self.command_timeout == 0.0 || is_young(then));
        let command = if fresh { self.command } else { Twist::ZERO };
        let before = moving.vehicle.base.pose;
        self.drive_for(&mut moving, &command, elapsed);
        odometry.set(moving.odometry.measure(&before, &moving.vehicle.base.pose));
        pose.set(moving.vehicle.base.pose);
        trailer.set(moving.vehicle.trailer_pose());
        self.moving = Some(moving);
        Ok(())
    }

    /// Sets the twist until the next one.
    #[slot]
    fn drive(&mut self, twist: &Twist, ctx: &Ctx) {
        self.command = *twist;
        self.commanded = Some(ctx.now());
    }

    /// Raises the lift, with the container above it.
    #[slot]
    fn raise(&mut self) {
        self.is_raised = true;
    }

    /// Lowers the lift.
    #[slot]
    fn lower(&mut self) {
        self.is_raised = false;
    }

    fn begin(&self, now: Time) -> Result<Moving, PlanError> {
        let plan = FloorPlan::parse(self.world)?;
        let limits = Limits {
            speed: self.speed,
            acceleration: self.acceleration,
            turn: self.turn,
            turn_acceleration: 3.0 * self.turn,
        };
        let vehicle = Tractor::straight(plan.start, self.vehicle, limits);
        let odometry = Odometry::new(OdometryNoise::PIONEER.times(self.drift), self.seed);
        Ok(Moving { plan, vehicle, lift: Lift::lowered(self.lift_duration), odometry, last: now })
    }

    /// Drives for `elapsed` s, as far as nothing is in the way.
    fn drive_for(&self, moving: &mut Moving, command: &Twist, elapsed: f32) {
        let steps = libm::ceilf(elapsed / STEP).clamp(0.0, 1000.0);
        let mut clearance = self.clearance(moving);
        for _ in 0..steps as u16 {
            let before = moving.vehicle.clone();
            moving.vehicle.step(command, elapsed / steps);
            let after = self.clearance(moving);
            // Away from an obstacle is always possible.
            if after <= 0.0 && after < clearance {
                moving.vehicle = before;
                moving.vehicle.base.twist = Twist::ZERO;
            } else {
                clearance = after;
            }
        }
    }

    /// Distance of the vehicle with its load to the nearest object, in m.
    fn clearance(&self, moving: &Moving) -> f32 {
        let parts = moving.vehicle.footprints();
        let load = moving.lift.carries().then(|| {
            let rear = moving.vehicle.trailer_pose();
            let middle = rear.compose(&Pose2::new(self.vehicle.lift(), 0.0, 0.0));
            Footprint { pose: middle, length: self.load_length, width: self.load_width }
        });
        parts.iter().chain(&load).map(|part| part.clearance(&moving.plan.world)).fold(f32::INFINITY, f32::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    /// Corridor of 1 m, and a wall at its end.
    const CORRIDOR: &str = "\
########################
#                      #
#    >                 #
#                      #
########################";

    fn node(world: &'static str) -> TractorBase {
        TractorBase::construct((world, Articulated::PATSY, 1.2, 0.7, 1.0, 1.0, 2.0, 1.0, 0.0, 0.5, 1))
    }

    fn fire(node: &mut TractorBase, ms: i64, twist: Twist) -> (Pose2, Pose2, Option<bool>) {
        let ctx = Ctx::new(Time::from_millis(ms));
        let (mut pose, mut trailer, mut odometry, mut done) = (Out::new(), Out::new(), Out::new(), None);
        node.process(&ctx, &mut pose, &mut trailer, &mut odometry, apex_rt::event(&mut done)).expect("a corridor");
        node.drive(&twist, &ctx);
        (*pose.get().expect("a pose"), *trailer.get().expect("a pose"), done)
    }

    #[test]
    fn it_stops_at_the_wall_and_earlier_with_a_load() {
        let forward = Twist::new(0.5, 0.0, 0.0);
        let end = |is_loaded: bool| {
            let mut node = node(CORRIDOR);
            if is_loaded {
                node.raise();
            }
            (0..200).map(|i| fire(&mut node, 50 * i, forward).0).last().expect("a drive")
        };
        let (empty, loaded) = (end(false), end(true));
        // Half of the container, less half of the vehicle, stands out at the front.
        assert!(empty.x - loaded.x > 0.05 && empty.x - loaded.x < 0.15, "{empty:?} {loaded:?}");
    }

    #[test]
    fn the_lift_arrives_and_the_trailer_follows() {
        let mut node = node(CORRIDOR);
        node.raise();
        let done: Vec<(i64, bool)> =
            (0..40).filter_map(|i| fire(&mut node, 50 * i, Twist::ZERO).2.map(|up| (i, up))).collect();
        assert!(matches!(done[..], [(20..=21, true)]), "{done:?}");
        node.lower();
        let done: Vec<bool> = (40..80).filter_map(|i| fire(&mut node, 50 * i, Twist::ZERO).2).collect();
        assert_eq!(done, [false]);
        let (pose, trailer, _) = fire(&mut node, 4050, Twist::ZERO);
        assert!((pose.x - trailer.x - 0.65).abs() < 1e-4 && (trailer.y - pose.y).abs() < 1e-4, "{pose:?} {trailer:?}");
    }

    #[test]
    fn a_wrong_world_is_reported_once() {
        let mut node = node("###");
        let mut fire = || {
            let (mut pose, mut trailer, mut odometry) = (Out::new(), Out::new(), Out::new());
            let ctx = Ctx::new(Time::ZERO);
            node.process(&ctx, &mut pose, &mut trailer, &mut odometry, Event::unconnected())
        };
        assert_eq!((fire(), fire()), (Err(PlanError::NoStart), Ok(())));
    }
}
