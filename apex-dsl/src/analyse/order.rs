//! An order in which each node comes after the nodes that send to it. If there is none, the error names a cycle.
//!
//! A topological sort of the nodes is not enough, for two reasons:
//!
//! - A nested graph takes its inputs together and sends its outputs together. Its two boundaries are vertices of their
//!   own, and connections lead through them. With `a -> n.x`, `n.y -> b` and `b -> n.z`, the nested graph `n` waits for
//!   `b`, and `b` for `n`, even if no connection inside leads from `z` to `y`.
//! - A delay on a loop sends tokens of an earlier iteration, so its consumers do not wait for it. They wait for the
//!   tokens that enter the loop and begin an iteration. With `s -> sum.a`, `f -> sum.b` and `sum -> delay -> f`, the
//!   order is `s`, `f`, `sum`, `delay`: the edge from `s` to `f` comes from [`Loops::begun_by`].

use super::Links;
use crate::{
    graph::{Connection, ConnectionId, Crossing, Flow, Graph, NodeId, ScopeId},
    index::IdVec,
    report::{Diagnostic, Diagnostics},
};
use std::{
    cmp::Reverse,
    collections::{BTreeMap, BTreeSet, BinaryHeap},
};

/// Vertex of the order graph: a node, or one of the two boundaries of a nested graph, which takes its inputs together
/// and sends its outputs together (thesis 5.2.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Vertex {
    Node(NodeId),
    Enter(ScopeId),
    Leave(ScopeId),
}

/// Order graph: vertices by number, and edges out of each vertex with the connection that they come from.
struct Precedence {
    vertices: Vec<Vertex>,
    edges: Vec<Vec<(usize, Option<ConnectionId>)>>,
}

impl Precedence {
    /// Order graph of one iteration: without the connections from delays on loops, with the edges of
    /// [`Loops::begun_by`].
    fn new(graph: &Graph, links: &Links) -> Self {
        let is_taken = |c: &ConnectionId| !links.loops.delays.contains(&graph.connections[*c].from.node);
        let mut precedence = Self::of(graph, links.into.iter().flatten().copied().filter(is_taken));
        for (node, begun) in &links.loops.begun_by {
            precedence.edges[node.index()].extend(begun.iter().map(|next| (next.index(), None)));
        }
        precedence
    }

    /// Order graph of some connections. A connection to a slot counts up to the last boundary that it crosses.
    fn of(graph: &Graph, connections: impl Iterator<Item = ConnectionId>) -> Self {
        let nodes = graph.nodes.len();
        let scopes = graph.scopes.len();
        let mut vertices: Vec<Vertex> = graph.nodes.ids().map(Vertex::Node).collect();
        vertices.extend(graph.scopes.ids().map(Vertex::Enter));
        vertices.extend(graph.scopes.ids().map(Vertex::Leave));
        let mut edges = vec![vec![]; vertices.len()];
        for connection in connections {
            let c = &graph.connections[connection];
            let mut at = c.from.node.index();
            for next in stations(graph, c) {
                edges[at].push((next, Some(connection)));
                at = next;
            }
        }
        // Outputs of a nested graph come after its inputs, whatever is connected inside.
        for scope in 1..scopes {
            edges[nodes + scope].push((nodes + scopes + scope, None));
        }
        Self { vertices, edges }
    }
}

/// Vertices that a connection leads to: the boundaries that it crosses, then the node at its end unless it leads to a
/// slot.
fn stations(graph: &Graph, connection: &Connection) -> impl Iterator<Item = usize> {
    let (nodes, scopes) = (graph.nodes.len(), graph.scopes.len());
    let sides = connection.crossings.iter().map(move |crossing| match crossing {
        Crossing::Enter(scope) => nodes + scope.index(),
        Crossing::Leave(scope) => nodes + scopes + scope.index(),
    });
    sides.chain((graph.flow(connection) != Flow::ToSlot).then_some(connection.to.node.index()))
}

/// Loops of a graph that lead through delays.
#[derive(Debug, Default)]
pub struct Loops {
    /// Delays on loops. They send tokens of an earlier iteration.
    pub delays: BTreeSet<NodeId>,
    /// Additional edges of the order graph. An iteration of a loop begins when tokens enter the loop, so each node that
    /// sends into a loop precedes all consumers of the delays on this loop.
    pub begun_by: BTreeMap<NodeId, Vec<NodeId>>,
}

