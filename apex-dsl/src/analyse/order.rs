//! An order in which each node comes after the nodes that send to it. If there is none, the error names a cycle.
//!
//! A topological sort of the nodes is not enough, for two reasons:
//!
//! - A nested graph takes its inputs together and sends its outputs together. Its two boundaries are vertices of their
//!   own, and connections lead through them. With `a -> n.x`, `n.y -> b` and `b -> n.z`, the nested graph `n` waits for
//!   `b`, and `b` for `n`, even if no connection inside leads from `z` to `y`.
//! - A delay on a loop sends tokens of an earlier iteration, so its consumers do not wait for it. They wait for the
//!   tokens that enter the loop and begin an iteration. With `s -> sum.a`, `f -> sum.b` and `sum -> delay -> f`, the
//!   order is `s`, `f`, `sum`, `delay`: the edge from `s` to `f` comes from [`super::Loops::begun_by`].

use super::{
    links::Links,
    precedence::{Precedence, Vertex},
};
use crate::{
    graph::{ConnectionId, Graph, NodeId},
    report::{Diagnostic, Diagnostics},
};
use std::{cmp::Reverse, collections::BinaryHeap};

/// Order graph of one iteration: without the connections from delays on loops, with the edges of
/// [`super::Loops::begun_by`].
fn iteration(graph: &Graph, links: &Links) -> Precedence {
    let is_taken = |c: &ConnectionId| !links.loops.delays.contains(&graph.connections[*c].from.node);
    let mut precedence = Precedence::of(graph, links.into.iter().flatten().copied().filter(is_taken));
    for (node, begun) in &links.loops.begun_by {
        precedence.edges[node.index()].extend(begun.iter().map(|next| (next.index(), None)));
    }
    precedence
}

/// Order of all nodes (Kahn's algorithm). Of several nodes that are ready, the first in the source file comes first.
/// Reports a cycle and returns `None` if there is no order.
pub fn order(graph: &Graph, links: &Links, diagnostics: &mut Diagnostics) -> Option<Vec<NodeId>> {
    let precedence = iteration(graph, links);
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
