use apex_nodes::scan::Pose2;

/// Order to bring a container from one place to another, on the plan of the building.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Order {
    /// Place where the container was last seen, with the direction in which the vehicle is to drive beneath it. It may
    /// be some decimetres off.
    pub container: Pose2,
    /// Place of the container at the end.
    pub destination: Pose2,
}
