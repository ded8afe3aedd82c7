//! Connections cut into legs at the boundaries of nested graphs, and the loops of a graph.

use super::PlaceId;
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
    Side(Side),
}

/// A boundary of a nested graph, where tokens wait for one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Side {
    /// The inputs or the outputs of the graph.
    pub crossing: Crossing,
    /// Tokens from which other tokens at the same boundary are made: they do not wait for these.
    pub is_first: bool,
}

impl Side {
    /// All tokens at a boundary.
    pub fn whole(crossing: Crossing) -> Self {
        Self { crossing, is_first: false }
    }
}

impl SegmentEnd {
    /// The node, or all tokens at the boundary.
    fn whole(self) -> Self {
        match self {
            Self::Side(side) => Self::Side(Side::whole(side.crossing)),
            Self::Node(_) => self,
        }
    }
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
    let causes = causes(graph);
    cut(graph, |node, crossing| {
        let passes = insides.get(&node).is_some_and(|inside| passes(inside, crossing));
        (!passes).then(|| Side { crossing, is_first: is_first(&causes, node, crossing) })
    })
}

/// Returns `true` if the token of a delay does not wait at a boundary for the others: it begins an iteration of its
/// loop, and at the outputs of nested graphs on the loop the other tokens are made only in that iteration.
fn passes(inside: &BTreeSet<SegmentEnd>, side: Crossing) -> bool {
    matches!(side, Crossing::Leave(_)) && inside.contains(&SegmentEnd::Side(Side::whole(side)))
}

/// Returns `true` if some of the tokens at the outputs of a nested graph are made from tokens that have left there, and
/// those of a node are not.
fn is_first(causes: &BTreeMap<Crossing, BTreeSet<SegmentEnd>>, node: NodeId, side: Crossing) -> bool {
    let made = |made: &BTreeSet<SegmentEnd>| {
        made.contains(&SegmentEnd::Side(Side::whole(side))) && !made.contains(&SegmentEnd::Node(node))
    };
    causes.get(&side).is_some_and(made)
}

/// For the outputs of each nested graph, what is made from the tokens there, but not by delays.
fn causes(graph: &Graph) -> BTreeMap<Crossing, BTreeSet<SegmentEnd>> {
    let is_delay =
        |end: SegmentEnd| matches!(end, SegmentEnd::Node(node) if matches!(graph.nodes[node].kind, NodeKind::Delay(_)));
    let mut after: BTreeMap<SegmentEnd, Vec<SegmentEnd>> = BTreeMap::new();
    for segment in to_inputs(graph).into_iter().filter(|segment| !is_delay(segment.from)) {
        after.entry(segment.from).or_default().push(segment.to);
    }
    let sides = graph.connections.iter().flat_map(|c| c.crossings.iter().copied()).collect::<BTreeSet<Crossing>>();
    let leaving = sides.into_iter().filter(|side| matches!(side, Crossing::Leave(_)));
    leaving.map(|side| (side, reached([SegmentEnd::Side(Side::whole(side))], &after))).collect()
}

/// The legs, where connections from a node wait at the boundaries for which `side` returns them.
fn cut(graph: &Graph, side: impl Fn(NodeId, Crossing) -> Option<Side>) -> Vec<Segment> {
    let mut segments = vec![];
    for (connection, c) in graph.connections.iter_enumerated() {
        let mut from = SegmentEnd::Node(c.from.node);
        // A slot takes each token alone, so that no boundary holds it back.
        let sides = if graph.flow(c) == Flow::ToSlot { &[] } else { c.crossings.as_slice() };
        for side in sides.iter().filter_map(|crossing| side(c.from.node, *crossing)) {
            let to = SegmentEnd::Side(side);
            segments.push(Segment { connection, from, to });
            from = to;
        }
        segments.push(Segment { connection, from, to: SegmentEnd::Node(c.to.node) });
    }
    segments
}

/// A loop, several loops with nodes in common, or a delay that is on none: this is the shortest loop. An iteration
/// begins only when it can be completed: all delays send together.
#[derive(Debug, Clone)]
pub struct Loop {
    /// Its delays.
    pub delays: Vec<NodeId>,
    /// Legs that lead into it from outside. It iterates once for each token on each of them; without any it is a
    /// source.
    pub entries: Vec<usize>,
    /// Legs of the events of all nodes on it. They have to be free when an iteration begins.
    pub events: Vec<usize>,
    /// Outputs of nested graphs where the tokens of its delays do not wait for the others. These follow in the same
    /// iteration.
    pub ahead: BTreeSet<Crossing>,
}

/// The loops of a graph, by its [`segments`].
pub fn loops(graph: &Graph, segments: &[Segment]) -> Vec<Loop> {
    let on_loop = |(inside, delays): (BTreeSet<SegmentEnd>, Vec<NodeId>)| {
        let numbered = || segments.iter().enumerate();
        let is_inside = |end: SegmentEnd| inside.contains(&end.whole());
        let is_entry = |l: &Segment| to_input(graph, l) && !is_inside(l.from) && is_inside(l.to);
        let is_event = |l: &Segment| {
            matches!(l.from, SegmentEnd::Node(_)) && inside.contains(&l.from) && from_event(graph, l.connection)
        };
        let from_delays = graph.connections.iter().filter(|c| delays.contains(&c.from.node));
        let is_ahead = |side: &Crossing| passes(&inside, *side);
        Loop {
            ahead: from_delays.flat_map(|c| c.crossings.iter().copied()).filter(is_ahead).collect(),
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

/// Places of the copies of tokens that lead into loops, with their legs. They follow the two places of each leg.
pub fn echoes<'a>(segments: &[Segment], loops: &'a [Loop]) -> impl Iterator<Item = (PlaceId, usize)> + use<'a> {
    let entries = loops.iter().flat_map(|on_loop| on_loop.entries.iter().copied());
    (2 * segments.len()..).map(PlaceId::from).zip(entries)
}

/// For each delay, the nodes and boundaries on the loop that it is on: itself if it is on none. Nested graphs count as
/// a whole, by their boundaries.
fn insides(graph: &Graph) -> BTreeMap<NodeId, BTreeSet<SegmentEnd>> {
    let mut after: BTreeMap<SegmentEnd, Vec<SegmentEnd>> = BTreeMap::new();
    let mut before: BTreeMap<SegmentEnd, Vec<SegmentEnd>> = BTreeMap::new();
    for segment in to_inputs(graph) {
        after.entry(segment.from).or_default().push(segment.to);
        before.entry(segment.to).or_default().push(segment.from);
    }
    let mut insides = BTreeMap::new();
    for (node, _) in graph.nodes.iter_enumerated().filter(|(_, n)| matches!(n.kind, NodeKind::Delay(_))) {
        // Everything that is both downstream and upstream of a delay is on a loop with it.
        let (below, above) = (reached([SegmentEnd::Node(node)], &after), reached([SegmentEnd::Node(node)], &before));
        let mut inside: BTreeSet<SegmentEnd> = below.intersection(&above).copied().collect();
        inside.insert(SegmentEnd::Node(node));
        insides.insert(node, inside);
    }
    insides
}

/// The legs of all connections to inputs, where their tokens wait at each boundary for all others.
fn to_inputs(graph: &Graph) -> Vec<Segment> {
    let mut segments = cut(graph, |_, crossing| Some(Side::whole(crossing)));
    segments.retain(|segment| to_input(graph, segment));
    segments
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
