//! Actions: goals that another program carries out, or that this one carries out for others. They take time, tell how
//! far they are, and can be called off.
//!
//! The client of an action is active while its goal is under way. The server is active while it waits for a goal, and
//! its activity leaves with the goal for the nodes that carry it out. Both talk in [`Order`]s and [`Report`]s: to other
//! programs (`apex-ros` makes them actions of ROS 2), or to each other in one program, for its tests.

mod client;
#[cfg(feature = "record")]
mod message;
mod server;
mod tokens;

pub use client::{ActionClient, ActionLink};
pub use server::ActionServer;
pub use tokens::{End, GoalId, Loss, Order, Report};
