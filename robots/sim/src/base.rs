use crate::{Differential, FloorPlan, Limits, Odometry, OdometryNoise, PlanError};
use apex_nodes::{nav::Twist, scan::Pose2};
use apex_rt::{Ctx, Event, Out, Time, node};

/// Maximum step of the simulation, in s.
const STEP: f32 = 0.01;
/// Maximum distance from an obstacle at which a base still touches it, in m.
const SLACK: f32 = 0.02;

/// Simulated base with two driven wheels in a drawn world. It is a source with a slot for twists.
///
/// The base starts at the start of the [`FloorPlan`], keeps its distance from walls like a bumper, and stops when
/// twists no longer come for `command_timeout` or its battery is empty. It needs a period, for example `every 50ms`.
#[node]
#[derive(Debug, Clone)]
pub struct DifferentialBase {
    /// Drawing of the world.
    #[param]
    world: &'static str,
    /// Radius of the base.
    #[param(unit = "m", default = 0.2, range = 0.01..=2.0)]
    radius: f32,
    /// Distance between the wheels.
    #[param(unit = "m", default = 0.3, range = 0.01..=2.0)]
    track: f32,
    /// Maximum speed.
    #[param(unit = "m/s", default = 1.0, range = 0.0..=10.0)]
    speed: f32,
    /// Maximum acceleration.
    #[param(unit = "m/s^2", default = 1.0, range = 0.01..=100.0)]
    acceleration: f32,
    /// Maximum angular velocity.
    #[param(unit = "rad/s", default = 2.0, range = 0.0..=20.0)]
    turn: f32,
    /// Maximum angular acceleration.
    #[param(unit = "rad/s^2", default = 6.0, range = 0.01..=200.0)]
    turn_acceleration: f32,
    /// Error of the wheel odometry, as a multiple of that of a Pioneer 2; 0 is exact.
    #[param(default = 0.0, range = 0.0..=10.0)]
    drift: f32,
    /// Time until the battery is empty.
    #[param(unit = "s", default = 3600.0, range = 1.0..=1e9)]
    battery_life: f32,
    /// Time that the base goes on without a new twist; 0 for a base that keeps the last one, as many do.
    #[param(unit = "s", default = 0.5, range = 0.0..=60.0)]
    command_timeout: f32,
    /// Seed of the odometry errors.
    #[param(default = 1)]
    seed: u64,
    moving: Option<Moving>,
    failed: bool,
    command: Twist,
    commanded: Option<Time>,
}

#[derive(Debug, Clone)]
struct Moving {
    plan: FloorPlan,
    base: Differential,
    odometry: Odometry,
    began: Time,
    last: Time,
    touches: bool,
}

#[node]
impl DifferentialBase {
    /// Sends the pose in the world (`pose`), the pose by wheel odometry relative to the start (`odometry`), and the
    /// charge of the battery from 1 to 0. `bumped` comes when the base touches an obstacle.
    fn process(
        &mut self,
        ctx: &Ctx,
        pose: &mut Out<Pose2>,
        odometry: &mut Out<Pose2>,
        battery: &mut Out<f32>,
        bumped: Event<()>,
    ) -> Result<(), PlanError> {
        if self.failed {
            return Ok(());
        }
        let now = ctx.now();
        let mut moving = match self.moving.take() {
            Some(moving) => moving,
            None => self.begin(now).inspect_err(|_| self.failed = true)?,
        };
        let charge = (1.0 - now.since(moving.began).as_secs_f32() / self.battery_life).max(0.0);
        let is_young = |then| now.since(then).as_secs_f32() <= self.command_timeout;
        let fresh = self.commanded.is_some_and(|then| self.command_timeout == 0.0 || is_young(then));
        let command = if fresh && charge > 0.0 { self.command } else { Twist::ZERO };
        let touched = moving.touches;
        odometry.set(moving.step(now, &command, self.radius));
        pose.set(moving.base.pose);
        battery.set(charge);
        if moving.touches && !touched {
            bumped.emit(());
        }
        self.moving = Some(moving);
        Ok(())
    }

    /// Sets the twist until the next one.
    #[slot]
    fn drive(&mut self, twist: &Twist, ctx: &Ctx) {
        self.command = *twist;
        self.commanded = Some(ctx.now());
    }

    fn begin(&self, now: Time) -> Result<Moving, PlanError> {
        let plan = FloorPlan::parse(self.world)?;
        let limits = Limits {
            speed: self.speed,
            acceleration: self.acceleration,
            turn: self.turn,
            turn_acceleration: self.turn_acceleration,
        };
        let base = Differential { pose: plan.start, twist: Twist::ZERO, limits, track: self.track };
        let odometry = Odometry::new(OdometryNoise::PIONEER.times(self.drift), self.seed);
        Ok(Moving { plan, base, odometry, began: now, last: now, touches: false })
    }
}

