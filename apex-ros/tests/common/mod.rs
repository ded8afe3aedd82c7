//! A router of Zenoh for tests, and waiting.
#![allow(dead_code, reason = "each test uses a part of it")]

pub mod python;
pub mod raw;
pub mod speaker;
mod wait;

use apex_ros::{Opening, Ros};
use std::net::TcpListener;
pub use wait::{Collected, within};
use zenoh::{Config, Session, Wait as _};

/// A router on this machine, at a port of its own.
pub struct Router {
    session: Option<Session>,
    pub address: String,
}

impl Router {
    pub fn start() -> Self {
        let mut router = Self::at(&free_address());
        router.resume();
        router
    }

    /// A router that does not run yet.
    pub fn at(address: &str) -> Self {
        Self { session: None, address: address.to_owned() }
    }

    pub fn resume(&mut self) {
        let mut config = Config::default();
        for (key, value) in [
            ("mode", "\"router\"".to_owned()),
            ("listen/endpoints", format!("[{:?}]", self.address)),
            ("scouting/multicast/enabled", "false".to_owned()),
        ] {
            config.insert_json5(key, &value).expect("a setting");
        }
        self.session = Some(zenoh::open(config).wait().expect("a router"));
    }

    pub fn stop(&mut self) {
        if let Some(session) = self.session.take() {
            session.close().wait().expect("it closes");
        }
    }

    /// Settings of a node at this router, without arguments.
    pub fn node(&self, name: &str) -> Opening {
        Ros::node(name).args([""; 0]).domain(0).router(&self.address)
    }
}

impl Drop for Router {
    fn drop(&mut self) {
        self.stop();
    }
}

/// An address at which nothing listens.
pub fn free_address() -> String {
    let port = TcpListener::bind("127.0.0.1:0").and_then(|listener| listener.local_addr()).expect("a port").port();
    format!("tcp/127.0.0.1:{port}")
}
