//! Tables of the results.

use super::{
    cost::{Both, Cost, Costs, Size},
    row::{Other, Row},
};
use std::fmt::Write as _;

/// Tables for a terminal.
pub fn text(rows: &[Row], costs: &Costs, missing: &[String]) -> String {
    let mut text = format!("{:<12}{:>10}  {}\n", "graph", "hand ns", "in times of that, per tick");
    for row in rows {
        let others: Vec<String> = row.others.iter().map(entry).collect();
        let _ = writeln!(text, "{:<12}{:>10.2}  {}", row.graph, row.hand_ns, others.join(", "));
    }
    let _ = writeln!(
        text,
        "\n{:<12}{:>22}{:>18}{:>18}  apex / hand, per tick",
        "graph", "instructions", "allocations", "p99.9 / p50"
    );
    for cost in &costs.ticks {
        let [instructions, allocations, unevenness] = columns(cost);
        let _ = writeln!(text, "{:<12}{instructions:>22}{allocations:>18}{unevenness:>18}", cost.graph);
    }
    text + "\n" + &sizes(&costs.sizes) + "\n" + &lines(missing)
}

/// Tables in Markdown.
pub fn markdown(rows: &[Row], costs: &Costs, missing: &[String]) -> String {
    let mut text = "| graph | hand, ns per tick | in times of that |\n|---|--:|---|\n".to_owned();
    for row in rows {
        let bold = |other: &Other| {
            if other.is_apex() { format!("**{}**", entry(other)) } else { entry(other) }
        };
        let others: Vec<String> = row.others.iter().map(bold).collect();
        let _ = writeln!(text, "| {} | {:.2} | {} |", row.graph, row.hand_ns, others.join(", "));
    }
    text.push_str("\n| Apex / by hand, per tick | instructions | allocations | p99.9 / p50 |\n|---|--:|--:|--:|\n");
    for cost in &costs.ticks {
        let _ = writeln!(text, "| {} | {} |", cost.graph, columns(cost).join(" | "));
    }
    text + "\n" + &sizes(&costs.sizes) + "\n" + &lines(missing)
}

fn entry(other: &Other) -> String {
    let ratio = match other.ratio {
        ratio if ratio < 10.0 => format!("{ratio:.2}"),
        ratio => format!("{ratio:.0}"),
    };
    format!("{} {ratio}{}", other.name, if other.equal { "" } else { " (WRONG)" })
}

fn columns(cost: &Cost) -> [String; 3] {
    let both = |[apex, hand]: Both<f64>, digits| format!("{apex:.digits$} / {hand:.digits$}");
    [
        cost.instructions.map_or_else(|| "no valgrind".to_owned(), |count| both(count, 2)),
        both(cost.allocations, 0),
        both(cost.unevenness, 2),
    ]
}

fn sizes(sizes: &Both<Size>) -> String {
    let size = |size: &Size| match size.memory {
        Some(memory) => format!("{} kB, {memory} kB of memory", size.file / 1000),
        None => format!("{} kB", size.file / 1000),
    };
    let [apex, hand] = sizes.each_ref().map(size);
    format!("A program of nothing but chain100, without symbols: Apex {apex}; by hand {hand}.\n")
}

fn lines(missing: &[String]) -> String {
    missing.iter().map(|line| format!("missing: {line}\n")).collect()
}
