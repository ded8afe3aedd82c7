//! An order in which every node comes after those that send to it. Where there is none, a cycle is named.

use super::Links;
use crate::{
    graph::{Connection, Crossing, Flow, Graph, NodeId, ScopeId},
    report::{Diagnostic, Diagnostics},
};
use std::{
    cmp::Reverse,
    collections::{BTreeMap, BTreeSet, BinaryHeap},
};

/// Something to be ordered: a node, or one of the two sides of a nested graph, which takes all its inputs
/// together and sends all its outputs together (thesis 5.2.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Vertex {
    Node(NodeId),
    Enter(ScopeId),
    Leave(ScopeId),
}

/// The order graph: vertices by number, edges with the connection that they come from.
struct Precedence {
    vertices: Vec<Vertex>,
    edges: Vec<Vec<(usize, Option<usize>)>>,
}

impl Precedence {
    /// That of one iteration.
    fn new(graph: &Graph, links: &Links) -> Self {
        let is_taken = |c: &usize| !links.loops.delays.contains(&graph.connections[*c].from.node);
        let mut precedence = Self::of(graph, links.into.iter().flatten().copied().filter(is_taken));
        for (node, begun) in &links.loops.begun_by {
            precedence.edges[*node].extend(begun.iter().map(|next| (*next, None)));
        }
        precedence
    }

    /// That of some connections. One to a slot counts as far as the last side that it passes.
    fn of(graph: &Graph, connections: impl Iterator<Item = usize>) -> Self {
        let nodes = graph.nodes.len();
        let scopes = graph.scopes.len();
        let mut vertices: Vec<Vertex> = (0..nodes).map(Vertex::Node).collect();
        vertices.extend((0..scopes).map(Vertex::Enter));
        vertices.extend((0..scopes).map(Vertex::Leave));
        let mut edges = vec![vec![]; vertices.len()];
        for connection in connections {
            let c = &graph.connections[connection];
            let mut at = c.from.node;
            for next in stations(graph, c) {
                edges[at].push((next, Some(connection)));
                at = next;
            }
        }
        for scope in 1..scopes {
            edges[nodes + scope].push((nodes + scopes + scope, None));
        }
        Self { vertices, edges }
    }
}

/// The vertices that a connection leads to: the sides that it passes and, unless that is a slot, its end.
fn stations(graph: &Graph, connection: &Connection) -> impl Iterator<Item = usize> {
    let (nodes, scopes) = (graph.nodes.len(), graph.scopes.len());
    let sides = connection.crossings.iter().map(move |crossing| match crossing {
        Crossing::Enter(scope) => nodes + scope,
        Crossing::Leave(scope) => nodes + scopes + scope,
    });
    sides.chain((graph.flow(connection) != Flow::ToSlot).then_some(connection.to.node))
}

/// The loops of a graph, all of which lead through delays.
#[derive(Debug, Default)]
pub struct Loops {
    /// The delays on loops: what they send is of the iteration before.
    pub delays: BTreeSet<NodeId>,
    /// What a delay on a loop sends does not wait for the delay, but for what comes into the loop from elsewhere: that is when
    /// an iteration of the loop begins. For each node that sends into loops, the nodes that these delays send to.
    pub begun_by: BTreeMap<NodeId, Vec<NodeId>>,
}

impl Loops {
    /// Finds them.
    pub fn new(graph: &Graph, links: &Links) -> Self {
        let mut delays = (0..graph.nodes.len()).filter(|node| graph.nodes[*node].is_delay()).peekable();
        if delays.peek().is_none() {
            return Self::default();
        }
        let edges = Precedence::new(graph, links).edges;
        let part = components(&edges);
        let is_on_loop = |delay: &NodeId| edges[*delay].iter().any(|(next, _)| part[*next] == part[*delay]);
        let delays: BTreeSet<NodeId> = delays.filter(is_on_loop).collect();
        let mut behind: BTreeMap<usize, BTreeSet<NodeId>> = BTreeMap::new();
        for delay in &delays {
            let sent = links.out_of[*delay].iter().map(|c| graph.connections[*c].to.node);
            behind.entry(part[*delay]).or_default().extend(sent);
        }
        let mut begun_by = BTreeMap::new();
        for (node, out) in links.out_of.iter().enumerate() {
            // A token also enters a loop at a side of a nested graph that the loop leads through.
            let stations = out.iter().flat_map(|c| stations(graph, &graph.connections[*c]));
            let entered: BTreeSet<usize> = stations.map(|s| part[s]).filter(|p| *p != part[node]).collect();
            let begun: BTreeSet<NodeId> = entered.iter().filter_map(|p| behind.get(p)).flatten().copied().collect();
            if !begun.is_empty() {
                begun_by.insert(node, begun.into_iter().collect());
            }
        }
        Self { delays, begun_by }
    }
}

