//! Simulation of the competition (thesis 4.1, 4.2): our base among three rivals, the operators at the stations, and the
//! referee.

mod body;
mod drivers;
mod fault;
mod hall;
mod operator;
mod referee;
mod report;
mod rival;
mod rules;
mod standing;
mod steering;
mod world;

pub use drivers::{Base, Drivers, FrontCamera, FrontLaser, HopperCamera, Lamp, RearLaser, Remote, WheelOdometry};
pub use fault::{Fault, FaultKind};
pub use hall::Hall;
pub use report::{Collision, Delivery, Obstacle, Report, Rivalry};
pub use rules::{DURATION, RIVALS, START};
pub use standing::{OpenHall, Scoreboard, Standing};
pub use world::{Contest, RADIUS, Robot};
