//! Costs of large graphs of one kind for rustc: lines of generated code, and CPU time of a release build.

use super::{
    commands::{cargo, cpu_seconds, output},
    edited::Edited,
};
use crate::report::met;
use std::{fmt::Write as _, path::Path, process::Command};

/// Numbers of nodes.
const SIZES: [usize; 2] = [300, 1000];
/// Goal: CPU time of rustc for 1000 nodes, in s.
const CPU: f64 = 5.0;

/// Nodes of one kind, and their connections.
struct Kind {
    name: &'static str,
    /// Goal: generated lines per node.
    lines: f64,
    text: fn(usize) -> String,
}

const KINDS: [Kind; 5] = [
    Kind { name: "chain", lines: 5.0, text: chain },
    Kind { name: "events", lines: 12.0, text: events },
    Kind { name: "timers", lines: 10.0, text: timers },
    Kind { name: "timeouts", lines: 15.0, text: timeouts },
    Kind { name: "activity", lines: 15.0, text: activity },
];

/// Measures and prints all kinds.
pub fn run(apex: &Path, root: &Path) -> Result<(), String> {
    const BUILD: [&str; 7] = ["build", "--quiet", "--release", "-p", "apex-bench", "--example", "growth"];
    cargo(root, &BUILD)?;
    println!("{:<9} {:>5} {:>10} {:>5} {:>6} {:>5}", "", "nodes", "lines/node", "goal", "CPU s", "goal");
    for kind in &KINDS {
        for nodes in SIZES {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/growth.afg");
            let edited = Edited::new(path.clone(), |_| (kind.text)(nodes))?;
            let code = output(Command::new(apex).arg("expand").arg(&path))?;
            let lines = code.lines().count() as f64 / nodes as f64;
            let before = cpu_seconds()?;
            cargo(root, &BUILD)?;
            let cpu = cpu_seconds()? - before;
            drop(edited);
            let reached = met(lines <= kind.lines && cpu <= CPU);
            println!("{:<9} {nodes:>5} {lines:>10.1} {:>5} {cpu:>6.1} {CPU:>5} {reached}", kind.name, kind.lines);
        }
    }
    Ok(())
}

/// A graph; `line` writes the lines of each node.
fn graph(nodes: usize, first: &str, line: impl Fn(&mut String, usize)) -> String {
    let mut text = format!("use apex_bench::nodes::{{Count, Pass, Silent, Sink, op}};\n\ngraph Growth {{\n{first}");
    (0..nodes).for_each(|node| line(&mut text, node));
    text + "}\n"
}

fn chain(nodes: usize) -> String {
    let ends = format!("    node n0 = Count();\n    node sink = Sink();\n    n{nodes} -> sink;\n");
    graph(nodes, &ends, |text, i| {
        let _ = writeln!(text, "    node n{} = op(k = {i});\n    n{i} -> n{}.x;", i + 1, i + 1);
    })
}

fn events(nodes: usize) -> String {
    graph(nodes, "    node n0 = Pass();\n    start -> n0.put;\n", |text, i| {
        let _ = writeln!(text, "    node n{} = Pass();\n    n{i}.passed -> n{}.put;", i + 1, i + 1);
    })
}

fn timers(nodes: usize) -> String {
    graph(nodes, "", |text, i| {
        let _ = writeln!(text, "    node n{i} = Silent() every {}ms;", 10 + i);
    })
}

fn timeouts(nodes: usize) -> String {
    graph(nodes, "    start => n0.enable;\n", |text, i| {
        let _ = writeln!(
            text,
            "    node n{i} = Pass() timeout {}s;\n    n{i}.timeout => n{}.enable;",
            i + 1,
            (i + 1) % nodes
        );
    })
}

/// A ring in which one symbol goes to all nodes.
fn activity(nodes: usize) -> String {
    graph(nodes, "    slot symbol;\n    start => n0.enable;\n", |text, i| {
        let next = (i + 1) % nodes;
        let _ = writeln!(text, "    node n{i} = Pass();\n    symbol -> n{i}.put;\n    n{i}.passed => n{next}.enable;");
    })
}
