//! The graphs of `apex-bench` as other frameworks have them. They call the same node functions.
//!
//! Lockstep: a tick begins when the sink has the value of the one before. What relaxes this has `-batch` in its name.

#![recursion_limit = "1024"] // A hundred operations in a row are a type of this depth.

pub mod copper;
pub mod dfir;

use std::{
    hint::black_box,
    time::{Duration, Instant},
};

/// What a run gave.
#[derive(Clone, Copy)]
pub struct Ran {
    /// How long all ticks took, without what is done once.
    pub time: Duration,
    /// What the sink had at the end.
    pub checksum: u64,
}

/// How long `ticks` takes.
pub(crate) fn timed(ticks: impl FnOnce()) -> Duration {
    let start = Instant::now();
    black_box(ticks());
    start.elapsed()
}

/// A graph as a framework has it.
pub struct Peer {
    /// The graph.
    pub graph: &'static str,
    /// The framework, and what is special about how it is used.
    pub name: &'static str,
    /// Runs a number of ticks from the beginning.
    pub run: fn(u64) -> Ran,
}

macro_rules! peers {
    ($($name:literal: $($graph:ident = $run:path),+;)+) => {
        /// All of them.
        pub const PEERS: &[Peer] = &[$($(Peer { graph: stringify!($graph), name: $name, run: $run },)+)+];
    };
}

peers! {
    "cu29": chain3 = copper::chain3, chain10 = copper::chain10, chain100 = copper::chain100,
        diamond8 = copper::diamond8, bot100 = copper::bot100, throttle = copper::throttle;
    "dfir": chain3 = dfir::chain3, chain10 = dfir::chain10, chain100 = dfir::chain100,
        diamond8 = dfir::diamond8, diamond64 = dfir::diamond64, bot100 = dfir::bot100,
        throttle = dfir::throttle, rate23 = dfir::rate23, nested1000 = dfir::nested1000,
        pingpong = dfir::pingpong, mpse8 = dfir::mpse8;
    "dfir-batch": chain3 = dfir::chain3_batch, chain10 = dfir::chain10_batch, chain100 = dfir::chain100_batch;
}
