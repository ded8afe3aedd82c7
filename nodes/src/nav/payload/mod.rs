//! Payload acquisition: steering a tractor with a passively steered trailer beneath a container (thesis 6.7).

mod back;
pub(super) mod dubins;
mod planned;
mod reactive;
mod vehicle;

pub use back::BackUp;
pub use planned::PlannedApproach;
pub use reactive::ReactiveApproach;
pub use vehicle::{Articulated, trailer_rotation};
