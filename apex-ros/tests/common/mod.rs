//! A router of Zenoh for tests, and waiting.
#![allow(dead_code, reason = "each test uses a part of it")]

pub mod python;

use apex_ros::{Opening, Ros};
use std::{
    fmt::Debug,
    net::TcpListener,
    sync::{Arc, Mutex},
    thread,
    time::{Duration, Instant},
};
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

/// Waits until `is_so` returns `true`, at most for some seconds. Returns how long it took.
pub fn within(seconds: f32, what: &str, mut is_so: impl FnMut() -> bool) -> Duration {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed().as_secs_f32() < seconds, "not within {seconds} s: {what}");
        thread::sleep(Duration::from_millis(2));
    }
    start.elapsed()
}

/// Things that another thread collects.
pub struct Collected<T>(Arc<Mutex<Vec<T>>>);

impl<T> Clone for Collected<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T: Clone + Send + 'static> Collected<T> {
    pub fn new() -> Self {
        Self(Arc::default())
    }

    pub fn add(&self, it: T) {
        self.0.lock().expect("no panic").push(it);
    }

    /// All that were collected so far.
    pub fn all(&self) -> Vec<T> {
        self.0.lock().expect("no panic").clone()
    }

    /// Waits for exactly these. What another port or topic has brought says nothing about when they come.
    pub fn expect<U: Debug>(&self, expected: &[U])
    where
        T: PartialEq<U> + Debug,
    {
        let all = || self.all();
        let start = Instant::now();
        while all() != expected && start.elapsed() < Duration::from_secs(5) {
            thread::sleep(Duration::from_millis(2));
        }
        assert_eq!(all(), expected);
    }

    pub fn clear(&self) {
        self.0.lock().expect("no panic").clear();
    }

    /// A function that collects.
    pub fn collector(&self) -> impl Fn(T) + Send + Sync + use<T> {
        let here = self.clone();
        move |it| here.add(it)
    }
}
