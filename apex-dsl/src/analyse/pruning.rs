//! The characteristics of thesis 3.3.7: who must be told of a ⊥.

use super::Links;
use crate::{
    catalog::Catalog,
    graph::{Graph, NodeId, NodeKind},
};

/// What a ⊥ at a node means for others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Characteristics {
    /// It wants to see ⊥ itself (eq. 3.6).
    pub essential: bool,
    /// There is an essential node downstream (eq. 3.7).
    pub required: bool,
    /// A node downstream joins its stream with one that does not come from it (eq. 3.8).
    pub siblings: bool,
    /// It joins streams.
    pub joins: bool,
}

/// The characteristics of all nodes.
pub fn characteristics(graph: &Graph, catalog: &Catalog, links: &Links, order: &[NodeId]) -> Vec<Characteristics> {
    let mut list = vec![Characteristics::default(); graph.nodes.len()];
    let siblings = siblings(graph, links, order);
    for &node in order.iter().rev() {
        let essential = graph.nodes[node].modifiers.essential || super::is_told(graph, catalog, node);
        let downstream = links.successors(graph, node).map(|next| list[next].essential || list[next].required);
        let required = downstream.fold(false, |any, one| any | one);
        list[node] =
            Characteristics { essential, required, siblings: siblings[node], joins: links.inputs[node].len() > 1 };
    }
    list
}

/// A node has siblings if it does not dominate everything downstream of it: some node there also hears of
/// others. Dominators of an acyclic graph are lowest common ancestors in the dominator tree built so far; an edge
/// `u → w` leads out of the reach of all nodes between `u` and the dominator of `w`.
fn siblings(graph: &Graph, links: &Links, order: &[NodeId]) -> Vec<bool> {
    let root = graph.nodes.len();
    let mut tree = Tree { parent: vec![root; root + 1], jump: vec![root; root + 1], depth: vec![0; root + 1] };
    let mut edges = vec![];
    for &node in order {
        let mut dominator = None;
        for &c in &links.into[node] {
            let from = graph.connections[c].from.node;
            if matches!(graph.nodes[from].kind, NodeKind::Delay(_)) {
                dominator = Some(root);
                continue;
            }
            edges.push((from, node));
            dominator = Some(dominator.map_or(from, |other| tree.common(other, from)));
        }
        tree.insert(node, dominator.unwrap_or(root));
    }
    let mut leaks = vec![0i64; root + 1];
    for (from, to) in edges {
        leaks[from] += 1;
        leaks[tree.parent[to]] -= 1;
    }
    for &node in order.iter().rev() {
        let own = leaks[node];
        leaks[tree.parent[node]] += own;
    }
    leaks[..root].iter().map(|leaks| *leaks > 0).collect()
}

/// A growing tree with jump pointers, so that common ancestors are found in logarithmic time.
struct Tree {
    parent: Vec<usize>,
    jump: Vec<usize>,
    depth: Vec<usize>,
}

impl Tree {
    fn insert(&mut self, node: usize, parent: usize) {
        self.parent[node] = parent;
        self.depth[node] = self.depth[parent] + 1;
        let (a, b) = (self.jump[parent], self.jump[self.jump[parent]]);
        let balanced = self.depth[parent] - self.depth[a] == self.depth[a] - self.depth[b];
        self.jump[node] = if balanced { b } else { parent };
    }

    fn common(&self, mut a: usize, mut b: usize) -> usize {
        if self.depth[a] < self.depth[b] {
            std::mem::swap(&mut a, &mut b);
        }
        while self.depth[a] > self.depth[b] {
            a = if self.depth[self.jump[a]] >= self.depth[b] { self.jump[a] } else { self.parent[a] };
        }
        while a != b {
            if self.jump[a] == self.jump[b] {
                (a, b) = (self.parent[a], self.parent[b]);
            } else {
                (a, b) = (self.jump[a], self.jump[b]);
            }
        }
        a
    }
}
