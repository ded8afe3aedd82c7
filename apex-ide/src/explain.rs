//! Report of the compiler's decisions, as text and as JSON.

use apex_dsl::{
    analyse::{Analysis, Block, ClusterId, Run, Step},
    catalog::{Catalog, SignatureId},
    checked::CheckedProgram,
    claims::Decided,
    graph::{Flow, Graph, Node, NodeId, NodeKind, PortId},
    machine::{self, Machines},
    program::{Storage, storage},
    resolve::Link,
    source::{Sources, Span},
    syntax::tree::PortKind,
    threads::Split,
};
use serde_json::{Value, json};
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::Write as _,
};

/// Regions, guards, clusters, schedule, rates, pruning and memory of a program, as text.
pub fn explain(program: &CheckedProgram, machines: &Machines, catalog: &Catalog) -> String {
    let mut text = String::new();
    let kind = if program.graph.robot { "robot" } else { "graph" };
    let _ = writeln!(text, "{kind} {}", program.graph.name);
    match &program.split {
        None => section(&mut text, &program.graph, &program.analysis, &program.claims, catalog, 0),
        Some(split) => threads(&mut text, program, split, catalog),
    }
    let used: BTreeSet<SignatureId> = program.graph.nodes.iter().filter_map(signature).collect();
    for machine in used.iter().filter_map(|signature| machines.get(signature)) {
        text.push_str(&machine::translation(machine));
    }
    text
}

/// Connections that `.*` makes in a source file, by line; empty if there are none.
pub fn by_name(links: &[Link], sources: &Sources) -> String {
    let mut lines: BTreeMap<Span, Vec<String>> = BTreeMap::new();
    for link in links.iter().filter(|link| link.by_name) {
        lines.entry(link.arrow).or_default().push(format!("{} -> {}", link.from.name, link.to.name));
    }
    let mut text = String::new();
    for (arrow, connections) in &lines {
        let line = sources.line_column(arrow.file, arrow.start).0;
        let _ = writeln!(text, "  line {line}");
        connections.iter().for_each(|connection| _ = writeln!(text, "    {connection}"));
    }
    if text.is_empty() { text } else { format!("connections by name\n{text}") }
}

/// Writes the contents of each thread group, and the cells between them.
fn threads(text: &mut String, program: &CheckedProgram, split: &Split, catalog: &Catalog) {
    for part in &split.parts {
        let _ = writeln!(text, "  thread {}", part.group);
        section(text, &part.graph, &part.analysis, &Decided::default(), catalog, 1);
    }
    let _ = writeln!(text, "  cells between threads, with room for one token each");
    for cell in &split.cells {
        let from = cell.sender.map_or("outside", |sender| split.parts[sender].group.as_str());
        let (port, to) = (program.graph.end_name(cell.from), &split.parts[cell.receiver].group);
        let _ = writeln!(text, "    {port}: from {from} to {to}");
    }
    claims(text, &program.graph, &program.claims, "  ");
}

fn signature(node: &Node) -> Option<SignatureId> {
    if let NodeKind::Library(library) = &node.kind { Some(library.signature) } else { None }
}

/// Writes the asynchronous connections in the order of the source, and for how long each one is occupied by a token.
fn asynchronous(text: &mut String, graph: &Graph, analysis: &Analysis, pad: &str) {
    for (index, c) in graph.connections.iter_enumerated().filter(|(_, c)| !graph.is_synchronous(c)) {
        let how = match (graph.flow(c), analysis.asynchronous.may_block[index]) {
            _ if is_cell(graph, c.to.node) => "occupied until the other thread has processed the token",
            (Flow::ToInput, _) => "occupied until the region downstream has finished",
            (_, true) => "occupied until the slot can be served",
            (_, false) => "served at once",
        };
        let _ = writeln!(text, "{pad}  {}: {how}", graph.connection_text(index));
    }
}

