//! Activity that never arrives, or never leaves.

use crate::{
    analyse::{active_nodes, active_nodes_within, successors, takes_activity},
    catalog::Catalog,
    graph::{ClaimKind, Connection, ConnectionId, Flow, Graph, NodeId, NodeKind, Standard, Subject, WireEnd},
    index::IdVec,
    report::{Diagnostic, Diagnostics},
    source::Span,
};
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of nodes that a message names.
const MAX_NAMED: usize = 5;

/// Reports nodes whose active connections can never carry activity, and nodes that keep activity although they seem
/// meant to pass it on. Of several nodes that wait for one another only the first is named.
pub fn check_activity(graph: &Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    if graph.is_body || graph.is_open {
        return;
    }
    // A robot is never nested, whereas another graph may receive activity from the graph around it.
    let reached = if graph.robot { active_nodes(graph) } else { active_nodes_within(graph) };
    let (waiting, stuck) = (waiting(graph, catalog, &reached), stuck(graph, &reached));
    // A missing arrow makes timeouts and claims behind it idle, too: it is reported alone.
    if waiting.is_empty() {
        let idle = waits_in_vain(graph, catalog, &reached);
        idle.iter().for_each(|node| diagnostics.push(never_timed_out(graph, *node)));
        if idle.is_empty() {
            check_claims(graph, &reached, diagnostics);
        }
    }
    let mut check = Check { graph, reached, waiting, stuck, next: successors(graph) };
    check.report_gaps(diagnostics);
    check.report_waiting(diagnostics);
    for (node, first) in check.stuck {
        let name = graph.path(node);
        let message = format!("activity that enters `{name}` can never leave: all its outgoing connections are `->`");
        let warning = Diagnostic::warning("never-leaves", graph.nodes[node].span, message)
            .also(graph.connections[first].span, "for example this one")
            .note("write `=>` where activity should continue");
        diagnostics.push(warning.inside(graph.scope_path(graph.nodes[node].scope)));
    }
}

/// Nodes whose `timeout` never comes although it leads somewhere: activity never reaches them, and they send nothing on
/// their own.
fn waits_in_vain(graph: &Graph, catalog: &Catalog, reached: &BTreeSet<NodeId>) -> Vec<NodeId> {
    let is_source = |node: NodeId| match &graph.nodes[node].kind {
        NodeKind::Library(library) => {
            let is_input = |c: &Connection| c.to.node == node && graph.flow(c) != Flow::ToSlot;
            let signature = &catalog.signatures[library.signature];
            (signature.is_function || signature.process.is_some()) && !graph.connections.iter().any(is_input)
        }
        _ => false,
    };
    let waits = |node: NodeId| {
        let n = &graph.nodes[node];
        n.modifiers.timeout.is_some() && n.standard(Standard::Timeout).is_some()
    };
    graph.nodes.ids().filter(|node| waits(*node) && !reached.contains(node) && !is_source(*node)).collect()
}

fn never_timed_out(graph: &Graph, node: NodeId) -> Diagnostic {
    let (name, n) = (graph.path(node), &graph.nodes[node]);
    let message = format!("`{name}` is never activated: its `timeout` never comes");
    let note = format!("write `start => {};`, or connect an active node to it by `=>`", n.name);
    Diagnostic::warning("never-activated", n.span, message).note(note).inside(graph.scope_path(n.scope))
}

/// Reports claims that hold because what they are about is never active.
fn check_claims(graph: &Graph, reached: &BTreeSet<NodeId>, diagnostics: &mut Diagnostics) {
    let is_reached = |subject: Subject| graph.nodes_of(subject).iter().any(|node| reached.contains(node));
    for claim in &graph.claims {
        // A `reaches` whose end is never active is wrong.
        let meant = match claim.kind {
            ClaimKind::Reaches => &claim.of[..1],
            ClaimKind::Exclusive | ClaimKind::Conserved | ClaimKind::Live => &claim.of,
        };
        let Some(idle) = meant.iter().find(|subject| !is_reached(**subject)) else { continue };
        let (claimed, name) = (graph.claim_text(claim), graph.subject_name(*idle));
        let message = format!("`{claimed}` says nothing about `{name}`, which is never activated");
        let note = format!("write `start => {name};`, or connect an active node to it by `=>`");
        diagnostics.push_once(Diagnostic::warning("never-activated", claim.span, message).note(note));
    }
}

