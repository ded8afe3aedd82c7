//! Waiting for what other threads bring.

use std::{
    fmt::Debug,
    sync::{Arc, Mutex},
    thread,
    time::{Duration, Instant},
};

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
