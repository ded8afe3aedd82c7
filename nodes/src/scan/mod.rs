//! Plane laser scans: cleaning, segmentation, and the detection of containers by their wheels (thesis 6.6.1).
//!
//! The types have fixed capacities and need no heap, except that with the feature `std` scans grow on it
//! ([`Ranges`]).

mod carried;
mod catch_up;
mod confirm;
mod consensus;
mod container;
mod directions;
mod filter;
#[cfg(feature = "record")]
mod foreign;
mod geometry;
mod history;
mod laser;
#[cfg(feature = "record")]
pub(crate) mod message;
mod mount;
mod ranges;
mod remember;
mod segment;
mod uncertain;
mod wheel;

pub use carried::HideCarried;
pub use catch_up::CatchUp;
pub use confirm::ConfirmContainer;
pub use container::{Container, ContainerSearch, best_container};
pub use directions::BeamDirections;
pub use filter::{EnoughBeams, MedianFilter, RangeFilter, ShortSegmentFilter};
pub use geometry::{FarFromOrigin, Point2, Pose2, Transform2, wrap_angle};
pub(crate) use history::PoseHistory;
pub use laser::Scan;
pub(crate) use mount::around;
pub use mount::{MergeScans, MountScan, OtherBeams};
pub use ranges::{MAX_BEAMS, Ranges, TooManyBeams};
pub use remember::{Containers, RememberContainers};
pub use segment::{JumpDistance, MAX_SEGMENTS, Segment, SegmentFilter, Segments, TooManySegments};
pub use uncertain::{PoseChange, UncertainPose, position_deviation};