impl Moving {
    /// Moves until `now` and returns the odometry.
    fn step(&mut self, now: Time, command: &Twist, radius: f32) -> Pose2 {
        let elapsed = now.since(self.last).as_secs_f32();
        self.last = now;
        let before = self.base.pose;
        let steps = libm::ceilf(elapsed / STEP).clamp(0.0, 1000.0);
        let mut touches = false;
        for _ in 0..steps as u16 {
            let pose = self.base.pose;
            self.base.step(command, elapsed / steps);
            let clearance = self.plan.world.clearance(self.base.pose.position());
            if clearance < radius && clearance < self.plan.world.clearance(pose.position()) {
                // The base may turn on the spot and drive away.
                self.base.pose = Pose2 { theta: self.base.pose.theta, ..pose };
                self.base.twist.x = 0.0;
                touches = true;
            }
        }
        // The base has to move away before it can bump again.
        let near = || self.plan.world.clearance(self.base.pose.position()) < radius + SLACK;
        self.touches = touches || (self.touches && near());
        self.odometry.measure(&before, &self.base.pose)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    const ROOM: &str = "\
################
#              #
#  >           #
#              #
################";

    fn node(world: &'static str, battery_life: f32, drift: f32) -> DifferentialBase {
        DifferentialBase::construct((world, 0.2, 0.3, 1.0, 1.0, 2.0, 6.0, drift, battery_life, 0.5, 1))
    }

    struct Sent {
        pose: Pose2,
        odometry: Pose2,
        battery: f32,
        bumped: bool,
    }

    fn fire(node: &mut DifferentialBase, ms: i64, command: Option<Twist>) -> Sent {
        let ctx = Ctx::new(Time::from_millis(ms));
        let (mut pose, mut odometry, mut battery, mut bumped) = (Out::new(), Out::new(), Out::new(), None);
        node.process(&ctx, &mut pose, &mut odometry, &mut battery, apex_rt::event(&mut bumped)).expect("a room");
        if let Some(twist) = command {
            node.drive(&twist, &ctx);
        }
        let [pose, odometry] = [pose, odometry].map(|out| *out.get().expect("it was sent"));
        Sent { pose, odometry, battery: *battery.get().expect("it was sent"), bumped: bumped.is_some() }
    }

    #[test]
    fn it_drives_until_it_bumps_and_can_back_away() {
        let mut node = node(ROOM, 1e9, 0.0);
        let forward = Twist::new(0.5, 0.0, 0.0);
        let drive: Vec<Sent> = (0..160).map(|i| fire(&mut node, 50 * i, Some(forward))).collect();
        assert_eq!(drive[0].pose, Pose2::new(0.875, 1.25, 0.0));
        assert_eq!(drive[0].odometry, Pose2::default());
        assert_eq!(drive.iter().filter(|sent| sent.bumped).count(), 1, "it keeps in touch");
        let end = &drive[159];
        assert!(
            (end.pose.x - 3.55).abs() < 0.01 && (end.odometry.x - end.pose.x + 0.875).abs() < 1e-4,
            "{}",
            end.pose.x
        );
        let back = (160..180).map(|i| fire(&mut node, 50 * i, Some(Twist::new(-0.5, 0.0, 0.0)))).last();
        assert!(back.expect("it drives").pose.x < 3.3);
    }

    #[test]
    fn it_stops_without_twists_and_without_a_battery() {
        let mut node = node(ROOM, 4.0, 0.0);
        let twist = Twist::new(0.2, 0.0, 0.0);
        let at: Vec<Sent> = (0..40).map(|i| fire(&mut node, 50 * i, (i == 0).then_some(twist))).collect();
        assert!(at[39].pose.x > at[0].pose.x + 0.05 && at[39].pose == at[20].pose, "it waits for half a second");
        let late: Vec<Sent> = (40..120).map(|i| fire(&mut node, 50 * i, Some(twist))).collect();
        assert_eq!((at[0].battery, at[20].battery, late[79].battery), (1.0, 0.75, 0.0));
        assert_eq!(late[79].pose, late[50].pose, "the battery is empty");
        assert!(late[79].pose.x > at[39].pose.x + 0.2);
    }

    #[test]
    fn without_a_time_out_it_keeps_the_last_twist() {
        let mut node = DifferentialBase { command_timeout: 0.0, ..node(ROOM, 1e9, 0.0) };
        let twist = Twist::new(0.1, 0.0, 0.0);
        let at: Vec<Sent> = (0..200).map(|i| fire(&mut node, 50 * i, (i == 0).then_some(twist))).collect();
        assert!((at[199].pose.x - at[99].pose.x - 0.5).abs() < 1e-3, "it drives on for 10 s");
        let end = (200..300).map(|i| fire(&mut node, 50 * i, (i == 200).then_some(Twist::ZERO))).last();
        assert!(end.expect("it stands").pose.x < at[199].pose.x + 0.02);
    }

    #[test]
    fn the_same_seed_and_times_give_the_same_run() {
        let run = || {
            let mut node = node(ROOM, 1e9, 1.0);
            (0..100).map(|i| fire(&mut node, 50 * i, Some(Twist::new(0.3, 0.0, 0.3)))).last().expect("a run")
        };
        let (a, b) = (run(), run());
        assert_eq!((a.pose, a.odometry), (b.pose, b.odometry));
        assert!((a.odometry.x - (a.pose.x - 0.875)).abs() > 1e-3, "its wheels are wrong");
    }

    #[test]
    fn a_wrong_world_is_reported_once() {
        let mut node = node("###", 1e9, 0.0);
        let mut fire = || {
            let (mut pose, mut odometry, mut battery) = (Out::new(), Out::new(), Out::new());
            node.process(&Ctx::new(Time::ZERO), &mut pose, &mut odometry, &mut battery, Event::unconnected())
        };
        assert_eq!((fire(), fire()), (Err(PlanError::NoStart), Ok(())));
    }
}
