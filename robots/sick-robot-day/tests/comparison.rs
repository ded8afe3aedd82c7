//! The numbers of `docs/competition.md`: statistics of both missions.

use apex_rt::{Info, Program as _};
use sick_robot_day::programs::{Competition, SdfCompetition};
use std::fmt::Write as _;

/// Source file of this robot.
macro_rules! text {
    ($name:literal) => {
        include_str!(concat!("../", $name, ".afg"))
    };
}

/// Items of a source file whose first lines have one of these beginnings.
fn items(text: &str, begins: &[&str]) -> String {
    let mut kept = String::new();
    let mut inside = false;
    for line in text.lines() {
        inside |= begins.iter().any(|begin| line.starts_with(begin));
        if inside {
            let _ = writeln!(kept, "{line}");
        }
        inside &= line != "}";
    }
    kept
}

/// Number of lines without comments and blank lines.
fn lines(text: &str) -> usize {
    text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//")).count()
}

/// Number of lines that begin with this word.
fn count(text: &str, word: &str) -> usize {
    text.lines().filter(|line| line.trim_start().starts_with(word)).count()
}

/// Numbers of nodes and connections of the mission with all nested graphs expanded.
fn opened(info: &Info) -> (usize, usize) {
    let is_state = |node: usize| info.kind(node).name == "state";
    let is_of = |node: &usize| info.nodes[*node].name.starts_with("mission.") && !is_state(*node);
    let nodes = (0..info.nodes.len()).filter(is_of).count();
    let connections = info.connections.iter().filter(|c| is_of(&c.from) || is_of(&c.to)).count();
    (nodes, connections)
}

#[test]
fn the_page_says_what_is_there() {
    let flow = [
        items(text!("mission"), &["graph Mission"]),
        items(text!("fetch"), &["graph"]),
        items(text!("deliver"), &["graph"]),
        items(text!("visit"), &["graph Visit"]),
        items(text!("start"), &["graph SetLamp"]),
    ]
    .concat();
    let machine = items(text!("sdf_mission"), &["fsm", "graph"]);
    let (flow_opened, machine_opened) = (opened(const { &Competition::INFO }), opened(const { &SdfCompetition::INFO }));
    let rows = [
        ("lines of its own", lines(&flow), lines(&machine)),
        ("nodes, as written", count(&flow, "node "), count(&machine, "node ")),
        ("nodes, opened", flow_opened.0, machine_opened.0),
        ("connections, opened", flow_opened.1, machine_opened.1),
        ("states of a machine", count(&flow, "state "), count(&machine, "state ")),
        ("transitions of a machine", count(&flow, "on "), count(&machine, "on ")),
    ];
    let table: Vec<String> =
        rows.iter().map(|(name, flow, machine)| format!("| {name} | {flow} | {machine} |")).collect();
    let page = include_str!("../../../docs/competition.md");
    for row in &table {
        assert!(page.contains(row), "the page should say\n{}", table.join("\n"));
    }
}
