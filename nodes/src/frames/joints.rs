use super::FrameName;
use apex_rt::Time;
use heapless::Vec;

/// Maximum number of joints in one token.
pub const MAX_JOINTS: usize = 64;

/// Position of a joint.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct JointPosition {
    /// Name of the joint.
    pub name: FrameName,
    /// Angle in rad, or for one that slides the distance in m.
    pub position: f64,
}

/// Positions of some joints of a robot, at one time.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct JointPositions {
    /// Time at which the joints have these positions.
    pub stamp: Time,
    /// Joints, in any order.
    pub joints: Vec<JointPosition, MAX_JOINTS>,
}

impl JointPositions {
    /// Position of a joint, if it is here.
    pub fn position(&self, name: &str) -> Option<f64> {
        self.joints.iter().find(|joint| joint.name.as_str() == name).map(|joint| joint.position)
    }
}
