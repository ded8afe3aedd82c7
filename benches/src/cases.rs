//! The benchmarks and their goals.

use crate::{graphs, hand};

/// Runs a number of ticks from the beginning and returns the checksum.
pub type Run = fn(u64) -> u64;

/// One graph, compiled and by hand.
pub struct Case {
    /// Name of the graph.
    pub name: &'static str,
    /// The compiled program.
    pub apex: Run,
    /// The same program written by hand.
    pub hand: Run,
    /// Maximum ratio of the time of the compiled program to that of the hand-written one. `None` for information only.
    pub goal: Option<f64>,
}

/// The goal for synchronous graphs.
pub const SYNCHRONOUS: f64 = 1.1;

/// The goal for a synchronous graph that a clock drives.
const DRIVEN: f64 = 1.05;

/// The goal for graphs with decisions at run time.
const DISPATCHED: f64 = 2.0;

const fn case(name: &'static str, apex: Run, hand: Run, goal: f64) -> Case {
    Case { name, apex, hand, goal: Some(goal) }
}

/// A comparison without a goal.
const fn information(name: &'static str, apex: Run, hand: Run) -> Case {
    Case { name, apex, hand, goal: None }
}

/// All graphs.
pub const CASES: [Case; 30] = [
    case("chain3", graphs::chain3, hand::chain3, SYNCHRONOUS),
    case("chain10", graphs::chain10, hand::chain10, SYNCHRONOUS),
    case("chain100", graphs::chain100, hand::chain100, SYNCHRONOUS),
    case("chain1000", graphs::chain1000, hand::chain1000, SYNCHRONOUS),
    case("drive10", graphs::drive10, hand::drive10, DRIVEN),
    case("diamond8", graphs::diamond8, hand::diamond8, SYNCHRONOUS),
    case("diamond64", graphs::diamond64, hand::diamond64, SYNCHRONOUS),
    case("bot100", graphs::bot100, hand::bot100, 1.2),
    case("merge8", graphs::merge8, hand::merge8, SYNCHRONOUS),
    case("throttle", graphs::throttle, hand::throttle, SYNCHRONOUS),
    case("rate23", graphs::rate23, hand::rate23, SYNCHRONOUS),
    case("nested1000", graphs::nested1000, hand::nested1000, SYNCHRONOUS),
    case("image", graphs::image, hand::image, 1.05),
    case("pingpong", graphs::pingpong, hand::pingpong, DISPATCHED),
    information("pingpong-1", graphs::pingpong1, hand::pingpong),
    case("mpse8", graphs::mpse8, hand::mpse8, DISPATCHED),
    case("fsm16", graphs::fsm16, hand::fsm16, DISPATCHED),
    information("fsm16-match", graphs::fsm16, hand::fsm16_match),
    information("fsm16-nodes", graphs::fsm16_nodes, hand::fsm16),
    case("mixed1000", graphs::mixed1000, hand::mixed1000, 0.8),
    information("mixed1000-clock", graphs::mixed1000, hand::mixed1000_clock),
    case("timer10", graphs::timer10, hand::timer10, DISPATCHED),
    case("timers2", graphs::timers2, hand::timers2, DISPATCHED),
    case("timers3", graphs::timers3, hand::timers3, DISPATCHED),
    case("4kB-value", graphs::frames_by_value, hand::frames_by_value, SYNCHRONOUS),
    case("4kB-out", graphs::frames_by_out, hand::frames_in_place, SYNCHRONOUS),
    case("4kB-event", graphs::frames_by_event, hand::frames_by_value, SYNCHRONOUS),
    case("silent10", graphs::silent10, hand::silent10, SYNCHRONOUS),
    case("silent100", graphs::silent100, hand::silent100, SYNCHRONOUS),
    case("silent1000", graphs::silent1000, hand::silent1000, SYNCHRONOUS),
];

/// Chains whose source sends only ⊥. A tick of the longest should cost as much as one of the shortest.
pub const SKIPPED: [(&str, Run); 3] =
    [("silent10", graphs::silent10), ("silent100", graphs::silent100), ("silent1000", graphs::silent1000)];

/// Number of memory allocations in `ticks` ticks from the beginning.
pub fn allocations(run: Run, ticks: u64) -> u64 {
    allocation_counter::measure(|| {
        std::hint::black_box(run(ticks));
    })
    .count_total
}
