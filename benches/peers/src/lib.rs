//! The graphs of `apex-bench` in other frameworks, with the same node functions.
//!
//! Ticks run in lockstep: a tick begins when the sink has the value of the previous one. Peers with relaxed lockstep
//! have `-batch` in their names.

#![recursion_limit = "1024"] // A hundred operations in a row are a type of this depth.

pub mod copper;
pub mod dataflow;
pub mod dfir;
pub mod exchange;
pub mod machines;
pub mod pool;
mod ran;
pub mod reactive;
pub mod tasks;

pub use ran::Ran;
pub(crate) use ran::timed;

/// A graph in a framework.
pub struct Peer {
    /// The graph.
    pub graph: &'static str,
    /// Name of the framework, with special features of its use.
    pub name: &'static str,
    /// Runs a number of ticks from the beginning.
    pub run: fn(u64) -> Ran,
}

macro_rules! peers {
    ($($name:literal: $($graph:ident = $run:path),+;)+) => {
        /// All peers.
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
    "rayon": chain3 = pool::chain::<3>, chain10 = pool::chain::<10>, chain100 = pool::chain::<100>, diamond8 = pool::diamond::<8>, diamond64 = pool::diamond::<64>, nested1000 = pool::nested1000;
    "rxrust": chain3 = reactive::chain3, chain10 = reactive::chain10, chain100 = reactive::chain100, diamond8 = reactive::diamond8, diamond64 = reactive::diamond64, bot100 = reactive::bot100, throttle = reactive::throttle, rate23 = reactive::rate23, nested1000 = reactive::nested1000, mpse8 = reactive::mpse8;
    "tokio-ct": chain3 = tasks::chain::<3>, chain10 = tasks::chain::<10>, chain100 = tasks::chain::<100>, diamond8 = tasks::diamond::<8>, diamond64 = tasks::diamond::<64>, bot100 = tasks::bot100, throttle = tasks::throttle, pingpong = tasks::pingpong, mpse8 = tasks::mpse8;
    "timely": chain3 = dataflow::chain3, chain10 = dataflow::chain10, chain100 = dataflow::chain100, bot100 = dataflow::bot100;
    "statig": fsm16 = machines::statig::fsm16;
    "smlang": fsm16 = machines::smlang::fsm16;
    "triple_buffer-free": tworegion = exchange::triple_buffer;
    "crossbeam-free": tworegion = exchange::array_queue;
}
