//! Simulation of the work of PATSY in a clinic (thesis 6.1): a building with people, containers, furniture that is not
//! on the plan, small things on the floor and an open stairwell.

mod body;
mod crew;
mod drivers;
mod fault;
mod order;
mod report;
mod site;
mod state;
mod view;

pub use crew::Clinic;
pub use drivers::{Camera, Dispatch, Drivers, LiftDrive, Motors, RearScanner, Scanner, Wheels};
pub use fault::{Fault, FaultKind};
pub use order::Order;
pub use report::{Contact, Delivery, Report};
pub use site::{DOCK, PEOPLE, PLAN, STAIRWELL};
pub use state::{DURATION, Options, Snapshot};