fn section(text: &mut String, graph: &Graph, analysis: &Analysis, decided: &Decided, catalog: &Catalog, indent: usize) {
    let pad = "  ".repeat(indent + 1);
    let regions: BTreeSet<usize> = analysis.regions.iter().copied().collect();
    let _ = writeln!(
        text,
        "{pad}{} nodes, {} connections, {} regions, {} clusters",
        graph.nodes.len(),
        graph.connections.len(),
        regions.len(),
        analysis.clusters.len()
    );
    let periods = analysis.real_periods(graph);
    for (index, cluster) in analysis.clusters.iter_enumerated() {
        let guards: Vec<String> = cluster.own_guards.iter().map(|g| analysis.guards[*g].text(graph)).collect();
        let upstream: Vec<String> = cluster.upstream.iter().map(|c| format!("cluster {}", c.index())).collect();
        let waits = guards.into_iter().chain(upstream).collect::<Vec<_>>().join(", ");
        let waits = if waits.is_empty() { "nothing".to_owned() } else { waits };
        let never = if cluster.fires { "" } else { ", and never fires: some of these never arrive" };
        let period = periods[index].map(|period| format!(", every {period:?}"));
        let _ = writeln!(
            text,
            "{pad}cluster {} (region {}) waits for {waits}{}{never}",
            index.index(),
            cluster.region,
            period.unwrap_or_default()
        );
        if !graph.is_body && cluster.fires && cluster.upstream.is_empty() {
            let steps = match analysis.steps_after(graph, index) {
                Some(1) => "it is the only step until it is notified".to_owned(),
                Some(steps) => format!("at most {steps} steps until all its effects have finished"),
                None => "event cycle: the number of steps is unbounded".to_owned(),
            };
            let _ = writeln!(text, "{pad}  {steps}");
        }
        steps(text, graph, &cluster.block, indent + 2);
    }
    for silence in &analysis.silences {
        let nodes: Vec<String> = silence.nodes.iter().map(|node| graph.path(*node)).collect();
        let guard = analysis.guards[silence.guard].text(graph);
        let _ = writeln!(text, "{pad}silence of {guard}: ⊥ takes its place after the time of {}", nodes.join(", "));
    }
    if graph.connections.iter().any(|c| !graph.is_synchronous(c)) {
        let _ = writeln!(text, "{pad}asynchronous connections");
        asynchronous(text, graph, analysis, &pad);
        if analysis.asynchronous.endless {
            let _ = writeln!(
                text,
                "{pad}  tokens can circulate endlessly within one reaction: the number of its steps is limited"
            );
        }
    }
    let _ = writeln!(text, "{pad}pruning");
    let width = graph.nodes.ids().map(|n| graph.path(n).len()).max().unwrap_or(0);
    for node in graph.nodes.ids().filter(|node| !is_cell(graph, *node)) {
        let skipped: Vec<String> = skipped(graph, analysis, node).into_iter().map(|n| graph.path(n)).collect();
        let words = characteristics(analysis, node);
        let words = if words.is_empty() { "-".to_owned() } else { words.join(", ") };
        let skips =
            if skipped.is_empty() { String::new() } else { format!("  ⊥ from it skips {}", shortened(&skipped)) };
        let _ = writeln!(text, "{pad}  {:width$}  {words}{skips}", graph.path(node));
    }
    let _ = writeln!(text, "{pad}memory besides the state of the nodes");
    let kept = kept(graph, analysis, catalog);
    for (end, what) in &kept {
        let _ = writeln!(text, "{pad}  {}: {what} of `{}`", graph.end_name(*end), graph.port(*end).ty);
    }
    if kept.is_empty() {
        let _ = writeln!(text, "{pad}  none: all tokens are locals");
    }
    claims(text, graph, decided, &pad);
    for (node, body) in &analysis.bodies {
        if let NodeKind::Each(each) = &graph.nodes[*node].kind {
            let _ = writeln!(text, "{pad}each {} ({})", graph.path(*node), each.body.name);
            section(text, &each.body, body, &Decided::default(), catalog, indent + 1);
        }
    }
}

