use super::vehicle::{Arrival, Articulated, arrival};
use crate::{
    nav::{
        Twist,
        latest::{any_far, both_fresh, fresh},
        twist::Halt,
    },
    scan::{FarFromOrigin, Point2, Pose2},
};
use apex_rt::{Ctx, Event, node};
use libm::{atan2f, fmaxf, fminf, sqrtf, tanf};

/// Steers a tractor with a passively steered trailer beneath a container, by the law of the thesis (6.7, eqs. 6.28 to
/// 6.30).
///
/// `base` is the pose of the tractor's axis, `trailer` that of the trailer's axis, and `container` that of the
/// container, all in one fixed frame such as that of odometry; the vehicle drives beneath the container along its
/// heading. `container` may be ⊥ between detections. Works while it is active: sends twists until the vehicle is
/// `reached` below the container, or until it has `missed` it. Without both poses, or with poses older than `max_age`,
/// the vehicle stands still.
///
/// Readings where the thesis is open: errors point from the vehicle to the desired pose and are in the frame of the
/// vehicle in eq. 6.28 (with b − b̃ as printed, the robot would turn away), in that of the container in eqs. 6.29 and
/// 6.30. The steering angle ψ turns the tractor like a vehicle with a steered wheel: ω = v·tan ψ / `wheel_base`.
#[node]
#[derive(Debug, Clone)]
pub struct ReactiveApproach {
    /// Gain of the angle to the desired pose of the tractor (k_a).
    #[param(default = 0.7, range = 0.0..=10.0)]
    base_gain: f32,
    /// Gain of the angle to the desired pose of the trailer (k_b).
    #[param(default = 1.8, range = 0.0..=10.0)]
    trailer_gain: f32,
    /// Gain of the offset of the tractor near the goal (k_c).
    #[param(unit = "rad/m", default = 0.6, range = 0.0..=100.0)]
    final_gain: f32,
    /// Speed per distance to the goal (k_v).
    #[param(unit = "1/s", default = 0.5, range = 0.0..=10.0)]
    speed_gain: f32,
    /// Minimum speed (v_min).
    #[param(unit = "m/s", default = 0.05, range = 0.001..=1.0)]
    min_speed: f32,
    /// Maximum speed (v_max).
    #[param(unit = "m/s", default = 0.5, range = 0.001..=10.0)]
    max_speed: f32,
    /// Minimum distance to the desired pose (δ_min).
    #[param(unit = "m", default = 0.5, range = 0.01..=10.0)]
    min_distance: f32,
    /// Distance of the steered wheel from the axis.
    #[param(unit = "m", default = 0.4, range = 0.01..=10.0)]
    wheel_base: f32,
    /// Maximum steering angle.
    #[param(unit = "rad", default = 1.0, range = 0.01..=1.5)]
    max_steering: f32,
    /// Shape of the vehicle.
    #[param(default = Articulated::PATSY)]
    vehicle: Articulated,
    /// Maximum offset of the vehicle from the middle of the container at the end, along and across.
    #[param(unit = "m", default = 0.05, range = 0.001..=1.0)]
    tolerance: f32,
    /// Maximum age of the poses.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    container: Option<Pose2>,
    halt: Halt,
}

#[node]
impl ReactiveApproach {
    fn process(
        &mut self,
        ctx: &Ctx,
        base: Option<&Pose2>,
        trailer: Option<&Pose2>,
        container: Option<&Pose2>,
        reached: Event<()>,
        #[failure] missed: Event<()>,
    ) -> Result<Option<Twist>, FarFromOrigin> {
        if ctx.active() && any_far([base, trailer, container]) {
            return self.halt.far();
        }
        Ok(self.step(ctx, [base, trailer], container, [reached, missed]))
    }

    fn step(
        &mut self,
        ctx: &Ctx,
        [base, trailer]: [Option<&Pose2>; 2],
        container: Option<&Pose2>,
        [reached, missed]: [Event<()>; 2],
    ) -> Option<Twist> {
        if !ctx.active() {
            return self.halt.rest();
        }
        self.container = fresh(ctx, container, self.max_age).copied().or(self.container);
        let axes = both_fresh(ctx, [base, trailer], self.max_age);
        let Some(((base, trailer), container)) = axes.zip(self.container) else {
            return self.halt.drive(Twist::ZERO);
        };
        let vehicle = &self.vehicle;
        let (base_in, rear) = (base.relative_to(&container), container.to_inner(vehicle.rear_most(trailer)));
        match arrival(&base_in, rear, vehicle.axis(), [self.tolerance; 2]) {
            Arrival::Ahead => self.halt.drive(self.twist(&base_in, &trailer.relative_to(&container), rear)),
            Arrival::Reached => {
                reached.emit(());
                self.halt.drive(Twist::ZERO)
            }
            Arrival::Missed => {
                missed.emit(());
                self.halt.drive(Twist::ZERO)
            }
        }
    }

    /// Forgets the container of the last approach.
    #[on_activate]
    fn forget(&mut self) {
        self.container = None;
    }

    /// Twist of the law. Poses are in the frame of the container.
    fn twist(&self, base: &Pose2, trailer: &Pose2, rear: Point2) -> Twist {
        let vehicle = &self.vehicle;
        let to_goal = Point2::new(vehicle.axis(), 0.0) - base.position();
        let steering = if to_goal.norm() >= vehicle.length() {
            let angle = |pose: &Pose2, from: Point2| {
                let towards = pose.to_inner(pose.position() + self.desired(from) - from);
                atan2f(towards.y, towards.x)
            };
            self.base_gain * angle(base, base.position()) + self.trailer_gain * angle(trailer, rear)
        } else {
            self.final_gain * to_goal.y
        };
        let speed = fmaxf(self.min_speed, fminf(self.max_speed, self.speed_gain * to_goal.x));
        let steering = steering.clamp(-self.max_steering, self.max_steering);
        Twist::new(speed, 0.0, speed * tanf(steering) / self.wheel_base)
    }

    /// Desired position on the centre line: the nearest one that is not nearer than δ_min, and ahead.
    fn desired(&self, from: Point2) -> Point2 {
        let ahead = sqrtf((self.min_distance * self.min_distance - from.y * from.y).max(0.0));
        Point2::new(from.x + ahead, 0.0)
    }
}
