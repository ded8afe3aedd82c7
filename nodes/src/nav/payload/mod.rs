//! Payload acquisition: steering a tractor with a passively steered trailer beneath a container (thesis 6.7).

mod back;
#[cfg(feature = "std")]
mod back_path;
#[cfg(feature = "std")]
pub(super) mod dubins;
#[cfg(feature = "std")]
mod planned;
mod reactive;
mod vehicle;

pub use back::BackUp;
#[cfg(all(test, feature = "std"))]
pub(super) use back_path::tests::Backing;
#[cfg(feature = "std")]
pub use back_path::{BackFollower, BackPath, BackPiece};
#[cfg(feature = "std")]
pub use planned::PlannedApproach;
pub use reactive::ReactiveApproach;
pub use vehicle::Articulated;
