//! Navigation of omnidirectional robots: path planning on grid maps, path following, and motion relative to sensor data
//! without a map (thesis 4.3.6 and 8.1.1). Planning for vehicles that drive in curves. Steering a tractor with a
//! trailer beneath a container (thesis 6.7). Following of a person at the speed of a runner with a skid-steered robot
//! (thesis 8.4).
//!
//! Planning and following keep paths of any length and need the feature `std`. Motion without a map does not.
//!
//! A node that moves the robot sends a [`Twist`] in each firing while it moves, a twist of zero at the end, and ⊥
//! otherwise. The page docs/safety.md says what movements and guards do when an input fails.

#[cfg(feature = "std")]
mod arcs;
#[cfg(feature = "std")]
mod careful;
#[cfg(feature = "std")]
mod clearance;
#[cfg(feature = "std")]
mod costs;
#[cfg(feature = "std")]
mod curve_follow;
#[cfg(feature = "std")]
mod follow;
#[cfg(feature = "std")]
mod frontiers;
mod guard;
#[cfg(feature = "std")]
mod hazard;
mod latest;
#[cfg(feature = "std")]
mod lattice;
#[cfg(feature = "std")]
mod law;
mod look;
#[cfg(feature = "record")]
mod message;
mod motion;
#[cfg(feature = "std")]
mod near;
#[cfg(feature = "std")]
mod open;
#[cfg(feature = "std")]
mod outline;
#[cfg(feature = "std")]
mod path;
mod payload;
#[cfg(feature = "std")]
mod plan;
mod pose;
#[cfg(feature = "std")]
mod progress;
mod safety;
#[cfg(feature = "std")]
mod search;
#[cfg(feature = "std")]
mod skid;
#[cfg(feature = "std")]
mod smooth;
mod standstill;
mod steer;
#[cfg(feature = "std")]
mod sweep;
mod track;
#[cfg(feature = "std")]
mod trail;
#[cfg(feature = "std")]
mod trailer_field;
mod twist;

#[cfg(feature = "std")]
pub use arcs::ArcPlanner;
#[cfg(feature = "std")]
pub use careful::PersonCaution;
#[cfg(feature = "std")]
pub use clearance::Clearance;
#[cfg(feature = "std")]
pub use costs::{CostMap, write_costs};
#[cfg(feature = "std")]
pub use curve_follow::CurveFollower;
#[cfg(feature = "std")]
pub use follow::PathFollower;
#[cfg(feature = "std")]
pub use frontiers::Frontiers;
pub use guard::OdometryGuard;
#[cfg(feature = "std")]
pub use hazard::HazardStop;
#[cfg(feature = "std")]
pub use lattice::{CurveDrive, CurvePlanner, CurveSearch, Floor, Goal, Ground, Section, Start, Way};
#[cfg(feature = "std")]
pub use law::FollowingLaw;
pub use look::LookAround;
pub use motion::{MoveRobot, MoveToObstacle, PositionToTarget};
#[cfg(feature = "std")]
pub use path::{Path, Projection};
pub use payload::{Articulated, BackUp, ReactiveApproach};
#[cfg(feature = "std")]
pub use payload::{BackFollower, BackPath, BackPiece, PlannedApproach};
#[cfg(feature = "std")]
pub use plan::{PathPlanner, Planner, Smoothing};
pub use pose::{compose, relative, shift, turned};
pub use safety::{ProtectiveField, SafetyField};
#[cfg(feature = "std")]
pub use search::{NoPath, Search, Terrain};
#[cfg(feature = "std")]
pub use skid::SkidFollower;
#[cfg(feature = "std")]
pub use smooth::{is_clear, simplify, smooth, subdivide};
pub use standstill::Standstill;
pub use steer::Steer;
#[cfg(feature = "std")]
pub use sweep::SweepStop;
pub use track::{TrackPose, stand_before};
#[cfg(feature = "std")]
pub use trail::PersonTrail;
#[cfg(feature = "std")]
pub use trailer_field::TrailerField;
pub use twist::Twist;
