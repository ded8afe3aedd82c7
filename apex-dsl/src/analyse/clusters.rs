//! Regions, guards and clusters: what runs together as straight-line code (see the execution semantics).

use super::{Block, Links, Step, is_source};
use crate::{
    graph::{Crossing, Graph, Node, NodeId, NodeKind, ScopeId},
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// Something that a cluster waits for and that the synchronous schedule does not decide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guard {
    /// The timer of a source with `every`.
    Timer(NodeId),
    /// A graph-level input.
    Input(NodeId),
    /// Sources without a pace of their own: once per `react`. They share a guard where they wait for the same things downstream.
    React,
}

/// Nodes that fire together.
#[derive(Debug)]
pub struct Cluster {
    /// The region.
    pub region: usize,
    /// Its nodes, producers before consumers.
    pub nodes: Vec<NodeId>,
    /// All guards that its nodes depend on.
    pub guards: BTreeSet<usize>,
    /// The guards that it tests itself; the others come with the tokens.
    pub own_guards: Vec<usize>,
    /// Clusters that send to it.
    pub upstream: BTreeSet<usize>,
    /// Clusters that it sends to.
    pub downstream: BTreeSet<usize>,
    /// What a firing does.
    pub block: Block,
}

impl Cluster {
    /// Its nodes in the order in which they fire.
    pub fn schedule(&self) -> Vec<NodeId> {
        let mut order = vec![];
        let mut blocks: Vec<std::slice::Iter<'_, Step>> = vec![self.block.steps.iter()];
        while let Some(steps) = blocks.last_mut() {
            match steps.next() {
                Some(Step::Fire(node)) => order.push(*node),
                Some(Step::Block(inner)) => blocks.push(inner.steps.iter()),
                None => drop(blocks.pop()),
            }
        }
        order
    }

    /// Whether it just runs once per `react`: nothing to wait for, nothing between it and others.
    pub fn is_free(&self, guards: &[Guard]) -> bool {
        self.upstream.is_empty()
            && self.downstream.is_empty()
            && self.own_guards.iter().all(|g| guards[*g] == Guard::React)
    }
}

/// More timers and graph-level inputs than one program has; bounds the time and memory for the sets of guards.
const MAX_PACES: usize = 1_000;

/// Reports a program with more of them; `None` then.
pub fn check_paces(graph: &Graph, diagnostics: &mut Diagnostics) -> Option<()> {
    let sets_a_pace = |n: &&Node| matches!(n.kind, NodeKind::Boundary(PortKind::Input)) || n.modifiers.every.is_some();
    let Some(node) = graph.nodes.iter().filter(sets_a_pace).nth(MAX_PACES) else { return Some(()) };
    let message = format!("a program has at most {MAX_PACES} inputs and sources with `every`");
    diagnostics.push(Diagnostic::error("too-large", node.span, message));
    None
}

/// The region of each node, numbered in the order of the text. What enters or leaves a nested graph does so
/// together, and belongs to one region.
pub fn regions(graph: &Graph) -> Vec<usize> {
    let mut root: Vec<usize> = (0..graph.nodes.len()).collect();
    let mut join = |a: usize, b: usize| {
        let (a, b) = (find(&mut root, a), find(&mut root, b));
        root[a.max(b)] = a.min(b);
    };
    let mut at_scope: BTreeMap<ScopeId, NodeId> = BTreeMap::new();
    for c in graph.connections.iter().filter(|c| graph.is_synchronous(c)) {
        join(c.from.node, c.to.node);
        for Crossing::Enter(scope) | Crossing::Leave(scope) in &c.crossings {
            join(*at_scope.entry(*scope).or_insert(c.to.node), c.to.node);
        }
    }
    let mut numbers = BTreeMap::new();
    (0..graph.nodes.len())
        .map(|node| {
            let next = numbers.len();
            *numbers.entry(find(&mut root, node)).or_insert(next)
        })
        .collect()
}

fn find(root: &mut [usize], mut node: usize) -> usize {
    while root[node] != node {
        root[node] = root[root[node]];
        node = root[node];
    }
    node
}

