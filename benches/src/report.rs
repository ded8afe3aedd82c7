//! Tables of the results.

use crate::measure::{self, Effort, Measurement, RESOLUTION_NS};
use apex_bench::{Case, SKIPPED, SYNCHRONOUS};
use serde::Serialize;
use std::fmt::Write as _;

/// All results of a run.
#[derive(Serialize)]
pub struct Report {
    graphs: Vec<Measurement>,
    skipped_ticks: Vec<Measurement>,
}

/// Compares skipped ticks of all chain lengths with those of the shortest chain, which takes the place of the
/// hand-written program.
pub fn skipped(effort: Effort) -> Vec<Measurement> {
    let (_, shortest) = SKIPPED[0];
    let case = |(name, run)| Case { name, apex: run, hand: shortest, goal: Some(SYNCHRONOUS) };
    SKIPPED[1..].iter().map(|chain| measure::compare(&case(*chain), effort)).collect()
}

impl Report {
    /// The report of a run.
    pub fn new(graphs: Vec<Measurement>, skipped_ticks: Vec<Measurement>) -> Self {
        Self { graphs, skipped_ticks }
    }

    /// `true` if both programs have equal checksums for all graphs.
    pub fn all_equal(&self) -> bool {
        self.graphs.iter().all(|m| m.equal)
    }

    /// The report for a terminal.
    pub fn text(&self) -> String {
        let mut text = format!(
            "{:<16}{:>14}{:>14}{:>8}{:>7}{:>12}  {:<10}{}\n",
            "graph", "apex ns/tick", "hand ns/tick", "ratio", "goal", "alloc/tick", "checksum", "verdict"
        );
        for m in &self.graphs {
            let [equal, met] = verdicts(m);
            let _ = writeln!(
                text,
                "{:<16}{:>14.2}{:>14.2}{:>8.2}{:>7}{:>12.2}  {equal:<10}{met}",
                m.name,
                m.apex_ns,
                m.hand_ns,
                m.ratio,
                goal(m),
                m.allocations
            );
        }
        text + &self.skipped_lines("")
    }

    /// The report in Markdown.
    pub fn markdown(&self) -> String {
        let mut text =
            "| graph | apex, ns per tick | hand, ns per tick | ratio | goal | allocations per tick | checksum | |\n\
                        |---|--:|--:|--:|--:|--:|---|---|\n"
                .to_owned();
        for m in &self.graphs {
            let [equal, met] = verdicts(m);
            let _ = writeln!(
                text,
                "| {} | {:.2} | {:.2} | {:.2} | {} | {:.2} | {equal} | {met} |",
                m.name,
                m.apex_ns,
                m.hand_ns,
                m.ratio,
                goal(m),
                m.allocations
            );
        }
        text + "\n" + &self.skipped_lines("- ")
    }

    /// The report as JSON.
    pub fn json(&self) -> Result<String, String> {
        serde_json::to_string_pretty(self).map_err(|e| e.to_string())
    }

    fn skipped_lines(&self, bullet: &str) -> String {
        let (shortest, _) = SKIPPED[0];
        let line = |m: &Measurement| {
            let [_, met] = verdicts(m);
            format!(
                "{bullet}skipped tick of {}: {:.2} ns, {:.2} times {shortest} (goal {}): {met}\n",
                m.name,
                m.apex_ns,
                m.ratio,
                goal(m)
            )
        };
        let lines: String = self.skipped_ticks.iter().map(line).collect();
        lines + &format!("{bullet}differences below {RESOLUTION_NS} ns are not counted as missed\n")
    }
}

/// Word for a goal that is met, or not.
pub const fn met(is_met: bool) -> &'static str {
    if is_met { "met" } else { "missed" }
}

fn goal(m: &Measurement) -> String {
    m.goal.map_or_else(|| "—".to_owned(), |goal| format!("{goal:.2}"))
}

fn verdicts(m: &Measurement) -> [&'static str; 2] {
    [
        if m.equal { "equal" } else { "DIFFERENT" },
        match m.goal {
            None => "",
            Some(_) => met(m.meets_goal()),
        },
    ]
}
