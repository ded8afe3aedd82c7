//! Nodes of a crate without a heap.
#![no_std]
use apex_rt::prelude::*;

/// A source.
#[node]
pub fn one() -> u64 {
    1
}

/// Stores all tokens.
#[node]
pub struct Keep {
    seen: Vec<u64>,
}

#[node]
impl Keep {
    fn process(&mut self, x: &u64) {
        self.seen.push(*x);
    }
}

/// Writes to a file.
#[cfg(feature = "std")]
#[node]
pub fn write(x: &u64) {
    drop(*x);
}

/// Converts a token to a string.
#[node]
pub fn spell(x: &u64) -> String {
    x.to_string()
}

#[cfg(feature = "camera")]
#[node]
pub fn camera() -> u64 {
    0
}
