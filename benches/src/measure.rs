//! Times both sides in turn.

use apex_bench::{Case, Run};
use serde::Serialize;
use std::{
    convert::Infallible,
    hint::black_box,
    time::{Duration, Instant},
};

/// Differences below this are no finding: how a loop happens to be aligned makes as much.
pub const RESOLUTION_NS: f64 = 0.5;

/// How long to measure.
#[derive(Clone, Copy)]
pub struct Effort {
    /// Rounds; both sides run in each.
    pub rounds: usize,
    /// About how long the slower side runs in a round. Short, so that a disturbance spoils few rounds.
    pub round: Duration,
}

/// What a comparison found.
#[derive(Serialize)]
pub struct Measurement {
    /// The graph.
    pub name: &'static str,
    /// Nanoseconds per tick of the compiled program, median.
    pub apex_ns: f64,
    /// Nanoseconds per tick by hand, median.
    pub hand_ns: f64,
    /// Median of the ratios of the rounds.
    pub ratio: f64,
    /// The largest ratio wanted, if any.
    pub goal: Option<f64>,
    /// Whether the checksums agree.
    pub equal: bool,
    /// Allocations per tick of the compiled program, after warm-up.
    pub allocations: f64,
}

impl Measurement {
    /// Whether it is as fast as wanted and allocates nothing.
    pub fn meets_goal(&self) -> bool {
        let fast = self.goal.is_none_or(|goal| self.ratio <= goal) || self.apex_ns - self.hand_ns < RESOLUTION_NS;
        fast && self.allocations == 0.0
    }
}

/// Compares both sides of `case`, round by round, each side first in turn.
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

/// Allocations per tick once all storage has been made.
fn allocations(run: Run) -> f64 {
    const TICKS: u64 = 100;
    let (few, many) = (apex_bench::allocations(run, TICKS), apex_bench::allocations(run, 2 * TICKS));
    (many as f64 - few as f64) / TICKS as f64
}

/// What a run of a number of ticks gave.
#[derive(Clone, Copy)]
pub struct Round {
    /// Nanoseconds per tick.
    pub ns: f64,
    /// The result.
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

/// How many ticks of `run` take about `duration`.
fn ticks_of(run: Run, duration: Duration) -> u64 {
    let Ok(ticks) = ticks_in(duration, |ticks| Ok::<_, Infallible>(timed(run, ticks)));
    ticks
}

/// How many ticks take about `duration`.
pub fn ticks_in<E>(duration: Duration, mut run: impl FnMut(u64) -> Result<Round, E>) -> Result<u64, E> {
    let mut ticks = 4;
    while run(ticks)?.ns * (ticks as f64) < duration.as_nanos() as f64 / 2.0 {
        ticks *= 2;
    }
    Ok(ticks)
}

/// The one in the middle.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
