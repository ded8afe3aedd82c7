//! Simulated surroundings of the vehicle: rooms and a clinic with containers, furniture, people and small things.

mod cart;
pub mod clinic;
mod motion;
mod room;
mod scene;
mod sim_laser;
mod sim_tof;
mod thing;
mod tractor;

pub use cart::Cart;
pub use motion::Scenario;
pub use scene::{Scene, labelled_scene};
pub use sim_laser::{SimLaser, Truth};
pub use sim_tof::SimTof;
pub use thing::Thing;
pub(crate) use tractor::tractor;
