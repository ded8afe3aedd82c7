//! Waiting for what other threads bring.

use std::{
    fmt::Debug,
    sync::{Arc, Mutex},
    thread,
    time::{Duration, Instant},
};

/// For what has to happen, also on a busy machine.
const LONG: Duration = Duration::from_secs(15);

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
        self.wait(LONG, |all| all == expected);
        assert_eq!(self.all(), expected);
    }

    /// Waits until the last ones are these, whatever came before.
    pub fn expect_at_end<U: Debug>(&self, expected: &[U])
    where
        T: PartialEq<U> + Debug,
    {
        let at_end = |all: &[T]| all.len() >= expected.len() && all[all.len() - expected.len()..] == *expected;
        assert!(self.wait(LONG, at_end), "{:?} does not end with {expected:?}", self.all());
    }

    /// Waits until this is so of all that were collected, at most for some time. Returns `true` if it is.
    pub fn wait(&self, longest: Duration, is_so: impl Fn(&[T]) -> bool) -> bool {
        let start = Instant::now();
        loop {
            let is_it = is_so(&self.0.lock().expect("no panic"));
            if is_it || start.elapsed() >= longest {
                return is_it;
            }
            thread::sleep(Duration::from_millis(2));
        }
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
