//! Parts of a graph that have to run on one thread.

use super::pace::{self, synchronous};
use crate::{
    analyse::{Analysis, circles, has_rates},
    catalog::Catalog,
    graph::{Connection, Crossing, Graph, NodeId, NodeKind, PortId, ScopeId},
    report::{Diagnostic, Diagnostics},
};
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of thread groups: the runtime has a bit for each (`apex_rt::threads::MAX_GROUPS`).
const MAX_GROUPS: usize = 64;

/// Reports parts of the graph that are split over several thread groups but have to run on one thread.
pub fn check(graph: &Graph, analysis: &Analysis, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    for node in &graph.nodes {
        if let NodeKind::Each(each) = &node.kind {
            check_body(&each.body, diagnostics);
        }
    }
    let is_alone = !graph.has_several_groups();
    check_watch(graph, is_alone, diagnostics);
    if is_alone {
        return;
    }
    if graph.groups().len() > MAX_GROUPS {
        let message = format!("a program has at most {MAX_GROUPS} thread groups");
        diagnostics.push(Diagnostic::error("too-large", graph.span, message));
        return;
    }
    check_loops(graph, diagnostics);
    check_rates(graph, analysis, diagnostics);
    check_reset(graph, analysis, diagnostics);
    check_sides(graph, diagnostics);
    pace::check(graph, analysis, catalog, diagnostics);
}

/// Reports thread groups in the body of an `each`, which runs on the thread of the `each`.
fn check_body(body: &Graph, diagnostics: &mut Diagnostics) {
    for node in body.nodes.iter().filter(|n| n.modifiers.group.is_some()) {
        let message = format!("`{}` is in the body of an `each`, which runs on the thread of the `each`", node.name);
        let error = Diagnostic::error("threads", node.span, message);
        diagnostics.push(error.note("write `on` after the instance with `each`"));
    }
}

/// Reports watchdogs that cannot work: some thread must be watched, and the reaction to a hung node needs another
/// thread.
fn check_watch(graph: &Graph, is_alone: bool, diagnostics: &mut Diagnostics) {
    let Some(hung) = graph.nodes.position(|n| matches!(n.kind, NodeKind::Watchdog)) else { return };
    if graph.threads.iter().all(|t| t.hang.is_none()) {
        let error =
            Diagnostic::error("threads", graph.nodes[hung].span, "no thread is watched, so `hung` is never triggered");
        let note = "set in a `robot` how long a node may run: `thread main { hang = 500ms }`";
        diagnostics.push(error.note(note));
    }
    // An exit needs no thread: the watchdog itself ends the program.
    let is_called = |c: &&Connection| c.from.node == hung && !matches!(graph.nodes[c.to.node].kind, NodeKind::Exit(_));
    for c in graph.connections.iter().filter(is_called).filter(|_| is_alone) {
        let node = graph.path(c.to.node);
        let message = format!("`{node}` runs on the thread that hangs, where it cannot be called");
        let error = Diagnostic::error("threads", c.span, message);
        diagnostics.push(error.note(format!("run `{node}` on its own thread with `on`, or connect `hung` to `abort`")));
    }
}

fn groups(graph: &Graph, from: NodeId, to: NodeId) -> String {
    let (a, b) = (graph.group(from), graph.group(to));
    format!("`{}` runs on thread `{a}`, `{}` on `{b}`", graph.path(from), graph.path(to))
}

/// Reports loops over several groups: the delays of a loop send when an iteration begins, which one thread has to
/// decide.
fn check_loops(graph: &Graph, diagnostics: &mut Diagnostics) {
    let circle = circles(graph);
    for c in synchronous(graph).filter(|c| circle[c.from.node] == circle[c.to.node]) {
        let message = "a cycle of synchronous connections cannot cross threads";
        let error = Diagnostic::error("threads", c.span, message).note(groups(graph, c.from.node, c.to.node));
        diagnostics.push(error.note("run all nodes of the cycle on one thread, or break the cycle with a slot"));
    }
}

/// Reports connections from a region with several rates to another group: its code neither waits for cells nor fills
/// them.
fn check_rates(graph: &Graph, analysis: &Analysis, diagnostics: &mut Diagnostics) {
    // A region may be divided among groups: only the parts with several rates are restricted.
    let part = |node: NodeId| (analysis.regions[node], graph.group(node));
    let parts: BTreeSet<_> = graph.nodes.ids().filter(|n| has_rates(graph, analysis, *n)).map(part).collect();
    let is_within = |node: NodeId| parts.contains(&part(node));
    for c in synchronous(graph).filter(|c| is_within(c.from.node) || is_within(c.to.node)) {
        let message =
            "a region with several rates must run on one thread, together with all nodes that it is connected to";
        let error = Diagnostic::error("threads", c.span, message).note(groups(graph, c.from.node, c.to.node));
        diagnostics
            .push(error.note("to pass the token to another thread, send it to a slot, for example that of a `Hold`"));
    }
}

/// Reports active nodes outside the group of a `reset` or `cancel`, which takes their activity away at once.
fn check_reset(graph: &Graph, analysis: &Analysis, diagnostics: &mut Diagnostics) {
    let reset = graph.nodes.position(|n| matches!(n.kind, NodeKind::Reset));
    let reset = reset.map(|reset| (reset, "reset".to_owned(), analysis.active.iter().copied().collect()));
    let cancel = |interrupt: NodeId| graph.end_name(PortId { node: interrupt, port: 0 });
    let cancels = graph.interrupts().map(|interrupt| (interrupt.node, cancel(interrupt.node), interrupt.takes));
    let takers: Vec<(NodeId, String, Vec<NodeId>)> = reset.into_iter().chain(cancels).collect();
    for (taker, name, nodes) in takers {
        let own = graph.group(taker);
        for node in nodes.into_iter().filter(|n| analysis.active.contains(n) && graph.group(*n) != own) {
            let message = format!(
                "`{name}` takes activity away at once, but `{}` runs on thread `{}`, and `{name}` on `{own}`",
                graph.path(node),
                graph.group(node)
            );
            let error = Diagnostic::error("threads", graph.nodes[node].span, message);
            diagnostics.push_once(error.note("run all nodes from which it takes activity on one thread"));
        }
    }
}

/// Reports nested graphs whose inputs (or outputs) belong to several groups: one thread takes (or sends) them together.
fn check_sides(graph: &Graph, diagnostics: &mut Diagnostics) {
    let mut first: BTreeMap<(ScopeId, bool), NodeId> = BTreeMap::new();
    for c in graph.connections.iter().filter(|c| graph.is_synchronous(c)) {
        let sides = c.crossings.iter().map(|side| match side {
            Crossing::Enter(scope) => (*scope, true, c.to.node),
            Crossing::Leave(scope) => (*scope, false, c.from.node),
        });
        for (scope, enters, node) in sides {
            let before = *first.entry((scope, enters)).or_insert(node);
            if graph.group(before) == graph.group(node) {
                continue;
            }
            let what = if enters { "takes all its inputs" } else { "sends all its outputs" };
            let message = format!("`{}` {what} together, which is impossible on two threads", graph.scope_path(scope));
            let error = Diagnostic::error("threads", c.span, message).note(groups(graph, before, node));
            diagnostics.push(error.note("run the nodes at its ports on one thread"));
        }
    }
}
