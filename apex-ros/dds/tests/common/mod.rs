//! Nodes over DDS on this machine, each test in a domain of its own.
#![allow(dead_code, reason = "each test uses a part of it")]

#[path = "../../../tests/common/raw.rs"]
pub mod raw;
#[path = "../../../tests/common/speaker.rs"]
pub mod speaker;
#[path = "../../../tests/common/wait.rs"]
mod wait;

use apex_ros::{Opening, Ros};
use apex_ros_dds::{Dds, Vendor};
use std::{
    net::Ipv4Addr,
    process,
    sync::atomic::{AtomicU32, Ordering},
};
pub use wait::{Collected, within};

/// Number of domains that were used.
static USED: AtomicU32 = AtomicU32::new(0);

/// A domain that no other test has: of this process, or of one beside it. The ports of those above 100 may be in use.
pub fn domain() -> u32 {
    1 + (process::id() * 8 + USED.fetch_add(1, Ordering::Relaxed)) % 100
}

/// Settings of a node on this machine, without arguments.
pub fn node(name: &str, domain: u32, vendor: Vendor) -> Opening {
    let settings = Dds::new().vendor(vendor).networks([Ipv4Addr::LOCALHOST.into()]);
    Ros::node(name).args([""; 0]).domain(domain).over(move |domain, distribution| settings.open(domain, distribution))
}
