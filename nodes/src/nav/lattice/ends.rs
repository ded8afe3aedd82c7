use crate::scan::Pose2;

/// Start of a way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// Pose of the vehicle.
    pub pose: Pose2,
    /// Heading of the trailer, in rad.
    pub trailer: f32,
    /// `true` if the way has to begin backward.
    pub is_back: bool,
}

/// Goal of a way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Pose at the end.
    pub pose: Pose2,
    /// Cost of this goal in addition to that of the way, in m.
    pub cost: f32,
}

/// Place where a way may end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub pose: Pose2,
    pub cost: f32,
    /// `true` if it is a goal, `false` if it is before one.
    pub is_goal: bool,
}