/// Nodes with outgoing `=>` that activity never reaches, each with the first of these connections.
fn waiting(graph: &Graph, catalog: &Catalog, reached: &BTreeSet<NodeId>) -> BTreeMap<NodeId, ConnectionId> {
    let mut waiting = BTreeMap::new();
    for (index, c) in graph.connections.iter_enumerated() {
        let node = c.from.node;
        // A node that deactivates others needs no activity of its own for that.
        let takes_away = takes_activity(graph, catalog, node);
        // Activity enters a delay only to go on from there: the delay itself is checked instead.
        let counts = c.active && !graph.nodes[c.to.node].is_delay() && !takes_away;
        if counts && graph.can_hold_activity(node) && !reached.contains(&node) {
            let first = waiting.entry(node).or_insert(index);
            if c.span < graph.connections[*first].span {
                *first = index;
            }
        }
    }
    waiting
}

/// Nodes that activity reaches and never leaves although they send tokens, each with an outgoing connection.
fn stuck(graph: &Graph, reached: &BTreeSet<NodeId>) -> BTreeMap<NodeId, ConnectionId> {
    let mut stuck = BTreeMap::new();
    let mut passes = BTreeSet::new();
    for (index, c) in graph.connections.iter_enumerated() {
        if c.active {
            passes.insert(c.from.node);
        } else if reached.contains(&c.from.node) {
            stuck.entry(c.from.node).or_insert(index);
        }
    }
    // Activity also leaves nodes that are cancelled.
    let is_called = |node: NodeId| graph.connections.iter().any(|c| c.to.node == node);
    let cancelled = graph.interrupts().filter(|interrupt| is_called(interrupt.node));
    let cancelled: BTreeSet<NodeId> = cancelled.flat_map(|interrupt| interrupt.takes).collect();
    stuck.retain(|node, _| {
        !passes.contains(node) && !cancelled.contains(node) && graph.nodes[*node].interrupts().is_none()
    });
    stuck
}

struct Check<'a> {
    graph: &'a Graph,
    /// Nodes that activity reaches.
    reached: BTreeSet<NodeId>,
    /// Nodes that wait for activity, with a connection that never carries any.
    waiting: BTreeMap<NodeId, ConnectionId>,
    /// Nodes that keep activity, with a connection that could have carried it on.
    stuck: BTreeMap<NodeId, ConnectionId>,
    next: IdVec<NodeId, Vec<NodeId>>,
}

impl<'a> Check<'a> {
    /// Reports each `->` that leads from `start`, or from a node that keeps its activity, to nodes that wait for
    /// activity: presumably `=>` was meant.
    fn report_gaps(&mut self, diagnostics: &mut Diagnostics) {
        let graph = self.graph;
        for c in graph.connections.iter().filter(|c| !c.active) {
            let begins = matches!(graph.nodes[c.from.node].kind, NodeKind::Start);
            if self.waiting.is_empty() || !(begins || self.stuck.contains_key(&c.from.node)) {
                continue;
            }
            if self.behind(c.to.node).iter().any(|node| self.waiting.contains_key(node)) {
                self.stuck.remove(&c.from.node);
                self.close(c, diagnostics);
            }
        }
    }

    /// Reports a `->` that should be `=>`, and continues as if it were one in every instance of its graph.
    fn close(&mut self, c: &Connection, diagnostics: &mut Diagnostics) {
        let mut named = self.behind(c.to.node);
        named.retain(|node| self.waiting.contains_key(node));
        diagnostics.push(self.gap(c, &named));
        for other in self.graph.connections.iter().filter(|other| other.span == c.span) {
            self.next[other.from.node].push(other.to.node);
        }
        let behind = self.behind(c.to.node);
        self.waiting.retain(|node, _| !behind.contains(node));
    }

    /// The node and all nodes that activity reaches from it.
    fn behind(&self, node: NodeId) -> BTreeSet<NodeId> {
        let (mut found, mut open) = (BTreeSet::new(), vec![node]);
        while let Some(node) = open.pop() {
            if found.insert(node) {
                open.extend(&self.next[node]);
            }
        }
        found
    }