/// A number for each node; nodes between which tokens flow in a circle have the same one.
pub fn circles(graph: &Graph) -> Vec<usize> {
    let synchronous = (0..graph.connections.len()).filter(|c| graph.is_synchronous(&graph.connections[*c]));
    let mut part = components(&Precedence::of(graph, synchronous).edges);
    part.truncate(graph.nodes.len());
    part
}

/// The events that lead to inputs from which tokens flow back to their nodes, by connection: also by way of delays, and of
/// nested graphs, which take all their inputs together.
pub fn events_on_circles(graph: &Graph) -> Vec<usize> {
    let edges = Precedence::of(graph, 0..graph.connections.len()).edges;
    let part = components(&edges);
    let is_on_circle = |c: &usize| {
        let c = &graph.connections[*c];
        graph.flow(c) == Flow::ToInput && part[c.from.node] == part[c.to.node]
    };
    (0..graph.connections.len()).filter(is_on_circle).collect()
}

/// The strongly connected component of each vertex (Kosaraju and Sharir).
fn components(edges: &[Vec<(usize, Option<usize>)>]) -> Vec<usize> {
    let after: Vec<Vec<usize>> = edges.iter().map(|e| e.iter().map(|(next, _)| *next).collect()).collect();
    let mut before = vec![vec![]; edges.len()];
    for (vertex, next) in after.iter().enumerate() {
        next.iter().for_each(|next| before[*next].push(vertex));
    }
    let mut seen = vec![false; edges.len()];
    let finished: Vec<usize> = (0..edges.len()).flat_map(|v| finish(v, &after, &mut seen)).collect();
    let (mut part, mut seen) = (vec![0; edges.len()], vec![false; edges.len()]);
    for &vertex in finished.iter().rev() {
        finish(vertex, &before, &mut seen).into_iter().for_each(|member| part[member] = vertex);
    }
    part
}

/// What is reached from `start` and was not seen before; a vertex comes after all that is reached from it.
fn finish(start: usize, after: &[Vec<usize>], seen: &mut [bool]) -> Vec<usize> {
    let mut finished = vec![];
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

/// The order of all nodes; among those that are free, the first in the text comes first.
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

/// Every vertex that still waits has a predecessor that still waits: walking back leads into a cycle.
fn report_cycle(graph: &Graph, precedence: &Precedence, waits: &[usize], diagnostics: &mut Diagnostics) {
    let mut back: Vec<Option<(usize, Option<usize>)>> = vec![None; waits.len()];
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
    let message = format!("nodes wait for each other in a circle: {}", names.join(" → "));
    let Some(closing) = connections.last() else { return };
    let mut error = Diagnostic::error("cycle", graph.connections[*closing].span, message).label("closes the circle");
    for connection in connections.iter().rev().skip(1).take(8) {
        error = error.also(graph.connections[*connection].span, "");
    }
    if path.iter().any(|v| !matches!(v, Vertex::Node(_))) {
        error = error
            .note("a nested graph takes all its inputs together and sends all its outputs together, as one node does");
    }
    let last = graph.end_name(graph.connections[*closing].from);
    let error = error
        .note(format!("break it where a value of the iteration before is meant: `delay` behind the node that sends `{last}`, for example `node … = …() delay 0;`"))
        .note("or send the token to a slot, which does not wait");
    diagnostics.push(error);
}
