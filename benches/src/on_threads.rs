//! `apex-bench threads`: the speedup of two threads, and the time that a token takes between them.

use crate::measure::median;
use apex_bench::{threads, tworegion};
use std::{
    process::ExitCode,
    time::{Duration, Instant},
};

/// Firings of a worker in a round.
const FIRINGS: u64 = 2_000;
/// Balls in a round.
const BALLS: u64 = 2_000;
/// Ticks of two regions in a round.
const TICKS: u64 = 20_000;

/// Measures in several rounds, fewer with `quick`.
pub fn run(quick: bool) -> Result<ExitCode, String> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    if cores < 2 {
        return Err("two threads need two cores, and this machine has one".to_owned());
    }
    let rounds = if quick { 5 } else { 21 };
    let mut speedups: Vec<f64> = (0..rounds)
        .map(|_| {
            let (together, apart) = threads::scaling(FIRINGS);
            together.as_secs_f64() / apart.as_secs_f64()
        })
        .collect();
    println!("two independent regions on two threads: {:.2} times as fast as on one (goal 1.8)", median(&mut speedups));
    for (name, pause, balls) in [
        ("event to another thread, which is awake", Duration::ZERO, BALLS),
        ("event to another thread, which slept for 200 µs", Duration::from_micros(200), BALLS / 10),
    ] {
        let mut took: Vec<u64> = (0..rounds).flat_map(|_| threads::latencies(balls, pause)).collect();
        took.sort_unstable();
        let at = |share: f64| Duration::from_nanos(took[((took.len() - 1) as f64 * share) as usize]);
        println!("{name}: p50 {:.2?}, p99 {:.2?} (goal: p50 below 5 µs)", at(0.5), at(0.99));
    }
    let mut torn = 0;
    let mut ratios: Vec<f64> = (0..rounds)
        .map(|_| {
            let (took, bad) = threads::two_regions(TICKS);
            torn += bad;
            let start = Instant::now();
            torn += tworegion::hand(TICKS);
            took.as_secs_f64() / start.elapsed().as_secs_f64()
        })
        .collect();
    println!("tworegion: {:.1} times both regions in turn by hand (goal 5), {torn} torn values", median(&mut ratios));
    Ok(ExitCode::from(u8::from(torn > 0)))
}
