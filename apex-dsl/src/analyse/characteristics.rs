//! Characteristics of nodes (thesis 3.3.7): do other nodes have to know of a ⊥ that a node sends?
//!
//! Yes if an essential node is downstream (the node is *required*), or if a node downstream joins its tokens
//! with tokens of another origin (the node has *siblings*). Any other ⊥ can be dropped where it arises. With
//! `a -> [b, c]`, `b -> d.x` and `c -> d.y`, the nodes `b` and `c` have siblings: `d` waits for both. `a` has none: all
//! tokens that come to `d` descend from it.
//!
//! `apex explain` and the table of nodes in a program show the characteristics. The generated code skips nodes by their
//! clocks (`clocks.rs`).

use super::{firing::handles_absence, links::Links};
use crate::{
    catalog::Catalog,
    graph::{Graph, NodeId, NodeKind},
    index::IdVec,
};

/// Consequences of a ⊥ at a node for other nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Characteristics {
    /// `true` if ⊥ has an effect on the node: it is marked `essential`, or has a method for ⊥ (eq. 3.6).
    pub essential: bool,
    /// `true` if there is an essential node downstream (eq. 3.7).
    pub required: bool,
    /// `true` if a node downstream joins the tokens of this node with tokens of another origin (eq. 3.8).
    pub siblings: bool,
    /// `true` if the node has several connected inputs.
    pub joins: bool,
}

/// Characteristics of all nodes.
pub fn characteristics(
    graph: &Graph,
    catalog: &Catalog,
    links: &Links,
    order: &[NodeId],
) -> IdVec<NodeId, Characteristics> {
    let mut list = IdVec::from_elem(Characteristics::default(), graph.nodes.len());
    let siblings = siblings(graph, links, order);
    for &node in order.iter().rev() {
        let essential = graph.nodes[node].modifiers.essential || handles_absence(graph, catalog, node);
        let downstream = links.successors(graph, node).map(|next| list[next].essential || list[next].required);
        let required = downstream.fold(false, |any, one| any | one);
        list[node] =
            Characteristics { essential, required, siblings: siblings[node], joins: links.inputs[node].len() > 1 };
    }
    list
}

/// For each node, `true` if it has siblings: it does not dominate all nodes downstream. At least one of them also takes
/// tokens that do not descend from it.
///
/// In an acyclic graph, the immediate dominator of a node is the lowest common ancestor of its predecessors in the
/// dominator tree. The tree grows in the order of the nodes. An edge `u → w` leaves the subtree of `u` and of each
/// ancestor of `u` below the dominator of `w`: all of these have siblings. The edge counts 1 at `u` and -1 at the
/// dominator of `w`, so that the sum over a subtree is the number of edges that leave it.
fn siblings(graph: &Graph, links: &Links, order: &[NodeId]) -> IdVec<NodeId, bool> {
    let root = graph.nodes.len();
    let mut tree = Tree { parent: vec![root; root + 1], jump: vec![root; root + 1], depth: vec![0; root + 1] };
    let mut edges = vec![];
    for &node in order {
        // The root of the tree dominates all nodes: it stands before each source and each delay.
        let mut dominator = None;
        for &c in &links.into[node] {
            let from = graph.connections[c].from.node;
            // The token of a delay does not descend from the tokens of this iteration.
            if matches!(graph.nodes[from].kind, NodeKind::Delay(_)) {
                dominator = Some(root);
                continue;
            }
            edges.push((from, node));
            dominator = Some(dominator.map_or(from.index(), |other| tree.common(other, from.index())));
        }
        tree.insert(node.index(), dominator.unwrap_or(root));
    }
    let mut leaks = vec![0i64; root + 1];
    for (from, to) in edges {
        leaks[from.index()] += 1;
        leaks[tree.parent[to.index()]] -= 1;
    }
    for &node in order.iter().rev() {
        let own = leaks[node.index()];
        leaks[tree.parent[node.index()]] += own;
    }
    leaks[..root].iter().map(|leaks| *leaks > 0).collect()
}

/// Growing tree. Each vertex has a second pointer to a farther ancestor, so that common ancestors are found in
/// logarithmic time (skew-binary jump pointers, Myers 1983).
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