    fn gap(&self, c: &Connection, behind: &BTreeSet<NodeId>) -> Diagnostic {
        let graph = self.graph;
        let first = if behind.contains(&c.to.node) { c.to.node } else { *behind.iter().next().unwrap_or(&c.to.node) };
        let others: Vec<String> =
            behind.iter().filter(|n| **n != first).map(|n| format!("`{}`", graph.path(*n))).collect();
        let (from, to) = (graph.path(c.from.node), graph.path(first));
        let message = format!("`{to}` is never activated: this `->` does not pass on the activity of `{from}`");
        let arrow = arrow(graph, c);
        let warning = Diagnostic::warning("never-activated", arrow, message);
        let warning = match others.len() {
            0 => warning,
            1 => warning.note(format!("{} is never activated either", others[0])),
            n if n > MAX_NAMED => warning.note(format!(
                "{} and {} more nodes are never activated either",
                others[..MAX_NAMED].join(", "),
                n - MAX_NAMED
            )),
            _ => warning.note(format!("{} are never activated either", others.join(", "))),
        };
        let warning = warning.guess("let activity pass", arrow, "=>");
        warning.inside(graph.scope_path(graph.nodes[c.from.node].scope))
    }

    /// Reports the nodes that wait for activity, except those that only wait for other waiting nodes.
    fn report_waiting(&mut self, diagnostics: &mut Diagnostics) {
        // Nodes without a waiting predecessor come first, then one node of each cycle.
        let covered: BTreeSet<NodeId> = self
            .waiting
            .keys()
            .flat_map(|node| self.next[*node].iter().filter(move |next| *next != node).copied())
            .collect();
        let (later, first): (Vec<NodeId>, Vec<NodeId>) = self.waiting.keys().partition(|node| covered.contains(node));
        for nodes in [first, later] {
            // A missing arrow is reported once, although it is missing in every instance of its graph.
            for node in &nodes {
                if let Some(c) = self.only_way(*node).filter(|_| self.waiting.contains_key(node)) {
                    self.close(c, diagnostics);
                }
            }
            for node in nodes {
                if self.waiting.contains_key(&node) {
                    diagnostics.push(self.never_activated(node));
                    let behind = self.behind(node);
                    self.waiting.retain(|node, _| !behind.contains(node));
                }
            }
        }
    }

    /// The connection over which a waiting node takes tokens from a node with activity, if there is exactly one.
    fn only_way(&self, node: NodeId) -> Option<&'a Connection> {
        let graph: &'a Graph = self.graph;
        let mut ways = graph.connections.iter().filter(|c| c.to.node == node && self.reached.contains(&c.from.node));
        let (only, None) = (ways.next()?, ways.next()) else { return None };
        Some(only)
    }

    fn never_activated(&self, node: NodeId) -> Diagnostic {
        let graph = self.graph;
        let c = &graph.connections[self.waiting[&node]];
        let held = graph.connections.iter().find(|c| c.to.node == node).filter(|_| graph.nodes[node].is_delay());
        let node = held.map_or(node, |c| c.from.node);
        let message = format!("`{}` is never activated: this `=>` never carries activity", graph.path(node));
        let from = graph.connections.iter().find(|c| c.active && c.to.node == node).map(|c| graph.path(c.from.node));
        let warning = Diagnostic::warning("never-activated", c.span, message).note(match from {
            Some(from) => format!("activity would have to come from `{from}`, which is never activated either"),
            None => format!(
                "activity begins at `start`: write `start => {};`, or connect an active node to it by `=>`",
                graph.path(node)
            ),
        });
        warning.inside(graph.scope_path(graph.nodes[node].scope))
    }
}

/// The arrow that stops activity on a connection. One that leads through ports of nested graphs has several arrows.
fn arrow(graph: &Graph, c: &Connection) -> Span {
    let (mut open, mut seen) = (vec![(WireEnd::Port(c.to), None)], BTreeSet::new());
    while let Some((place, arrow)) = open.pop() {
        if place == WireEnd::Port(c.from) {
            return arrow.unwrap_or(c.span);
        }
        for wire in graph.wires.iter().filter(|wire| wire.to == place) {
            if seen.insert((wire.from, wire.to)) {
                open.push((wire.from, if wire.active { arrow } else { Some(wire.span) }));
            }
        }
    }
    c.span
}
