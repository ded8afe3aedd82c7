//! Simultaneous localization and mapping with a pose graph (feature `slam`; thesis 4.3.5).
//!
//! Poses have double precision: after an hour of operation, the errors of single precision would affect scan matches.

mod drawer;
mod edge;
mod graph;
mod kernel;
mod loops;
mod lost;
mod mapper;
mod matcher;
mod node;
mod posed;
mod read;
mod saved;
mod scan_graph;
mod settings;
mod sparse;
mod spread;
mod start;
mod table;

pub use drawer::{DrawScans, ScanDrawer};
pub use edge::Edge;
pub use graph::{NoSuchPose, Optimized, PoseGraph};
pub use kernel::RobustKernel;
pub use mapper::Mapper;
pub use matcher::Window;
pub use node::{GraphSlam, SlamError};
pub use posed::{PosedScans, selected_scans};
pub use settings::Settings;

/// Pose in the plane, in m and rad.
pub type Pose = nalgebra::Isometry2<f64>;

/// Creates the pose (`x`, `y`) in m with a heading in rad.
pub fn pose(x: f64, y: f64, theta: f64) -> Pose {
    Pose::new(nalgebra::Vector2::new(x, y), theta)
}

/// Heading of a pose, counter-clockwise from the x axis, in (−π, π] rad.
pub fn heading(pose: &Pose) -> f64 {
    pose.rotation.angle()
}
