//! Input of the lowering.

use super::flags::{Flag, Spot};
use crate::{
    analyse::{Analysis, ClusterId, Delivery, Links, is_source},
    catalog::{Catalog, MachineSig, Signature, WaitSig},
    claims::Decided,
    graph::{ConnectionId, Graph, Node, NodeId, NodeKind, PortId, Standard},
    syntax::tree::PortKind,
};
use std::time::Duration;

/// Input of the lowering of a program, of the part of a thread group, or of the body of an `each`.
#[derive(Clone, Copy)]
pub struct Lower<'a> {
    /// The graph.
    pub graph: &'a Graph,
    /// Its analysis.
    pub analysis: &'a Analysis,
    /// Its connections, by node.
    pub links: &'a Links,
    /// The node types.
    pub catalog: &'a Catalog,
    /// Verdicts on its claims; none in a part of a program and in the body of an `each`.
    claims: Option<&'a Decided>,
    /// The program checks claims about activity.
    checks_claims: bool,
}

impl<'a> Lower<'a> {
    /// The input of a graph with its analysis.
    pub fn new(graph: &'a Graph, analysis: &'a Analysis, catalog: &'a Catalog, claims: Option<&'a Decided>) -> Self {
        let checks_claims = claims.is_some_and(|claims| !claims.undecided().is_empty());
        Self { graph, analysis, links: &analysis.links, catalog, claims, checks_claims }
    }

    /// Returns `true` if activity can reach a node.
    pub fn is_active(self, node: NodeId) -> bool {
        self.analysis.active.contains(&node)
    }

    /// Signature of a node of the catalog.
    pub fn signature(self, node: NodeId) -> Option<&'a Signature> {
        match &self.graph.nodes[node].kind {
            NodeKind::Library(library) => Some(&self.catalog.signatures[library.signature]),
            _ => None,
        }
    }

    /// The claims about activity that the program looks at while it runs.
    pub fn undecided(self) -> Vec<usize> {
        self.claims.map(Decided::undecided).unwrap_or_default()
    }

    /// Returns `true` if the program checks claims about activity.
    pub fn checks_claims(self) -> bool {
        self.checks_claims
    }

    /// The `timeout` of a node, if it can come.
    pub fn timeout(self, node: NodeId) -> Option<Duration> {
        let timeout = self.graph.nodes[node].modifiers.timeout?;
        let comes = self.is_active(node) || self.watches_silence(node).is_some();
        comes.then_some(timeout)
    }

    /// The `timeout` of a source that activity never comes to: so long it may send nothing.
    pub fn watches_silence(self, node: NodeId) -> Option<Duration> {
        let watches = is_source(self.graph, self.catalog, self.links, node) && !self.is_active(node);
        self.graph.nodes[node].modifiers.timeout.filter(|_| watches)
    }

    /// The number of a connection's stamp, if it is kept.
    pub fn stamp(self, connection: ConnectionId) -> Option<usize> {
        self.analysis.stamps.number(connection)
    }

    /// Returns `true` if clusters downstream need the time at which a cluster's source fired.
    pub fn leaves_stamp(self, cluster: ClusterId) -> bool {
        let down = &self.analysis.clusters[cluster].downstream;
        down.iter().any(|c| self.analysis.stamps.clusters.contains(c))
    }

    /// The connection into an input.
    pub fn connection(self, to: PortId) -> Option<ConnectionId> {
        self.links.inputs[to.node].iter().copied().find(|c| self.graph.connections[*c].to == to)
    }

    /// Origin of the tokens of an input.
    pub fn incoming(self, to: PortId) -> Option<PortId> {
        self.connection(to).map(|c| self.graph.connections[c].from)
    }

    /// The input of a parameter, if a token arrives at it.
    pub fn param_source(self, node: NodeId, param: usize) -> Option<PortId> {
        let ports = &self.graph.nodes[node].ports;
        let port = ports.iter().position(|p| p.parameter == Some(param) && p.kind == PortKind::Input)?;
        let to = PortId { node, port };
        self.incoming(to).map(|_| to)
    }

    /// Returns `true` if observers are notified of a node's activity. They are not if the node only passes tokens on.
    pub fn is_observed(self, node: NodeId) -> bool {
        use NodeKind::{Interrupt, Receiver, Relay, Sender};
        !matches!(self.graph.nodes[node].kind, Relay | Interrupt(_) | Sender(_) | Receiver(_))
    }

    /// The state machine that a node is.
    pub fn machine(self, node: NodeId) -> Option<&'a MachineSig> {
        self.signature(node).and_then(|signature| signature.machine.as_ref())
    }

    /// The times after which a state machine leaves states by itself.
    pub fn waits(self, node: NodeId) -> &'a [WaitSig] {
        self.machine(node).map_or(&[], |machine| &machine.waits)
    }

    /// Events that the moves of a state machine trigger.
    pub fn moved(self, node: NodeId) -> impl Iterator<Item = PortId> + 'a {
        self.machine(node).into_iter().flat_map(|machine| &machine.moved).map(move |port| PortId { node, port: *port })
    }

    /// Place of the activity of a node.
    pub fn spot(self, node: NodeId) -> Spot {
        match self.graph.nodes[node].is_delay() {
            true => Spot::Held(node),
            false => Spot::Flag(Flag::Active(node)),
        }
    }

    /// Returns `true` if an event is connected.
    pub fn is_sent_event(self, end: PortId) -> bool {
        self.graph.port(end).kind == PortKind::Event
            && self.links.sends[end.node].iter().any(|c| self.graph.connections[*c].from == end)
    }

    /// An event that every node has, if it is connected.
    pub fn standard_event(self, node: NodeId, standard: Standard) -> Option<PortId> {
        let end = PortId { node, port: self.graph.nodes[node].standard(standard)? };
        self.is_sent_event(end).then_some(end)
    }

    /// Returns `true` if slots are called at all.
    pub fn has_slots(self) -> bool {
        !self.analysis.asynchronous.slots.is_empty()
    }

    /// Returns `true` if tokens for slots are queued.
    pub fn has_queue(self) -> bool {
        self.analysis.asynchronous.delivery == Delivery::Queued && self.has_slots()
    }

    /// Returns `true` if a reaction might not end, so that its steps are counted.
    pub fn is_endless(self) -> bool {
        self.analysis.asynchronous.endless
    }

    /// Returns `true` if a token can end the program.
    pub fn has_exit(self) -> bool {
        self.graph.nodes.iter().any(|n| matches!(n.kind, NodeKind::Exit(_)))
    }

    /// Returns `true` if a token can take all activity away and trigger `start` again.
    pub fn has_reset(self) -> bool {
        self.graph.nodes.iter().any(|n| matches!(n.kind, NodeKind::Reset))
    }

    /// Returns `true` if something happens before the first reaction.
    pub fn has_start(self) -> bool {
        let started = |n: &Node| n.starts_active || matches!(n.kind, NodeKind::Start);
        let graph = self.graph;
        let timed = |node: NodeId| self.watches_silence(node).is_some() || !self.waits(node).is_empty();
        graph.nodes.iter().any(started) || graph.nodes.ids().any(timed)
    }

    /// Returns `true` if a port takes or sends an array of tokens at once.
    pub fn is_batched(self, end: PortId) -> bool {
        self.signature(end.node)
            .is_some_and(|signature| signature.ports.get(end.port).is_some() && signature.is_batched(end.port))
    }
}
