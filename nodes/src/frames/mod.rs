//! Frames: transforms between the coordinate systems of a robot, by their names and in time, as `tf2` of ROS has them.
//!
//! A [`Transform`] is the pose of one frame, the child, in another one, its parent. Together they form a tree, which a
//! [`TransformBuffer`] keeps for a while: it gives the pose of any frame in any other one at a time. The nodes have
//! such a buffer of [`MAX_FRAMES`] frames. They need neither the standard library nor a heap.
//!
//! Poses have three dimensions here, because those of messages do, and are `f64`. [`seen_from_above`] leaves height and
//! tilt out.

mod at;
mod buffer;
mod joints;
#[cfg(feature = "record")]
mod message;
#[cfg(feature = "urdf")]
mod model;
mod place;
mod pose;
mod queue;
mod rotation;
mod transform;
#[cfg(feature = "urdf")]
mod urdf;

pub use at::{LatestTransform, Stamped, TransformAt};
pub use buffer::{Gap, Kind, TransformBuffer, TransformError};
pub use joints::{JointPosition, JointPositions, MAX_JOINTS};
#[cfg(feature = "urdf")]
pub use model::RobotModel;
#[cfg(feature = "std")]
pub use place::place_cloud;
pub use place::{PlaceScan, seen_from_above};
pub use pose::Pose3;
pub use queue::{MAX_WAITING, TransformQueue};
pub use rotation::{NotARotation, Rotation};
pub use transform::{
    FrameName, MAX_NAME, MAX_TRANSFORMS, NameTooLong, Transform, Transforms, frame_name, transform_of,
};
#[cfg(feature = "urdf")]
pub use urdf::{Joint, JointKind, Urdf, UrdfError};

/// Maximum number of frames of a node's buffer.
pub const MAX_FRAMES: usize = 64;
/// Maximum number of frames of a node's buffer that move in their parent.
pub const MAX_MOVING: usize = 12;
/// Number of transforms that a node's buffer keeps of each frame that moves: 2 s of 50 in a second.
pub const MAX_SAMPLES: usize = 100;

/// Buffer of the nodes.
type Buffer = TransformBuffer<MAX_FRAMES, MAX_MOVING, MAX_SAMPLES>;