/// Guards, clusters, and the cluster of each node.
pub fn clusters(
    graph: &Graph,
    links: &Links,
    order: &[NodeId],
    regions: &[usize],
) -> (Vec<Guard>, Vec<Cluster>, Vec<usize>) {
    let mut guards = vec![];
    let mut own: Vec<Option<usize>> = vec![None; graph.nodes.len()];
    for (id, node) in graph.nodes.iter().enumerate() {
        let guard = match node.kind {
            // The body of an `each` runs when it is called, with all its inputs.
            _ if graph.is_body => continue,
            NodeKind::Boundary(PortKind::Input) => Guard::Input(id),
            _ if is_source(graph, links, id) && node.modifiers.every.is_some() => Guard::Timer(id),
            _ => continue,
        };
        own[id] = Some(guards.len());
        guards.push(guard);
    }
    add_react_guards(graph, links, order, regions, &mut guards, &mut own);
    let accumulated = accumulate(graph, links, order, &own);
    let mut by_guards: BTreeMap<(usize, &BTreeSet<usize>), Vec<NodeId>> = BTreeMap::new();
    for &node in order {
        by_guards.entry((regions[node], &accumulated[node])).or_default().push(node);
    }
    let mut groups: Vec<_> = by_guards.into_iter().collect();
    groups.sort_by_key(|(_, nodes)| nodes.iter().min().copied());
    let mut cluster_of = vec![0; graph.nodes.len()];
    let mut clusters: Vec<Cluster> = vec![];
    for ((region, set), nodes) in groups {
        nodes.iter().for_each(|n| cluster_of[*n] = clusters.len());
        let own_guards: BTreeSet<usize> = nodes.iter().filter_map(|n| own[*n]).collect();
        let (upstream, downstream) = (BTreeSet::new(), BTreeSet::new());
        let own_guards = own_guards.into_iter().collect();
        clusters.push(Cluster {
            region,
            nodes,
            guards: set.clone(),
            own_guards,
            upstream,
            downstream,
            block: Block::default(),
        });
    }
    for c in graph.connections.iter().filter(|c| graph.is_synchronous(c)) {
        let (a, b) = (cluster_of[c.from.node], cluster_of[c.to.node]);
        if a != b {
            clusters[a].downstream.insert(b);
            clusters[b].upstream.insert(a);
        }
    }
    (guards, clusters, cluster_of)
}

/// Sources without a pace fire once per `react`. Two of them may share a cluster only if the same things
/// downstream hold them back; else one would wait for what holds back the other.
fn add_react_guards(
    graph: &Graph,
    links: &Links,
    order: &[NodeId],
    regions: &[usize],
    guards: &mut Vec<Guard>,
    own: &mut [Option<usize>],
) {
    let plain = without_pace(graph, links, order, own);
    let accumulated = accumulate(graph, links, order, own);
    let mut holding = accumulated.clone();
    for &node in order.iter().rev() {
        for &c in &links.out_of[node] {
            let next = holding[graph.connections[c].to.node].clone();
            holding[node].extend(next);
        }
    }
    let mut shared: BTreeMap<(usize, BTreeSet<usize>), usize> = BTreeMap::new();
    for node in plain {
        let guard = *shared.entry((regions[node], holding[node].clone())).or_insert_with(|| {
            guards.push(Guard::React);
            guards.len() - 1
        });
        own[node] = Some(guard);
    }
}

/// Sources without a pace, and the delays of loops that no source feeds: nothing else would ever start them, or
/// let them rest.
fn without_pace(graph: &Graph, links: &Links, order: &[NodeId], own: &[Option<usize>]) -> Vec<NodeId> {
    let sources = (0..graph.nodes.len()).filter(|n| own[*n].is_none() && is_source(graph, links, *n));
    let mut plain: Vec<NodeId> = sources.collect();
    let mut started = own.to_vec();
    plain.iter().for_each(|n| started[*n] = Some(usize::MAX));
    let reached = accumulate(graph, links, order, &started);
    let delays = (0..graph.nodes.len()).filter(|n| matches!(graph.nodes[*n].kind, NodeKind::Delay(_)));
    plain.extend(delays.filter(|n| reached[*n].is_empty()));
    plain.sort_unstable();
    plain
}

/// All guards upstream of each node. Nested graphs take their inputs together and send their outputs
/// together; around a delay the guards go in a circle until nothing changes.
fn accumulate(graph: &Graph, links: &Links, order: &[NodeId], own: &[Option<usize>]) -> Vec<BTreeSet<usize>> {
    let mut sets: Vec<BTreeSet<usize>> = own.iter().map(|g| g.iter().copied().collect()).collect();
    let mut enter: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); graph.scopes.len()];
    let mut leave: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); graph.scopes.len()];
    loop {
        let mut changed = false;
        for &node in order {
            let mut set = sets[node].clone();
            for &index in &links.into[node] {
                let connection = &graph.connections[index];
                let mut token = sets[connection.from.node].clone();
                for crossing in &connection.crossings {
                    let side = match *crossing {
                        Crossing::Enter(scope) => &mut enter[scope],
                        Crossing::Leave(scope) => &mut leave[scope],
                    };
                    changed |= !token.is_subset(side);
                    side.extend(token);
                    token = side.clone();
                }
                set.extend(token);
            }
            changed |= set.len() > sets[node].len();
            sets[node] = set;
        }
        if !changed {
            return sets;
        }
    }
}
