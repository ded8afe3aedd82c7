//! `apex explain --profile`: longest measured times of clusters and slots, and the load of each thread.

use crate::{answer::Answer, project};
use apex_dsl::{
    analyse::Analysis,
    checked::CheckedProgram,
    graph::{Graph, MAIN_GROUP, NodeId},
};
use serde_json::{Value, json};
use std::{collections::BTreeMap, fmt::Write as _, fs, path::Path, process::ExitCode};

/// Maximum size of a profile in bytes.
const MAX_BYTES: u64 = 1 << 30;

/// Measured times of a node, in µs.
#[derive(Default)]
struct Measured {
    longest: f64,
    all: f64,
}

/// Measured times of a program.
struct Profile {
    program: String,
    nodes: BTreeMap<String, Measured>,
    /// Time from the first call to the end of the last one, in µs.
    span: f64,
}

/// Prints the times in `profile` of the program in `file`.
pub fn run(file: &Path, profile: &Path, answer: &mut Answer) -> Result<ExitCode, String> {
    let profile = read(profile).map_err(|reason| format!("cannot read `{}`: {reason}", profile.display()))?;
    let checked = project::check(file)?;
    answer.messages(&checked.diagnostics, &checked.sources);
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    let program = checked.programs.iter().find(|p| p.graph.name == profile.program);
    let program = program.ok_or_else(|| {
        let names: Vec<&str> = checked.programs.iter().map(|p| p.graph.name.as_str()).collect();
        format!("the profile is of `{}`, but `{}` has {}", profile.program, file.display(), names.join(", "))
    })?;
    answer.give(|| text(program, &profile), || json_of(program, &profile))?;
    Ok(ExitCode::SUCCESS)
}

fn read(path: &Path) -> Result<Profile, String> {
    let size = fs::metadata(path).map_err(|e| e.to_string())?;
    if !size.is_file() || size.len() > MAX_BYTES {
        return Err(format!("it is not a file of at most {MAX_BYTES} bytes"));
    }
    let text = fs::read_to_string(path).map_err(|e| e.to_string())?;
    let events: Vec<Value> =
        serde_json::from_str(&text).map_err(|e| format!("it was not written by `apex run --profile`: {e}"))?;
    let program = events.iter().find(|e| e["name"] == "process_name").and_then(|e| e["args"]["name"].as_str());
    let program = program.ok_or("it was not written by `apex run --profile`: it does not name a program")?.to_owned();
    let (mut nodes, mut first, mut last) = (BTreeMap::<String, Measured>::new(), f64::INFINITY, 0.0f64);
    for event in events.iter().filter(|e| e["ph"] == "X") {
        let (Some(name), Some(at), Some(took)) = (event["name"].as_str(), event["ts"].as_f64(), event["dur"].as_f64())
        else {
            continue;
        };
        let node = nodes.entry(name.to_owned()).or_default();
        node.longest = node.longest.max(took);
        node.all += took;
        (first, last) = (first.min(at), last.max(at + took));
    }
    Ok(Profile { program, nodes, span: (last - first).max(0.0) })
}

/// Load of one thread.
struct Thread<'a> {
    name: &'a str,
    /// Share of the time in which the thread worked, in percent.
    busy: f64,
    /// For each cluster that fires: its number, its nodes, and the sum of their longest calls in µs.
    clusters: Vec<(usize, Vec<String>, f64)>,
    /// Nodes of which only slots are called, with the longest call in µs.
    slots: Vec<(String, f64)>,
}

fn threads<'a>(program: &'a CheckedProgram, profile: &Profile) -> Vec<Thread<'a>> {
    let of = |name, graph, analysis| thread(name, graph, analysis, profile);
    match &program.split {
        None => vec![of(MAIN_GROUP, &program.graph, &program.analysis)],
        Some(split) => split.parts.iter().map(|part| of(&part.group, &part.graph, &part.analysis)).collect(),
    }
}

fn thread<'a>(name: &'a str, graph: &Graph, analysis: &Analysis, profile: &Profile) -> Thread<'a> {
    let measured = |node: NodeId| profile.nodes.get(&graph.path(node));
    let all: f64 = graph.nodes.ids().filter_map(|node| Some(measured(node)?.all)).sum();
    let clusters = analysis.clusters.iter_enumerated().filter(|(_, c)| c.fires).map(|(number, cluster)| {
        let nodes: Vec<NodeId> = cluster.schedule().into_iter().filter(|node| measured(*node).is_some()).collect();
        let longest = |node: &NodeId| measured(*node).map_or(0.0, |m| m.longest) * analysis.repetitions[*node] as f64;
        (number.index(), nodes.iter().map(|node| graph.path(*node)).collect(), nodes.iter().map(longest).sum())
    });
    let clusters: Vec<(usize, Vec<String>, f64)> = clusters.collect();
    let is_in_none = |node: &NodeId| !clusters.iter().any(|(_, nodes, _)| nodes.contains(&graph.path(*node)));
    let slots = graph.nodes.ids().filter(is_in_none);
    let slots = slots.filter_map(|node| Some((graph.path(node), measured(node)?.longest))).collect();
    Thread { name, busy: 100.0 * all / profile.span.max(f64::MIN_POSITIVE), clusters, slots }
}

fn text(program: &CheckedProgram, profile: &Profile) -> String {
    let mut text = format!("{}: {:.1} ms measured\n", profile.program, profile.span / 1e3);
    for thread in threads(program, profile) {
        let _ = writeln!(text, "  thread {}: {:.1} % of the time at work", thread.name, thread.busy);
        for (number, nodes, longest) in thread.clusters.iter().filter(|(_, nodes, _)| !nodes.is_empty()) {
            let _ = writeln!(text, "    cluster {number}: at worst {longest:.1} µs ({})", nodes.join(", "));
        }
        for (node, longest) in &thread.slots {
            let _ = writeln!(text, "    slots of {node}: at worst {longest:.1} µs a call");
        }
    }
    text.push_str("  at worst: the sum of the longest times of all nodes of the cluster\n");
    text
}

fn json_of(program: &CheckedProgram, profile: &Profile) -> Value {
    let threads = threads(program, profile).into_iter().map(|thread| {
        let clusters: Vec<Value> = thread
            .clusters
            .iter()
            .map(|(number, nodes, longest)| json!({ "cluster": number, "nodes": nodes, "worst_us": longest }))
            .collect();
        let slots: Vec<Value> =
            thread.slots.iter().map(|(node, longest)| json!({ "node": node, "worst_us": longest })).collect();
        json!({ "name": thread.name, "busy_percent": thread.busy, "clusters": clusters, "slots": slots })
    });
    json!({ "name": profile.program, "measured_us": profile.span, "threads": threads.collect::<Vec<Value>>() })
}
