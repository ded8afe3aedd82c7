//! DDS as the carrier of a node of ROS 2, as `rmw_cyclonedds` and `rmw_fastrtps` use it:
//! `Ros::node("rover").over(apex_ros_dds::open)`.
//!
//! The protocol is that of RustDDS, in Rust. Messages are passed on as bytes, and the identifications of nodes have the
//! length of the distribution, so that one binary serves all of them.
mod call;
mod carrier;
mod known;
mod listen;
mod name;
mod nodes;
mod participant;
mod qos;
mod raw;
mod serve;
mod vendor;

pub use carrier::{Dds, open};
pub use vendor::Vendor;
