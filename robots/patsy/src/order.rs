use apex_nodes::{nav::turned, scan::Pose2};
use core::f32::consts::PI;

/// Order to bring a container from one place to another, on the plan of the building.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Order {
    /// Place where the container was last seen, with one of the directions in which the vehicle can drive beneath it.
    /// It may be some decimetres off.
    pub container: Pose2,
    /// Place of the container at the end.
    pub destination: Pose2,
}

impl Order {
    /// Pose of the container with the heading, of its two, that is nearer to the direction of the destination.
    pub fn towards_destination(&self) -> Pose2 {
        let is_behind = self.container.to_inner(self.destination.position()).x < 0.0;
        turned(&self.container, if is_behind { PI } else { 0.0 })
    }
}
