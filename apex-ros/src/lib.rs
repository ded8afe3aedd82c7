//! Programs of Apex beside ROS 2, without ROS installed: topics, services, actions and parameters over Zenoh, as
//! `rmw_zenoh` has them. [`Carrier`] is what another middleware has to do in its place.
mod action;
mod args;
mod attachment;
mod carrier;
mod distribution;
mod drive;
mod endpoint;
mod error;
mod graph;
mod lifecycle;
mod log;
mod name;
mod opening;
#[cfg(feature = "zenoh")]
mod over_zenoh;
mod params;
mod params_file;
mod publication;
mod qos;
mod report;
mod ring;
mod ros;
mod service;
#[cfg(feature = "zenoh")]
mod session;
mod silence;
mod subscription;
mod tf;
mod time;
mod token;
mod voice;
mod yaml;

pub use action::{SendingGoals, ServingGoals};
pub use args::{Args, Remapping};
pub use attachment::Attachment;
pub use carrier::{
    Answer, Ask, Carrier, Hear, HearRequest, HearResponse, Kept, OpenCarrier, Payload, Publish, Rules, SendError,
    endpoint_of,
};
pub use distribution::{Distribution, NO_HASH};
pub use error::Error;
pub use graph::Graph;
pub use lifecycle::Managing;
pub use name::{Scope, key, type_of_wire, wire_type};
pub use opening::Opening;
pub use params_file::FileParam;
pub use publication::{Publisher, Publishing, PublishingAs};
pub use qos::{Durability, Qos, Reliability};
pub use ros::Ros;
pub use service::{Calling, Client, Serving};
pub use subscription::{Subscribing, Subscription};
pub use time::RosClock;
pub use token::{Endpoint, Kind, NotAToken, Token};
