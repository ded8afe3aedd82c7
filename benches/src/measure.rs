//! Measures both programs of a graph in alternation.

use apex_bench::{Case, Run};
use serde::Serialize;
use std::{
    convert::Infallible,
    hint::black_box,
    time::{Duration, Instant},
};

/// Differences below this are not significant: the alignment of a loop has effects of this size.
pub const RESOLUTION_NS: f64 = 0.5;

/// Duration of a measurement.
#[derive(Clone, Copy)]
pub struct Effort {
    /// Number of rounds; both programs run in each.
    pub rounds: usize,
    /// Approximate time of the slower program in a round. It is short, so that a disturbance affects few rounds.
    pub round: Duration,
}

/// Result of a comparison.
#[derive(Serialize)]
pub struct Measurement {
    /// Name of the graph.
    pub name: &'static str,
    /// Nanoseconds per tick of the compiled program, median.
    pub apex_ns: f64,
    /// Nanoseconds per tick by hand, median.
    pub hand_ns: f64,
    /// Median of the ratios of the rounds.
    pub ratio: f64,
    /// Goal: maximum ratio, if any.
    pub goal: Option<f64>,
    /// `true` if the checksums agree.
    pub equal: bool,
    /// Allocations per tick of the compiled program, after warm-up.
    pub allocations: f64,
}

impl Measurement {
    /// `true` if the program is as fast as the goal and allocates nothing.
    pub fn meets_goal(&self) -> bool {
        let fast = self.goal.is_none_or(|goal| self.ratio <= goal) || self.apex_ns - self.hand_ns < RESOLUTION_NS;
        fast && self.allocations == 0.0
    }
}

/// Compares both programs of `case` round by round. They alternate in running first.
pub fn compare(case: &Case, effort: Effort) -> Measurement {
    let ticks = ticks_of(case.hand, effort.round).min(ticks_of(case.apex, effort.round));
    let mut equal = true;
    let (mut apex, mut hand, mut ratios) = (vec![], vec![], vec![]);
    for round in 0..effort.rounds {
        let (a, h) = in_turn(round, || timed(case.apex, ticks), || timed(case.hand, ticks));
        equal &= a.checksum == h.checksum;
        apex.push(a.ns);
        hand.push(h.ns);
        ratios.push(a.ns / h.ns);
    }
    Measurement {
        name: case.name,
        apex_ns: median(&mut apex),
        hand_ns: median(&mut hand),
        ratio: median(&mut ratios),
        goal: case.goal,
        equal,
        allocations: allocations(case.apex),
    }
}

/// Allocations per tick after all storage has been allocated.
fn allocations(run: Run) -> f64 {
    const TICKS: u64 = 100;
    let (few, many) = (apex_bench::allocations(run, TICKS), apex_bench::allocations(run, 2 * TICKS));
    (many as f64 - few as f64) / TICKS as f64
}

/// Result of a run.
#[derive(Clone, Copy)]
pub struct Round {
    /// Nanoseconds per tick.
    pub ns: f64,
    /// Checksum of the run.
    pub checksum: u64,
}

fn in_turn(round: usize, a: impl Fn() -> Round, b: impl Fn() -> Round) -> (Round, Round) {
    if round.is_multiple_of(2) {
        let a = a();
        (a, b())
    } else {
        let b = b();
        (a(), b)
    }
}

/// Runs `ticks` ticks.
pub fn timed(run: Run, ticks: u64) -> Round {
    let start = Instant::now();
    let checksum = run(black_box(ticks));
    Round { ns: start.elapsed().as_nanos() as f64 / ticks as f64, checksum }
}

/// Number of ticks of `run` that take about `duration`.
fn ticks_of(run: Run, duration: Duration) -> u64 {
    let Ok(ticks) = ticks_in(duration, |ticks| Ok::<_, Infallible>(timed(run, ticks)));
    ticks
}

/// Number of ticks that take about `duration`.
pub fn ticks_in<E>(duration: Duration, mut run: impl FnMut(u64) -> Result<Round, E>) -> Result<u64, E> {
    let mut ticks = 4;
    while run(ticks)?.ns * (ticks as f64) < duration.as_nanos() as f64 / 2.0 {
        ticks *= 2;
    }
    Ok(ticks)
}

/// Median; for an even number of values, the upper one of the two in the middle.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
