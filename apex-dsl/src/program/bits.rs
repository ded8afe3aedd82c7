//! The conditions that decide at run time what is ready, as bits, and the tables over them.

use crate::{
    analyse::{Analysis, ClusterId, Guard, Links},
    graph::{ConnectionId, Flow, Graph, NodeId, NodeKind},
    index::IdVec,
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// The conditions of the dispatcher, by number: for each dispatched cluster its guards, "enabled", and for each
/// connection to another cluster "holds a token" and "free"; for each asynchronous connection that may stay occupied
/// "free" and, if it leads to an input, "holds a token"; for each event of the program "has room".
#[derive(Debug)]
pub struct Bits {
    dispatched: Vec<ClusterId>,
    guards: BTreeMap<usize, usize>,
    enabled: BTreeMap<ClusterId, usize>,
    edges: BTreeMap<(ClusterId, ClusterId), usize>,
    free: BTreeMap<ConnectionId, usize>,
    tokens: BTreeMap<ConnectionId, usize>,
    room: BTreeMap<NodeId, usize>,
    count: usize,
}

/// A cluster that the dispatcher looks at.
#[derive(Debug)]
pub struct ClusterRow {
    /// The condition that it is enabled.
    pub enabled: usize,
    /// The conditions that it waits for; that it takes; that its tokens are there; that its connections are free;
    /// those by which it is notified that they are, and those by which it notifies others.
    pub sets: [Vec<usize>; 6],
    /// The rows of the clusters above it.
    pub above: Vec<usize>,
}

/// A token from an event that a cluster needs besides others.
#[derive(Debug)]
pub struct MissingRow {
    /// Conditions that the other tokens are there.
    pub others: Vec<usize>,
    /// Condition that the token is there.
    pub token: usize,
    /// The connection of the token.
    pub connection: ConnectionId,
}

impl Bits {
    /// Numbers the conditions of a program.
    pub fn new(graph: &Graph, analysis: &Analysis) -> Self {
        let clusters = &analysis.clusters;
        let is_free = |c: &ClusterId| analysis.is_free(graph, &clusters[*c]);
        let mut bits = Self {
            dispatched: clusters.ids().filter(|c| clusters[*c].fires && !is_free(c)).collect(),
            guards: BTreeMap::new(),
            enabled: BTreeMap::new(),
            edges: BTreeMap::new(),
            free: BTreeMap::new(),
            tokens: BTreeMap::new(),
            room: BTreeMap::new(),
            count: 0,
        };
        for cluster in bits.dispatched.clone() {
            for &guard in &clusters[cluster].own_guards {
                if !matches!(analysis.guards[guard], Guard::Token(_) | Guard::Events(_)) {
                    let bit = bits.next();
                    bits.guards.insert(guard, bit);
                }
            }
            let bit = bits.next();
            bits.enabled.insert(cluster, bit);
            for &down in &clusters[cluster].downstream {
                let bit = bits.next();
                bits.next();
                bits.edges.insert((cluster, down), bit);
            }
        }
        for (index, c) in graph.connections.iter_enumerated() {
            if analysis.asynchronous.has_occupancy_bit[index] {
                let bit = bits.next();
                bits.free.insert(index, bit);
            }
            if analysis.asynchronous.live[index] && graph.flow(c) == Flow::ToInput {
                let bit = bits.next();
                bits.tokens.insert(index, bit);
            }
        }
        for (id, node) in graph.nodes.iter_enumerated() {
            if matches!(node.kind, NodeKind::Boundary(PortKind::Event)) {
                let bit = bits.next();
                bits.room.insert(id, bit);
            }
        }
        bits
    }

    fn next(&mut self) -> usize {
        self.count += 1;
        self.count - 1
    }

    /// Number of conditions.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Number of words, of 64 conditions each.
    pub fn words(&self) -> usize {
        // The dispatcher has a bit of its own.
        if self.count == 0 { 0 } else { (self.count + 1).div_ceil(64) }
    }

    /// The clusters that are dispatched, in the order of their rows.
    pub fn dispatched(&self) -> &[ClusterId] {
        &self.dispatched
    }

    /// The number of a guard.
    pub fn guard(&self, guard: usize) -> Option<usize> {
        self.guards.get(&guard).copied()
    }

    /// "has room" of each event of the program.
    pub fn room(&self) -> &BTreeMap<NodeId, usize> {
        &self.room
    }

    /// Returns `true` if no asynchronous connection may stay occupied.
    pub fn is_all_free(&self) -> bool {
        self.free.is_empty()
    }

    /// "free" of an asynchronous connection, if it may stay occupied.
    pub fn free(&self, connection: ConnectionId) -> Option<usize> {
        self.free.get(&connection).copied()
    }

    /// "holds a token" of an asynchronous connection to an input.
    pub fn token(&self, connection: ConnectionId) -> Option<usize> {
        self.tokens.get(&connection).copied()
    }

    /// Descriptions of all conditions, by number.
    pub fn texts(
        &self,
        graph: &Graph,
        clusters: &IdVec<ClusterId, String>,
        guard: &dyn Fn(usize) -> String,
    ) -> Vec<String> {
        let mut texts = vec![String::new(); self.count];
        let connection = |c: ConnectionId| graph.connection_text(c);
        self.guards.iter().for_each(|(g, bit)| texts[*bit] = guard(*g));
        self.enabled.iter().for_each(|(c, bit)| texts[*bit] = format!("{} is enabled", clusters[*c]));
        for ((from, to), bit) in &self.edges {
            let edge = format!("from {} to {}", clusters[*from], clusters[*to]);
            texts[*bit] = format!("tokens {edge}");
            texts[*bit + 1] = format!("room {edge}");
        }
        self.free.iter().for_each(|(c, bit)| texts[*bit] = format!("free: {}", connection(*c)));
        self.tokens.iter().for_each(|(c, bit)| texts[*bit] = format!("token: {}", connection(*c)));
        self.room.iter().for_each(|(node, bit)| texts[*bit] = format!("room: event {}", graph.path(*node)));
        texts
    }

    /// The row of a cluster in the table.
    pub fn row(&self, cluster: ClusterId) -> Option<usize> {
        self.dispatched.binary_search(&cluster).ok()
    }

    /// At first every cluster is enabled and every connection free.
    pub fn initial(&self) -> Vec<usize> {
        let free = self.edges.values().map(|bit| bit + 1);
        self.enabled.values().copied().chain(free).chain(self.free.values().copied()).collect()
    }

    /// The table of clusters.
    pub fn rows(&self, graph: &Graph, analysis: &Analysis, links: &Links) -> Vec<ClusterRow> {
        let rows = self.dispatched.iter().map(|&index| {
            let c = &analysis.clusters[index];
            let mut takes: Vec<usize> = c.own_guards.iter().filter_map(|g| self.guards.get(g).copied()).collect();
            takes.push(self.enabled[&index]);
            takes.extend(c.upstream.iter().map(|up| self.edges[&(*up, index)]));
            let mut waits_for: Vec<usize> = vec![];
            let mut notifies = vec![self.enabled[&index]];
            notifies.extend(c.upstream.iter().map(|up| self.edges[&(*up, index)] + 1));
            for &guard in &c.own_guards {
                match analysis.guards[guard] {
                    Guard::Token(connection) => {
                        takes.push(self.tokens[&connection]);
                        notifies.push(self.free[&connection]);
                    }
                    Guard::Events(node) => {
                        let holding = analysis.asynchronous.holding_back(graph, links, node);
                        waits_for.extend(holding.map(|c| self.free[&c]));
                    }
                    _ => {}
                }
            }
            let sends: Vec<usize> = c.downstream.iter().map(|down| self.edges[&(index, *down)]).collect();
            let occupies: Vec<usize> = sends.iter().map(|bit| bit + 1).collect();
            let mut notified_by = vec![];
            // What a pipelined node sends must be free when it fires (R1), but nobody waits for it afterwards.
            for &down in &c.downstream {
                let free = self.edges[&(index, down)] + 1;
                if is_pipelined(graph, analysis, index, down) { &mut waits_for } else { &mut notified_by }.push(free);
            }
            let outputs = c.sends.iter().map(|c| (*c, graph.connections[*c].from));
            for (connection, from) in outputs.filter(|(_, from)| graph.port(*from).kind == PortKind::Output) {
                let pipelined = graph.nodes[from.node].modifiers.pipelined;
                if pipelined { &mut waits_for } else { &mut notified_by }.extend(self.free(connection));
            }
            let above = above(graph, analysis, index).into_iter().filter_map(|c| self.row(c)).collect();
            ClusterRow {
                enabled: self.enabled[&index],
                sets: [waits_for, takes, sends, occupies, notified_by, notifies],
                above,
            }
        });
        rows.collect()
    }

    /// For each token from an event that a cluster needs: the other tokens that it needs.
    pub fn missing(&self, analysis: &Analysis) -> Vec<MissingRow> {
        let mut missing = vec![];
        for &index in &self.dispatched {
            let c = &analysis.clusters[index];
            let events: Vec<ConnectionId> = c
                .own_guards
                .iter()
                .filter_map(|g| if let Guard::Token(c) = analysis.guards[*g] { Some(c) } else { None })
                .collect();
            let edges: Vec<usize> = c.upstream.iter().map(|up| self.edges[&(*up, index)]).collect();
            for &connection in &events {
                let others = events.iter().filter(|c| **c != connection).map(|c| self.tokens[c]);
                let others: Vec<usize> = others.chain(edges.iter().copied()).collect();
                if !others.is_empty() {
                    missing.push(MissingRow { others, token: self.tokens[&connection], connection });
                }
            }
        }
        missing
    }

    /// Conditions for serving each slot: its node can trigger its events (R5).
    pub fn needs(&self, graph: &Graph, analysis: &Analysis, links: &Links) -> Vec<Vec<usize>> {
        let needs = |connection: &ConnectionId| {
            let node = graph.connections[*connection].to.node;
            let events = analysis.asynchronous.not_yet_taken(graph, links, *connection);
            events.into_iter().filter_map(|c| self.free(c)).chain(self.room.get(&node).copied()).collect()
        };
        analysis.asynchronous.slots.iter().map(needs).collect()
    }
}

/// Returns `true` if all tokens from a cluster to another come from nodes that are free again as soon as they have
/// fired.
fn is_pipelined(graph: &Graph, analysis: &Analysis, cluster: ClusterId, down: ClusterId) -> bool {
    let of = |node: NodeId| analysis.cluster_of[node];
    let synchronous = graph.connections.iter().filter(|c| graph.is_synchronous(c));
    let mut between = synchronous.filter(|c| of(c.from.node) == cluster && of(c.to.node) == down).peekable();
    between.peek().is_some() && between.all(|c| graph.nodes[c.from.node].modifiers.pipelined && c.crossings.is_empty())
}

/// All clusters from which tokens come to `cluster`; behind each stand those from which its own tokens come.
fn above(graph: &Graph, analysis: &Analysis, cluster: ClusterId) -> Vec<ClusterId> {
    fn visit(
        graph: &Graph,
        analysis: &Analysis,
        cluster: ClusterId,
        seen: &mut BTreeSet<ClusterId>,
        order: &mut Vec<ClusterId>,
    ) {
        let relayed = analysis.clusters[cluster].own_guards.iter().filter_map(|g| match analysis.guards[*g] {
            Guard::Token(c) if graph.port(graph.connections[c].from).kind == PortKind::Output => {
                Some(analysis.cluster_of[graph.connections[c].from.node])
            }
            _ => None,
        });
        let ups: Vec<ClusterId> = analysis.clusters[cluster].upstream.iter().copied().chain(relayed).collect();
        for up in ups {
            if seen.insert(up) {
                visit(graph, analysis, up, seen, order);
                order.push(up);
            }
        }
    }
    let mut order = vec![];
    visit(graph, analysis, cluster, &mut BTreeSet::new(), &mut order);
    order.reverse();
    order
}
