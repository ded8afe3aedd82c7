//! Tables of what was measured.

use crate::measure::{self, Effort, Measurement};
use apex_bench::{SKIPPED, SYNCHRONOUS};
use serde::Serialize;
use std::fmt::Write as _;

/// All results of a run.
#[derive(Serialize)]
pub struct Report {
    graphs: Vec<Measurement>,
    skipped_ticks: Vec<Skipped>,
}

/// A tick in which nothing but the source fires.
#[derive(Serialize)]
pub struct Skipped {
    chain: &'static str,
    /// Its time in times of the shortest chain's.
    ratio: f64,
}

/// Compares skipped ticks of all chain lengths with those of the shortest.
pub fn skipped(effort: Effort) -> Vec<Skipped> {
    let (_, shortest) = SKIPPED[0];
    SKIPPED[1..].iter().map(|(chain, run)| Skipped { chain, ratio: measure::ratio(*run, shortest, effort) }).collect()
}

impl Report {
    /// The report of a run.
    pub fn new(graphs: Vec<Measurement>, skipped_ticks: Vec<Skipped>) -> Self {
        Self { graphs, skipped_ticks }
    }

    /// Whether both sides computed the same everywhere.
    pub fn all_equal(&self) -> bool {
        self.graphs.iter().all(|m| m.equal)
    }

    /// For a terminal.
    pub fn text(&self) -> String {
        let mut text = format!(
            "{:<12}{:>14}{:>14}{:>8}{:>7}{:>10}  {:<9}{}\n",
            "graph", "apex ns/tick", "hand ns/tick", "ratio", "goal", "alloc/tick", "checksum", "goal"
        );
        for m in &self.graphs {
            let [equal, met] = verdicts(m);
            let _ = writeln!(
                text,
                "{:<12}{:>14.2}{:>14.2}{:>8.2}{:>7.2}{:>10.2}  {equal:<9}{met}",
                m.name, m.apex_ns, m.hand_ns, m.ratio, m.goal, m.allocations
            );
        }
        text + &self.skipped_lines("")
    }

    /// For a page.
    pub fn markdown(&self) -> String {
        let mut text =
            "| graph | apex, ns per tick | hand, ns per tick | ratio | goal | allocations per tick | checksum | |\n\
                        |---|--:|--:|--:|--:|--:|---|---|\n"
                .to_owned();
        for m in &self.graphs {
            let [equal, met] = verdicts(m);
            let _ = writeln!(
                text,
                "| {} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {equal} | {met} |",
                m.name, m.apex_ns, m.hand_ns, m.ratio, m.goal, m.allocations
            );
        }
        text + "\n" + &self.skipped_lines("- ")
    }

    /// For programs.
    pub fn json(&self) -> Result<String, String> {
        serde_json::to_string_pretty(self).map_err(|e| e.to_string())
    }

    fn skipped_lines(&self, bullet: &str) -> String {
        let (shortest, _) = SKIPPED[0];
        let line = |s: &Skipped| {
            let met = if s.ratio <= SYNCHRONOUS { "met" } else { "missed" };
            format!(
                "{bullet}skipped tick: {} costs {:.2} times {shortest} (goal {SYNCHRONOUS}): {met}\n",
                s.chain, s.ratio
            )
        };
        self.skipped_ticks.iter().map(line).collect()
    }
}

fn verdicts(m: &Measurement) -> [&'static str; 2] {
    [if m.equal { "equal" } else { "DIFFERENT" }, if m.meets_goal() { "met" } else { "missed" }]
}
