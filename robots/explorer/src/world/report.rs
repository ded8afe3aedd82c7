use apex_nodes::scan::{Point2, Pose2};
use apex_rt::Time;

/// Events of a run, by the true state.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Contacts of the robot with something, while it drove.
    pub contacts: Vec<Contact>,
    /// Distance that the robot drove, in m.
    pub driven: f32,
    /// Times at which a battery that was low was full again.
    pub charges: Vec<Time>,
    /// Least charge of the battery.
    pub least_charge: f32,
    /// Time at which the robot said that nothing is left to explore and that it is at home, and its distance from the
    /// station then, in m.
    pub finished: Option<(Time, f32)>,
    /// Poses of the robot, two in a second.
    pub trajectory: Vec<Pose2>,
}

/// Contact of the robot with something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Time.
    pub at: Time,
    /// Place of the robot.
    pub place: Point2,
}