/// Returns `true` for an end of a cell to another thread group.
fn is_cell(graph: &Graph, node: NodeId) -> bool {
    matches!(graph.nodes[node].kind, NodeKind::Sender(_) | NodeKind::Receiver(_))
}

/// Writes the verdict on each claim, and the number of states that were visited for it.
fn claims(text: &mut String, graph: &Graph, decided: &Decided, pad: &str) {
    if decided.verdicts.is_empty() {
        return;
    }
    let _ = writeln!(text, "{pad}claims ({} states of activity searched)", decided.states);
    for (claim, verdict) in graph.claims.iter().zip(&decided.verdicts) {
        let _ = writeln!(text, "{pad}  {}: {}", graph.claim_text(claim), verdict.words());
    }
}

/// The first few names, and the number of the others.
fn shortened(names: &[String]) -> String {
    const SHOWN: usize = 8;
    let shown = names.iter().take(SHOWN).cloned().collect::<Vec<_>>().join(", ");
    if names.len() > SHOWN { format!("{shown} and {} more", names.len() - SHOWN) } else { shown }
}

fn steps(text: &mut String, graph: &Graph, block: &Block, indent: usize) {
    let pad = "  ".repeat(indent);
    for step in &block.steps {
        match step {
            Step::Fire(node) => {
                let _ = writeln!(text, "{pad}{}", graph.path(*node));
            }
            Step::Repeat(Run { node, from, to }) => {
                let times = if to - from == 1 { String::new() } else { format!(" × {}", to - from) };
                let _ = writeln!(text, "{pad}{}{times}", graph.path(*node));
            }
            Step::Block(inner) => {
                let tokens: Vec<String> = inner.opens.iter().map(|end| graph.end_name(*end)).collect();
                let _ = writeln!(text, "{pad}if {}", tokens.join(" and "));
                steps(text, graph, inner, indent + 1);
            }
        }
    }
}

fn characteristics(analysis: &Analysis, node: NodeId) -> Vec<&'static str> {
    let c = analysis.characteristics[node];
    [(c.essential, "essential"), (c.required, "required"), (c.siblings, "has siblings"), (c.joins, "joins")]
        .into_iter()
        .filter(|(on, _)| *on)
        .map(|(_, word)| word)
        .collect()
}

/// The nodes that do not fire if `node` sends ⊥ on all its outputs.
fn skipped(graph: &Graph, analysis: &Analysis, node: NodeId) -> Vec<NodeId> {
    let own = |end: &PortId| end.node == node;
    let mut skipped: BTreeSet<NodeId> = BTreeSet::new();
    for &next in &analysis.order {
        let clock = &analysis.clocks[next];
        if next != node
            && clock.iter().any(|end| own(end) || skipped.contains(&end.node))
            && !matches!(graph.nodes[next].kind, NodeKind::Boundary(_))
        {
            skipped.insert(next);
        }
    }
    skipped.into_iter().collect()
}

/// Tokens that outlive a firing of their cluster, or that a node writes in place.
fn kept(graph: &Graph, analysis: &Analysis, catalog: &Catalog) -> Vec<(PortId, String)> {
    let mut kept = vec![];
    for (node, n) in graph.nodes.iter_enumerated() {
        for port in
            (0..n.ports.len()).filter(|p| n.ports[*p].kind == PortKind::Output && n.ports[*p].parameter.is_none())
        {
            let end = PortId { node, port };
            let crosses = graph
                .connections
                .iter()
                .any(|c| c.from == end && analysis.cluster_of[c.to.node] != analysis.cluster_of[node]);
            let rate = graph.port(end).rate as u64 * analysis.repetitions[node];
            match (&n.kind, storage(graph, catalog, end)) {
                (NodeKind::Delay(initial), _) => kept.push((end, format!("a delay of {}", initial.len()))),
                (_, Storage::Buffer) => kept.push((end, "a buffer written in place".to_owned())),
                (_, Storage::Argument) => {}
                _ if crosses => kept.push((end, "a token between clusters".to_owned())),
                _ if rate > 1 => kept.push((end, format!("{rate} tokens on the stack"))),
                _ => {}
            }
        }
    }
    kept
}