impl Loops {
    /// Loops of `graph`.
    pub fn new(graph: &Graph, links: &Links) -> Self {
        // `links` has no loops yet, so the order graph also has the connections from delays.
        let mut delays = graph.nodes.ids().filter(|node| graph.nodes[*node].is_delay()).peekable();
        if delays.peek().is_none() {
            return Self::default();
        }
        let edges = Precedence::new(graph, links).edges;
        let part = components(&edges);
        // A delay is on a loop if it sends to its own strongly connected component.
        let is_on_loop =
            |delay: &NodeId| edges[delay.index()].iter().any(|(next, _)| part[*next] == part[delay.index()]);
        let delays: BTreeSet<NodeId> = delays.filter(is_on_loop).collect();
        let mut behind: BTreeMap<usize, BTreeSet<NodeId>> = BTreeMap::new();
        for delay in &delays {
            let sent = links.out_of[*delay].iter().map(|c| graph.connections[*c].to.node);
            behind.entry(part[delay.index()]).or_default().extend(sent);
        }
        let mut begun_by = BTreeMap::new();
        for (node, out) in links.out_of.iter_enumerated() {
            // A token also enters a loop at a boundary that the loop leads through.
            let stations = out.iter().flat_map(|c| stations(graph, &graph.connections[*c]));
            let entered: BTreeSet<usize> = stations.map(|s| part[s]).filter(|p| *p != part[node.index()]).collect();
            let begun: BTreeSet<NodeId> = entered.iter().filter_map(|p| behind.get(p)).flatten().copied().collect();
            if !begun.is_empty() {
                begun_by.insert(node, begun.into_iter().collect());
            }
        }
        Self { delays, begun_by }
    }
}

/// For each node the number of its strongly connected component. Two nodes have the same number if they are on a common
/// cycle of synchronous connections, which may lead through delays and through boundaries of nested graphs.
pub fn circles(graph: &Graph) -> IdVec<NodeId, usize> {
    let synchronous = graph.connections.ids().filter(|c| graph.is_synchronous(&graph.connections[*c]));
    let mut part = components(&Precedence::of(graph, synchronous).edges);
    part.truncate(graph.nodes.len());
    part.into()
}

/// Connections from events to inputs that lie on a cycle. The cycle may lead through delays, and through boundaries of
/// nested graphs.
pub fn events_on_circles(graph: &Graph) -> Vec<ConnectionId> {
    let edges = Precedence::of(graph, graph.connections.ids()).edges;
    let part = components(&edges);
    let is_on_circle = |c: &ConnectionId| {
        let c = &graph.connections[*c];
        graph.flow(c) == Flow::ToInput && part[c.from.node.index()] == part[c.to.node.index()]
    };
    graph.connections.ids().filter(is_on_circle).collect()
}

/// Strongly connected component of each vertex, as the number of one of its members (Kosaraju and Sharir).
fn components(edges: &[Vec<(usize, Option<ConnectionId>)>]) -> Vec<usize> {
    let after: Vec<Vec<usize>> = edges.iter().map(|e| e.iter().map(|(next, _)| *next).collect()).collect();
    let mut before = vec![vec![]; edges.len()];
    for (vertex, next) in after.iter().enumerate() {
        next.iter().for_each(|next| before[*next].push(vertex));
    }
    let mut seen = vec![false; edges.len()];
    let finished: Vec<usize> = (0..edges.len()).flat_map(|v| finish(v, &after, &mut seen)).collect();
    // Against the edges, the vertex that finished last reaches its own component and nothing else. Without this
    // component, the same holds for the last one that remains.
    let (mut part, mut seen) = (vec![0; edges.len()], vec![false; edges.len()]);
    for &vertex in finished.iter().rev() {
        finish(vertex, &before, &mut seen).into_iter().for_each(|member| part[member] = vertex);
    }
    part
}

