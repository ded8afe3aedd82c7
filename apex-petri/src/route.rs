//! Connections cut into legs at the boundaries of nested graphs, and the loops of a graph.

use apex_dsl::{
    graph::{ConnectionId, Crossing, Flow, Graph, NodeId, NodeKind},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// End of a leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SegmentEnd {
    /// A node.
    Node(NodeId),
    /// A boundary of a nested graph.
    Side(Crossing),
}

/// The part of a connection between two stops.
#[derive(Debug, Clone, Copy)]
pub struct Segment {
    /// The connection.
    pub connection: ConnectionId,
    /// Origin of the leg.
    pub from: SegmentEnd,
    /// Destination of the leg.
    pub to: SegmentEnd,
}

/// All legs. Those of one connection are adjacent and in order.
pub fn segments(graph: &Graph) -> Vec<Segment> {
    let insides = insides(graph);
    // The token of a delay begins an iteration of its loop. It must not wait at the outputs of nested graphs on the
    // loop, because the other tokens there are made only in that iteration.
    cut(graph, |node, side| {
        matches!(side, Crossing::Leave(_))
            && insides.get(&node).is_some_and(|inside| inside.contains(&SegmentEnd::Side(side)))
    })
}

/// The legs, where connections from a node ignore the boundaries for which `passes` is true.
fn cut(graph: &Graph, passes: impl Fn(NodeId, Crossing) -> bool) -> Vec<Segment> {
    let mut segments = vec![];
    for (connection, c) in graph.connections.iter_enumerated() {
        let mut from = SegmentEnd::Node(c.from.node);
        // A slot takes each token alone, so that no boundary holds it back.
        let sides = if graph.flow(c) == Flow::ToSlot { &[] } else { c.crossings.as_slice() };
        for &crossing in sides.iter().filter(|side| !passes(c.from.node, **side)) {
            let to = SegmentEnd::Side(crossing);
            segments.push(Segment { connection, from, to });
            from = to;
        }
        segments.push(Segment { connection, from, to: SegmentEnd::Node(c.to.node) });
    }
    segments
}

/// A loop, or several loops with nodes in common. An iteration begins only when it can be completed: all delays send
/// together.
#[derive(Debug, Clone)]
pub struct Loop {
    /// Its delays.
    pub delays: Vec<NodeId>,
    /// Legs that lead into it from outside. It iterates once for each token on each of them; without any it is a
    /// source.
    pub entries: Vec<usize>,
    /// Legs of the events of all nodes on it. They have to be free when an iteration begins.
    pub events: Vec<usize>,
}

/// The loops of a graph, by its [`segments`].
pub fn loops(graph: &Graph, segments: &[Segment]) -> Vec<Loop> {
    let on_loop = |(inside, delays): (BTreeSet<SegmentEnd>, Vec<NodeId>)| {
        let numbered = || segments.iter().enumerate();
        let is_entry = |l: &Segment| to_input(graph, l) && !inside.contains(&l.from) && inside.contains(&l.to);
        let is_event = |l: &Segment| {
            matches!(l.from, SegmentEnd::Node(_)) && inside.contains(&l.from) && from_event(graph, l.connection)
        };
        Loop {
            delays,
            entries: numbered().filter(|(_, l)| is_entry(l)).map(|(i, _)| i).collect(),
            events: numbered().filter(|(_, l)| is_event(l)).map(|(i, _)| i).collect(),
        }
    };
    // Delays with the same stops around them are on the same loop.
    let mut delays: BTreeMap<BTreeSet<SegmentEnd>, Vec<NodeId>> = BTreeMap::new();
    insides(graph).into_iter().for_each(|(delay, inside)| delays.entry(inside).or_default().push(delay));
    delays.into_iter().map(on_loop).collect()
}

/// For each delay on a loop, the nodes and boundaries on that loop. Nested graphs count as a whole, by their
/// boundaries.
fn insides(graph: &Graph) -> BTreeMap<NodeId, BTreeSet<SegmentEnd>> {
    let mut after: BTreeMap<SegmentEnd, Vec<SegmentEnd>> = BTreeMap::new();
    let mut before: BTreeMap<SegmentEnd, Vec<SegmentEnd>> = BTreeMap::new();
    for segment in cut(graph, |_, _| false).iter().filter(|segment| to_input(graph, segment)) {
        after.entry(segment.from).or_default().push(segment.to);
        before.entry(segment.to).or_default().push(segment.from);
    }
    let mut insides = BTreeMap::new();
    for (node, _) in graph.nodes.iter_enumerated().filter(|(_, n)| matches!(n.kind, NodeKind::Delay(_))) {
        // Everything that is both downstream and upstream of a delay is on a loop with it.
        let (below, above) = (reached([SegmentEnd::Node(node)], &after), reached([SegmentEnd::Node(node)], &before));
        if below.contains(&SegmentEnd::Node(node)) {
            insides.insert(node, below.intersection(&above).copied().collect());
        }
    }
    insides
}

fn to_input(graph: &Graph, segment: &Segment) -> bool {
    graph.flow(&graph.connections[segment.connection]) != Flow::ToSlot
}

/// Stops that can be reached along `next` from any of `from`. Members of `from` are included only if they can be
/// reached, too.
pub fn reached(
    from: impl IntoIterator<Item = SegmentEnd>,
    next: &BTreeMap<SegmentEnd, Vec<SegmentEnd>>,
) -> BTreeSet<SegmentEnd> {
    let mut found = BTreeSet::new();
    let mut ends: Vec<SegmentEnd> = from.into_iter().filter_map(|stop| next.get(&stop)).flatten().copied().collect();
    while let Some(stop) = ends.pop() {
        if found.insert(stop) {
            ends.extend(next.get(&stop).into_iter().flatten());
        }
    }
    found
}

/// Connections from a port that carry only values: those from an event, and those from an output to a slot.
pub fn value_connections(graph: &Graph, end: apex_dsl::graph::PortId) -> impl Iterator<Item = ConnectionId> + '_ {
    let connections = graph.connections.iter_enumerated();
    connections.filter(move |(_, c)| c.from == end && graph.flow(c) != Flow::Synchronous).map(|(i, _)| i)
}

/// Returns `true` if a connection starts at an event of its node.
pub fn from_event(graph: &Graph, connection: ConnectionId) -> bool {
    graph.port(graph.connections[connection].from).kind == PortKind::Event
}
