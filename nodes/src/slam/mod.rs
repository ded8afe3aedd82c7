//! Localization and mapping at once, with a graph of poses (feature `slam`; thesis 4.3.5).
//!
//! Poses are held in double precision: after an hour of robot, single precision would show in a scan match.

mod g2o;
mod graph;
mod map;
mod mapper;
mod matcher;
mod node;
mod sparse;
mod table;

pub use graph::{Edge, NoSuchPose, Optimized, PoseGraph};
pub use map::selected_scans;
pub use mapper::{Mapper, Settings};
pub use matcher::Window;
pub use node::GraphSlam;

/// Where a frame lies in another one, in m.
pub type Pose = nalgebra::Isometry2<f64>;

/// The pose (`x`, `y`) in m with a heading in rad.
pub fn pose(x: f64, y: f64, theta: f64) -> Pose {
    Pose::new(nalgebra::Vector2::new(x, y), theta)
}

/// The heading of a pose, counter-clockwise from the x axis, in (−π, π] rad.
pub fn heading(pose: &Pose) -> f64 {
    pose.rotation.angle()
}