/// Vertices that are reachable from `start` and were not seen before, in post-order.
fn finish(start: usize, after: &[Vec<usize>], seen: &mut [bool]) -> Vec<usize> {
    let mut finished = vec![];
    // An explicit stack: a path can be too long for recursion.
    let mut path = if std::mem::replace(&mut seen[start], true) { vec![] } else { vec![(start, 0)] };
    while let Some((vertex, next)) = path.last_mut() {
        match after[*vertex].get(*next) {
            Some(&to) => {
                *next += 1;
                if !std::mem::replace(&mut seen[to], true) {
                    path.push((to, 0));
                }
            }
            None => {
                finished.push(*vertex);
                path.pop();
            }
        }
    }
    finished
}

/// Order of all nodes (Kahn's algorithm). Of several nodes that are ready, the first in the source file comes first.
/// Reports a cycle and returns `None` if there is no order.
pub fn order(graph: &Graph, links: &Links, diagnostics: &mut Diagnostics) -> Option<Vec<NodeId>> {
    let precedence = Precedence::new(graph, links);
    let mut waits = vec![0usize; precedence.vertices.len()];
    for (next, _) in precedence.edges.iter().flatten() {
        waits[*next] += 1;
    }
    let mut ready: BinaryHeap<Reverse<usize>> = (0..waits.len()).filter(|v| waits[*v] == 0).map(Reverse).collect();
    let mut order = vec![];
    let mut done = 0;
    while let Some(Reverse(vertex)) = ready.pop() {
        done += 1;
        if let Vertex::Node(node) = precedence.vertices[vertex] {
            order.push(node);
        }
        for (next, _) in &precedence.edges[vertex] {
            waits[*next] -= 1;
            if waits[*next] == 0 {
                ready.push(Reverse(*next));
            }
        }
    }
    if done == precedence.vertices.len() {
        return Some(order);
    }
    report_cycle(graph, &precedence, &waits, diagnostics);
    None
}

/// Reports a cycle. Each vertex that still waits has a predecessor that still waits, so walking back leads into one.
fn report_cycle(graph: &Graph, precedence: &Precedence, waits: &[usize], diagnostics: &mut Diagnostics) {
    let mut back: Vec<Option<(usize, Option<ConnectionId>)>> = vec![None; waits.len()];
    for (vertex, edges) in precedence.edges.iter().enumerate().filter(|(v, _)| waits[*v] > 0) {
        for (next, connection) in edges.iter().filter(|(n, _)| waits[*n] > 0) {
            back[*next] = Some((vertex, *connection));
        }
    }
    let Some(mut at) = (0..waits.len()).find(|v| waits[*v] > 0 && back[*v].is_some()) else { return };
    let mut seen = vec![false; waits.len()];
    while !std::mem::replace(&mut seen[at], true) {
        at = back[at].map_or(at, |(before, _)| before);
    }
    // The first vertex that is reached twice is on the cycle.
    let (first, mut path, mut connections) = (at, vec![], vec![]);
    while let Some((before, connection)) = back[at] {
        path.push(precedence.vertices[at]);
        connections.extend(connection);
        at = before;
        if at == first {
            break;
        }
    }
    path.reverse();
    connections.reverse();
    // A connection through boundaries has several edges, and a nested graph several vertices.
    connections.dedup();
    let name = |vertex: &Vertex| match vertex {
        Vertex::Node(node) => format!("`{}`", graph.path(*node)),
        Vertex::Enter(scope) | Vertex::Leave(scope) => format!("`{}`", graph.scopes[*scope].name),
    };
    let mut names: Vec<String> = path.iter().map(name).collect();
    names.dedup();
    if names.len() > 1 && names.first() == names.last() {
        names.pop();
    }
    names.extend(names.first().cloned());
    let message = format!("nodes wait for each other in a cycle: {}", names.join(" → "));
    let Some(closing) = connections.last() else { return };
    let mut error = Diagnostic::error("cycle", graph.connections[*closing].span, message).label("closes the cycle");
    for connection in connections.iter().rev().skip(1).take(8) {
        error = error.also(graph.connections[*connection].span, "");
    }
    if path.iter().any(|v| !matches!(v, Vertex::Node(_))) {
        error = error.note(
            "a nested graph takes all its inputs together and sends all its outputs together, like a single node",
        );
    }
    let last = graph.end_name(graph.connections[*closing].from);
    let error = error
        .note(format!("break it where the value of the previous iteration is meant: write `delay` after the node that sends `{last}`, for example `node … = …() delay 0;`"))
        .note("or send the token to a slot: slots do not wait for other tokens");
    diagnostics.push(error);
}
