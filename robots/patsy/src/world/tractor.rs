use apex_nodes::{nav::Articulated, scan::Pose2};
use apex_sim::{Limits, Tractor};

/// Limits of the motors.
const LIMITS: Limits = Limits { speed: 1.0, acceleration: 1.0, turn: 2.0, turn_acceleration: 6.0 };

/// The simulated vehicle, which stands straight at a pose.
pub(crate) fn tractor(pose: Pose2) -> Tractor {
    Tractor::straight(pose, Articulated::PATSY, LIMITS)
}
