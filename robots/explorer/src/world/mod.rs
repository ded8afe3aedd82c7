//! The world of the robot: a walled field with rocks, objects and a base station, the drivers of the robot in it, and a
//! referee who sees the true state.

mod drivers;
mod fault;
mod field;
mod report;
mod state;

pub use drivers::{Charge, ColorEye, Judge, Motors, Scanner, Wheels};
pub use fault::{Fault, FaultKind};
pub use field::{Field, Kind, Object};
pub use report::{Contact, Report};
pub use state::{Options, Planet, RADIUS, State};