/// The report of [`explain`] as JSON, without the state machines.
pub fn explain_json(program: &CheckedProgram, catalog: &Catalog) -> Value {
    let mut whole = object(&program.graph, &program.analysis, &program.claims, catalog);
    if let Some(split) = &program.split {
        let threads = split
            .parts
            .iter()
            .map(|part| (part.group.clone(), object(&part.graph, &part.analysis, &Decided::default(), catalog)));
        whole["threads"] = Value::Object(threads.collect());
    }
    whole
}

fn object(graph: &Graph, analysis: &Analysis, decided: &Decided, catalog: &Catalog) -> Value {
    let nodes: Vec<Value> = graph
        .nodes
        .ids()
        .map(|node| {
            let c = analysis.characteristics[node];
            let clock: Vec<String> = analysis.clocks[node].iter().map(|end| graph.end_name(*end)).collect();
            let skips: Vec<String> = skipped(graph, analysis, node).into_iter().map(|n| graph.path(n)).collect();
            json!({
                "name": graph.path(node), "region": analysis.regions[node], "cluster": analysis.cluster_of[node].index(),
                "repetitions": analysis.repetitions[node], "essential": c.essential, "required": c.required,
                "siblings": c.siblings, "joins": c.joins, "fires_if": clock, "skips": skips,
            })
        })
        .collect();
    let clusters: Vec<Value> = analysis
        .clusters
        .iter()
        .map(|c| {
            let guards: Vec<String> = c.own_guards.iter().map(|g| analysis.guards[*g].text(graph)).collect();
            let schedule: Vec<String> = c.schedule().into_iter().map(|n| graph.path(n)).collect();
            json!({ "region": c.region, "guards": guards, "upstream": numbers(&c.upstream), "downstream": numbers(&c.downstream), "schedule": schedule, "steps": step_list(graph, &c.block) })
        })
        .collect();
    let memory: Vec<Value> = kept(graph, analysis, catalog)
        .into_iter()
        .map(|(end, what)| json!({ "port": graph.end_name(end), "what": what, "type": graph.port(end).ty.to_string() }))
        .collect();
    let bodies: serde_json::Map<String, Value> = analysis
        .bodies
        .iter()
        .filter_map(|(node, body)| match &graph.nodes[*node].kind {
            NodeKind::Each(each) => Some((graph.path(*node), object(&each.body, body, &Decided::default(), catalog))),
            _ => None,
        })
        .collect();
    let claims: Vec<Value> = graph
        .claims
        .iter()
        .zip(&decided.verdicts)
        .map(|(claim, verdict)| json!({ "claim": graph.claim_text(claim), "verdict": verdict.words() }))
        .collect();
    json!({
        "name": graph.name, "nodes": nodes, "clusters": clusters, "memory": memory, "each": bodies,
        "claims": claims, "claim_states": decided.states,
    })
}

fn numbers(clusters: &BTreeSet<ClusterId>) -> Vec<usize> {
    clusters.iter().map(|cluster| cluster.index()).collect()
}

fn step_list(graph: &Graph, block: &Block) -> Value {
    let steps = block.steps.iter().map(|step| match step {
        Step::Fire(node) => json!(graph.path(*node)),
        Step::Repeat(Run { node, from, to }) => json!({ "node": graph.path(*node), "times": to - from }),
        Step::Block(inner) => json!({ "if": inner.opens.iter().map(|end| graph.end_name(*end)).collect::<Vec<_>>(), "then": step_list(graph, inner) }),
    });
    steps.collect()
}
