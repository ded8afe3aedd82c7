//! Programs of Apex beside ROS 2, without ROS installed: topics, services, actions and parameters over Zenoh, as
//! `rmw_zenoh` has them.
mod action;
mod args;
mod attachment;
mod distribution;
mod endpoint;
mod error;
mod graph;
mod log;
mod name;
mod params;
mod publication;
mod qos;
mod ring;
mod ros;
mod service;
mod session;
mod silence;
mod subscription;
mod tf;
mod time;
mod token;

pub use action::{SendingGoals, ServingGoals};
pub use args::{Args, Remapping};
pub use attachment::Attachment;
pub use distribution::{Distribution, NO_HASH};
pub use error::Error;
pub use name::{Scope, key, type_of_wire, wire_type};
pub use publication::{Publisher, Publishing, PublishingAs};
pub use qos::{Durability, Qos, Reliability};
pub use ros::{Opening, Ros};
pub use service::{Calling, Client, Serving};
pub use subscription::{Subscribing, Subscription};
pub use time::RosClock;
pub use token::{Endpoint, Kind, NotAToken, Token};
