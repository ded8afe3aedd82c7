//! Instructions per tick, counted by valgrind as the difference of two runs of different length.

use apex_bench::CASES;
use std::{
    env,
    process::{Command, ExitCode},
};

/// Program of a graph.
#[derive(Clone, Copy, clap::ValueEnum)]
pub enum Side {
    /// Compiled from the source file.
    Apex,
    /// Written by hand.
    Hand,
}

/// Lengths of the two runs; both are multiples of all periods in the graphs.
const SHORT: u64 = 1000;
const LONG: u64 = 2000;

/// `true` if valgrind is available.
pub fn can_count() -> bool {
    Command::new("valgrind").arg("--version").output().is_ok()
}

/// Prints a table of all graphs.
pub fn run() -> Result<ExitCode, String> {
    if !can_count() {
        println!("skipped: counting instructions needs valgrind");
        return Ok(ExitCode::SUCCESS);
    }
    println!("{:<16}{:>16}{:>16}{:>8}", "graph", "apex instr/tick", "hand instr/tick", "ratio");
    for case in &CASES {
        let (apex, hand) = (per_tick(case.name, Side::Apex)?, per_tick(case.name, Side::Hand)?);
        println!("{:<16}{apex:>16.2}{hand:>16.2}{:>8.2}", case.name, apex / hand);
    }
    Ok(ExitCode::SUCCESS)
}

/// Runs ticks of one program of a graph.
pub fn ticks(graph: &str, side: Side, ticks: u64) -> Result<ExitCode, String> {
    let case = CASES.iter().find(|c| c.name == graph).ok_or_else(|| format!("there is no graph `{graph}`"))?;
    let run = match side {
        Side::Apex => case.apex,
        Side::Hand => case.hand,
    };
    println!("{}", run(ticks));
    Ok(ExitCode::SUCCESS)
}

/// Instructions per tick of one program of a graph.
pub fn per_tick(graph: &str, side: Side) -> Result<f64, String> {
    // A frame takes millions of instructions, so a few frames are enough.
    let scale = if graph == "image" { 125 } else { 1 };
    let (short, long) = (SHORT / scale, LONG / scale);
    let difference = count(graph, side, long)?.saturating_sub(count(graph, side, short)?);
    Ok(difference as f64 / (long - short) as f64)
}

fn count(graph: &str, side: Side, ticks: u64) -> Result<u64, String> {
    let side = match side {
        Side::Apex => "apex",
        Side::Hand => "hand",
    };
    let own = env::current_exe().map_err(|e| e.to_string())?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(own)
        .args(["ticks", graph, side, &ticks.to_string()])
        .output()
        .map_err(|e| format!("cannot run valgrind: {e}"))?;
    let log = String::from_utf8_lossy(&output.stderr);
    let collected = log.lines().find_map(|line| line.split_once("Collected :")?.1.trim().parse().ok());
    collected.ok_or_else(|| format!("valgrind counted nothing for `{graph}`: {log}"))
}
