use super::{FusionSettings, Inertial, PoseFilter, PositionFix};
use crate::{
    localize::MotionNoise,
    scan::{Point2, Pose2, PoseChange, UncertainPose},
};
use apex_rt::{Ctx, Event, Out, node};

/// Standard deviation of the heading of an initial pose, in rad.
const TURNED: f32 = 0.2;

/// Pose by wheels, a gyroscope and satellites outdoors: an extended Kalman filter (see [`PoseFilter`]).
///
/// `wheels` is the pose that the wheels sum up, in any frame. `inertial` and `fix` come at their own rates. Where the
/// inertial sensor measures at the same time as the wheels, it should stand before them in the source file; otherwise
/// its turn is one measurement late. A fix counts for its stamp, up to 2.5 s ago. `odometry` is the pose by wheels
/// and gyroscope: it begins at the origin, and fixes do not let it jump, so that maps and paths can be in its frame.
/// `pose` is the pose in the frame of the fixes, x to the east, which jumps with each of them. It is ⊥ until it is
/// known: satellites tell no heading, which follows from eleven fixes on a way of `align` that agree with odometry,
/// or from an `initial` pose. `estimate` has its covariance, which grows without fixes. Before the pose is known, it
/// is that of `odometry`. `bias` is that of the gyroscope, and `scale` the length of a metre by wheels.
///
/// `localized` comes with the pose as soon as it is known. A fix beyond the gate is not used; if none was used for
/// `patience`, while others came, `lost` comes, and the pose is found again as at the beginning. Without a gyroscope
/// the turn is that of the wheels; without wheels nothing is sent, and a gap counts as a straight way. Wheels that are
/// not a number, or far from the origin, give ⊥; other measurements that are not a number are ignored.
#[node]
#[derive(Debug)]
pub struct FusePose {
    /// Standard deviation of the position by wheels after 1 m.
    #[param(unit = "m", default = 0.05, range = 0.0..=1.0)]
    slip: f32,
    /// Standard deviation of the heading by wheels after 1 m. It counts only without a gyroscope, as `skid` does.
    #[param(unit = "rad", default = 0.08, range = 0.0..=1.0)]
    veer: f32,
    /// Standard deviation of the heading by wheels after a turn of 1 rad.
    #[param(unit = "rad", default = 0.1, range = 0.0..=1.0)]
    skid: f32,
    /// Standard deviation of the length of a metre by wheels at the beginning; 0 if it is exact.
    #[param(unit = "m", default = 0.05, range = 0.0..=0.5)]
    scale_spread: f32,
    /// Highest speed of the robot. Wheels that are faster are not believed.
    #[param(unit = "m/s", default = 5.0, range = 0.1..=100.0)]
    max_speed: f32,
    /// Standard deviation of a turn by the gyroscope after 1 s (angle random walk).
    #[param(unit = "rad", default = 0.001, range = 0.000_000_1..=1.0)]
    gyro_noise: f32,
    /// Standard deviation of the bias of the gyroscope at the beginning.
    #[param(unit = "rad/s", default = 0.002, range = 0.0..=1.0)]
    bias_spread: f32,
    /// Standard deviation of the change of the bias in 1 s.
    #[param(unit = "rad/s", default = 0.000_05, range = 0.0..=0.1)]
    bias_walk: f32,
    /// Forward position of the antenna in the frame of the robot.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    antenna_x: f32,
    /// Position of the antenna to the left.
    #[param(unit = "m", default = 0.0, range = -10.0..=10.0)]
    antenna_y: f32,
    /// Standard deviation of a fix along each axis from one fix to the next.
    #[param(unit = "m", default = 0.5, range = 0.001..=100.0)]
    fix_noise: f32,
    /// Standard deviation of the slow error that fixes have in common: 0 for a receiver without one (RTK).
    #[param(unit = "m", default = 1.6, range = 0.0..=100.0)]
    wander: f32,
    /// Time in which the slow error becomes another one.
    #[param(unit = "s", default = 200.0, range = 1.0..=100_000.0)]
    wander_time: f32,
    /// Largest squared and normalised error of a fix that is used. 99 % of the right ones are below 9.21.
    #[param(default = 9.21, range = 1.0..=1000.0)]
    gate: f32,
    /// Time of refused fixes after which the pose is lost.
    #[param(unit = "s", default = 15.0, range = 0.0..=3600.0)]
    patience: f32,
    /// Way on which fixes give the heading.
    #[param(unit = "m", default = 10.0, range = 0.1..=1000.0)]
    align: f32,
    /// Standard deviation of an initial position.
    #[param(unit = "m", default = 0.5, range = 0.0..=10.0)]
    initial_spread: f32,
    filter: Option<PoseFilter>,
    /// Change that has not been sent.
    change: Option<PoseChange>,
}

#[node]
impl FusePose {
    #[allow(clippy::too_many_arguments, reason = "they are the ports")]
    fn process(
        &mut self,
        ctx: &Ctx,
        wheels: &Pose2,
        odometry: &mut Out<Pose2>,
        pose: &mut Out<Pose2>,
        estimate: &mut Out<UncertainPose>,
        #[unit("rad/s")] bias: &mut Out<f32>,
        #[unit("m")] scale: &mut Out<f32>,
        localized: Event<Pose2>,
        lost: Event<()>,
    ) {
        let now = ctx.now();
        let change = self.change.take();
        let filter = self.filter();
        let is_used = filter.drive(now, wheels);
        let known = filter.estimate();
        if let Some(change) = change {
            change.emit(known.pose, localized, lost);
        }
        if !is_used || !known.pose.is_usable() {
            return;
        }
        odometry.set(filter.odometry());
        estimate.set(known);
        bias.set(filter.bias());
        scale.set(filter.scale());
        if filter.is_localized() {
            pose.set(known.pose);
        }
    }

    /// Measurement of the inertial sensor.
    #[slot]
    fn inertial(&mut self, ctx: &Ctx, inertial: &Inertial) {
        self.filter().turn(ctx.now(), inertial);
    }

    /// Position by satellites.
    #[slot]
    fn fix(&mut self, fix: &PositionFix) {
        let (_, change) = self.filter().fix(fix);
        self.change = change.or(self.change);
    }

    /// Begins at a pose in the frame of the fixes. One that is not a number is ignored.
    #[slot]
    fn initial(&mut self, pose: &Pose2) {
        let spread = (self.initial_spread, TURNED);
        let change = self.filter().begin(pose, spread);
        self.change = change.or(self.change);
    }

    /// Forgets everything: `odometry` begins at the origin again.
    #[slot]
    fn reset(&mut self) {
        (self.filter, self.change) = (None, None);
    }

    fn filter(&mut self) -> &mut PoseFilter {
        let settings = self.settings();
        self.filter.get_or_insert_with(|| PoseFilter::new(settings))
    }

    const fn settings(&self) -> FusionSettings {
        FusionSettings {
            motion: MotionNoise { slip: self.slip, veer: self.veer, skid: self.skid },
            scale_spread: self.scale_spread,
            max_speed: self.max_speed,
            gyro_noise: self.gyro_noise,
            bias_spread: self.bias_spread,
            bias_walk: self.bias_walk,
            antenna: Point2::new(self.antenna_x, self.antenna_y),
            fix_noise: self.fix_noise,
            wander: self.wander,
            wander_time: self.wander_time,
            gate: self.gate,
            patience: self.patience,
            align: self.align,
        }
    }
}
