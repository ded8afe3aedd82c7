//! The world of the robot: open country with a track, a runner and passers-by, the drivers of the robot in it, and a
//! referee who sees the true state.

mod drivers;
mod fault;
mod report;
mod state;

pub use drivers::{Camera, Gnss, Imu, Judge, Motors, Odometry, Scanner, Wheels};
pub use fault::{Fault, FaultKind};
pub use report::{Belief, Contact, Ending, Loss, Report};
pub use state::{Field, Options, State};
