//! Navigation of omnidirectional robots: planning on grid maps, following of paths, and movements on sight (thesis
//! 4.3.6 and 8.1.1).
//!
//! Planning and following keep paths of any length, so they need the feature `std`; movements on sight do not.
//!
//! A node that drives sends a [`Twist`] while it drives, the last of which is zero, and ⊥ else.

#[cfg(feature = "std")]
mod costs;
#[cfg(feature = "std")]
mod follow;
mod guard;
#[cfg(feature = "std")]
mod law;
#[cfg(feature = "record")]
mod message;
mod motion;
#[cfg(feature = "std")]
mod path;
mod pid;
#[cfg(feature = "std")]
mod plan;
mod safety;
#[cfg(feature = "std")]
mod search;
#[cfg(feature = "std")]
mod smooth;
mod track;
mod twist;

#[cfg(feature = "std")]
pub use costs::{CostMap, write_costs};
#[cfg(feature = "std")]
pub use follow::PathFollower;
pub use guard::OdometryGuard;
#[cfg(feature = "std")]
pub use law::FollowingLaw;
pub use motion::{MoveRobot, MoveToObstacle, PositionToTarget};
#[cfg(feature = "std")]
pub use path::{Path, Projection};
pub use pid::Pid;
#[cfg(feature = "std")]
pub use plan::{PathPlanner, Planner, Smoothing};
pub use safety::{ProtectiveField, SafetyField};
#[cfg(feature = "std")]
pub use search::{NoPath, Search, Terrain};
#[cfg(feature = "std")]
pub use smooth::{is_clear, simplify, smooth, subdivide};
pub use track::{TrackPose, stand_before};
pub use twist::Twist;
