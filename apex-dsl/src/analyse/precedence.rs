//! Order graphs: which nodes, and which boundaries of nested graphs, come before which others.

use crate::{
    graph::{Connection, ConnectionId, Crossing, Flow, Graph, NodeId, ScopeId},
    index::IdVec,
};

/// Vertex of the order graph: a node, or one of the two boundaries of a nested graph, which takes its inputs together
/// and sends its outputs together (thesis 5.2.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Vertex {
    Node(NodeId),
    Enter(ScopeId),
    Leave(ScopeId),
}

/// Order graph: vertices by number, and edges out of each vertex with the connection that they come from.
pub struct Precedence {
    /// The vertices.
    pub vertices: Vec<Vertex>,
    /// For each vertex those that come after it.
    pub edges: Vec<Vec<(usize, Option<ConnectionId>)>>,
}

impl Precedence {
    /// Order graph of some connections. A connection to a slot counts up to the last boundary that it crosses.
    pub fn of(graph: &Graph, connections: impl Iterator<Item = ConnectionId>) -> Self {
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
pub fn stations(graph: &Graph, connection: &Connection) -> impl Iterator<Item = usize> {
    let (nodes, scopes) = (graph.nodes.len(), graph.scopes.len());
    let sides = connection.crossings.iter().map(move |crossing| match crossing {
        Crossing::Enter(scope) => nodes + scope.index(),
        Crossing::Leave(scope) => nodes + scopes + scope.index(),
    });
    sides.chain((graph.flow(connection) != Flow::ToSlot).then_some(connection.to.node.index()))
}

/// Strongly connected component of each vertex, as the number of one of its members (Kosaraju and Sharir).
pub fn components(edges: &[Vec<(usize, Option<ConnectionId>)>]) -> Vec<usize> {
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
