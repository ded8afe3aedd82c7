//! Simulation of the work of PATSY in a clinic (thesis 6.1): a building with people, containers, furniture that is not
//! on the plan, small things on the floor and an open stairwell.

mod body;
mod conditions;
mod drivers;
mod fault;
mod report;
mod site;
mod state;
mod view;

pub use conditions::{Conditions, Value};
pub use drivers::{Camera, Dispatch, Drivers, LiftDrive, Motors, RearScanner, Scanner, Wheels};
pub use fault::{Fault, FaultKind, words};
pub use report::{Contact, Delivery, Report};
pub use site::{DOCK, PEOPLE, STAIRWELL};
pub use state::{Clinic, DURATION, Options, Snapshot, State};
