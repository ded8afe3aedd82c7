//! The asynchronous and active half of a program as data: where the tokens of a port go, where activity goes with
//! them, and what the token on a connection does to the node of a slot.
//!
//! It is made once from graph and analysis.

use super::{
    bits::Bits,
    flags::{Carries, Flag},
    lower::Lower,
};
use crate::{
    analyse::{Analysis, Delivery, Guard, may_get_stuck, takes_activity},
    graph::{ConnectionId, Flow, Graph, NodeId, NodeKind, PortId},
    syntax::tree::PortKind,
};
use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};

/// Effects of a token at a port outside its region.
#[derive(Debug)]
pub struct Port {
    /// The port.
    pub end: PortId,
    /// An active connection leads on from it, and this row says what that does.
    pub is_active: bool,
    /// Set with each token: it takes activity away from its receiver.
    pub takes_away: Vec<Flag>,
    /// Set when activity goes along with a token; `None` if it stays with the node.
    pub passes: Option<Vec<Flag>>,
    /// Asynchronous connections, in the order of the text.
    pub sends: Vec<Send>,
}

/// An asynchronous connection, as its sender sees it.
#[derive(Debug)]
pub struct Send {
    /// The connection.
    pub connection: ConnectionId,
    /// The slot whose token is queued; `None` if the token itself tells that it waits.
    pub queued: Option<usize>,
    /// The condition that a token is there.
    pub raises: Option<usize>,
    /// The condition that the connection is free.
    pub occupies: Option<usize>,
    /// It is sent with ⊥, too.
    pub absent: bool,
}

/// The call of a slot because of the token on a connection.
#[derive(Debug)]
pub struct Slot {
    /// The connection.
    pub connection: ConnectionId,
    /// The node of the slot.
    pub node: NodeId,
    /// The condition that the connection is free again.
    pub frees: Option<usize>,
    /// Activity that its token may carry.
    pub carries: Carries,
    /// The cluster, by its row, that may have been waiting for this call to count as finished.
    pub settles: Option<usize>,
    /// The conditions under which it may be called: its node can trigger its events (R5).
    pub needs: Vec<usize>,
}

impl Slot {
    /// Effect of the token on the activity of the node. Where the program ends, the activity stays with the token.
    pub fn carries_to(&self, graph: &Graph) -> Carries {
        match (self.carries, &graph.nodes[self.node].kind) {
            (Carries::Sometimes, NodeKind::Exit(_)) => Carries::Nothing,
            (carries, _) => carries,
        }
    }
}

/// The `timeout` of a node: how long it may be active. Or the `after` of a state: how long a machine may be in it.
#[derive(Debug)]
pub struct Timeout {
    /// The node.
    pub node: NodeId,
    /// Number of the `after` in the machine; `None` if it is the `timeout` of a node.
    pub wait: Option<usize>,
    /// The longest time.
    pub after: Duration,
    /// The conditions under which its event can be triggered.
    pub needs: Vec<usize>,
}

/// A guard that holds after a silence, too.
#[derive(Debug)]
pub struct Silence {
    /// The guard, by its number in the analysis.
    pub guard: usize,
    /// Place at which the token is missed.
    pub entry: Entry,
    /// The groups of nodes that must be called then, by their numbers in [`Wiring::patience`].
    pub groups: Vec<usize>,
}

/// Place of the token that did not come.
#[derive(Debug)]
#[allow(missing_docs, reason = "the fields are called what they are")]
pub enum Entry {
    /// At an input of the program. `raises` is the condition that a token is there.
    Input { raises: usize },
    /// On an asynchronous connection. `raises` is the condition that a token is there. While one of the conditions
    /// `free` does not hold, a token of this port is still in use.
    Connection { connection: ConnectionId, raises: usize, occupies: usize, free: Vec<usize> },
}

/// All of it.
#[derive(Debug)]
pub struct Wiring {
    /// The numbers of the conditions.
    pub bits: Bits,
    /// The nodes that can be active.
    pub nodes: BTreeSet<NodeId>,
    /// The rows of each node: activity goes with the first token in the order of the ports (A5), tokens are sent in
    /// the order of the text (R7).
    ports: BTreeMap<NodeId, Vec<Port>>,
    /// The slots by number.
    pub slots: Vec<Slot>,
    /// The sources with timers, and the conditions that these are due.
    pub timers: Vec<(NodeId, usize)>,
    /// The timeouts, in the order of the nodes.
    pub timeouts: Vec<Timeout>,
    /// The silences, in the order of their guards.
    pub silences: Vec<Silence>,
    /// Groups of nodes that miss the same tokens. Each node has a time for which it does without.
    pub patience: Vec<Vec<NodeId>>,
    /// Slot tokens may wait for one another forever, which the program then reports.
    pub may_get_stuck: bool,
}

impl Wiring {
    /// The wiring of a program or of a part of one.
    pub fn new(lower: Lower<'_>) -> Self {
        let Lower { graph, analysis, links, .. } = lower;
        let bits = Bits::new(graph, analysis);
        let needs = bits.needs(graph, analysis, links);
        let slots = analysis.asynchronous.slots.iter().zip(needs).map(|(&connection, needs)| {
            let c = &graph.connections[connection];
            let frees = bits.free(connection);
            // What an output sent on is notified as soon as the slot took it.
            let settles = graph.port(c.from).kind == PortKind::Output && frees.is_some();
            Slot {
                connection,
                node: c.to.node,
                frees,
                carries: lower.carries(connection),
                settles: settles.then(|| bits.row(analysis.cluster_of[c.from.node])).flatten(),
                needs,
            }
        });
        let slots = slots.collect();
        let rows = graph.nodes.ids().map(|node| (node, rows(lower, &bits, node)));
        let ports = rows.filter(|(_, rows)| !rows.is_empty()).collect();
        let is_plain = |node: &NodeId| !graph.nodes[*node].is_delay();
        let nodes = analysis.active.iter().copied().filter(is_plain).collect();
        let timers = analysis.guards.iter().enumerate().filter_map(|(guard, what)| match what {
            Guard::Timer(node) => Some((*node, bits.guard(guard)?)),
            _ => None,
        });
        let mut timers: Vec<(NodeId, usize)> = timers.collect();
        timers.sort_unstable();
        let timeouts = graph.nodes.ids().flat_map(|node| {
            let active = lower.timeout(node).map(|after| (None, after));
            let waits = lower.waits(node).iter().enumerate().map(|(number, wait)| (Some(number), wait.after));
            active.into_iter().chain(waits).map(move |(wait, after)| (node, wait, after))
        });
        let timeouts = timeouts.map(|(node, wait, after)| {
            let holding = analysis.asynchronous.holding_back(graph, links, node);
            let needs = holding.filter_map(|connection| bits.free(connection)).collect();
            Timeout { node, wait, after, needs }
        });
        let timeouts = timeouts.collect();
        let (silences, patience) = silences(graph, analysis, &bits);
        let may_get_stuck = may_get_stuck(graph, analysis);
        Self { bits, nodes, ports, slots, timers, timeouts, silences, patience, may_get_stuck }
    }

    /// The number of the silence of a guard.
    pub fn silence(&self, guard: usize) -> Option<usize> {
        self.silences.binary_search_by_key(&guard, |silence| silence.guard).ok()
    }

    /// The nodes that must be called when a silence has lasted too long.
    pub fn missed_by(&self, silence: &Silence) -> impl Iterator<Item = NodeId> {
        silence.groups.iter().flat_map(|group| &self.patience[*group]).copied()
    }

    /// The number of a source's timer.
    pub fn timer(&self, node: NodeId) -> Option<usize> {
        self.timers.binary_search_by_key(&node, |(source, _)| *source).ok()
    }

    /// The number of a node's timeout.
    pub fn timeout(&self, node: NodeId) -> Option<usize> {
        self.timeout_of(node, None)
    }

    /// The number of the first `after` of a state machine.
    pub fn first_wait(&self, machine: NodeId) -> Option<usize> {
        self.timeout_of(machine, Some(0))
    }

    fn timeout_of(&self, node: NodeId, wait: Option<usize>) -> Option<usize> {
        self.timeouts.binary_search_by_key(&(node, wait), |timeout| (timeout.node, timeout.wait)).ok()
    }

    /// The timers have an agenda: few of them are as fast looked at themselves.
    pub fn has_agenda(&self) -> bool {
        const FEWEST: usize = 3;
        self.timers.len() + self.timeouts.len() + self.silences.len() >= FEWEST
    }

    /// Returns `true` if the program has rows, which the functions of the runtime work on.
    pub fn has_rows(&self) -> bool {
        !self.slots.is_empty() || !self.ports.is_empty() || !self.nodes.is_empty() || !self.timeouts.is_empty()
    }

    /// The rows of all nodes.
    pub fn ports(&self) -> impl Iterator<Item = &Port> {
        self.ports.values().flatten()
    }

    /// The row of a port.
    pub fn port(&self, end: PortId) -> Option<&Port> {
        self.of(end.node).iter().find(|port| port.end == end)
    }

    /// The rows of a node.
    pub fn of(&self, node: NodeId) -> &[Port] {
        self.ports.get(&node).map_or(&[], Vec::as_slice)
    }
}

/// The silences, and the groups of nodes that miss the same tokens.
fn silences(graph: &Graph, analysis: &Analysis, bits: &Bits) -> (Vec<Silence>, Vec<Vec<NodeId>>) {
    let missed = analysis.silences.iter().filter_map(|silence| {
        let entry = entry(graph, analysis, bits, silence.guard)?;
        Some((Silence { guard: silence.guard, entry, groups: vec![] }, &silence.nodes))
    });
    let (mut silences, nodes): (Vec<Silence>, Vec<&Vec<NodeId>>) = missed.unzip();
    let mut misses: BTreeMap<NodeId, Vec<usize>> = BTreeMap::new();
    for (silence, nodes) in nodes.into_iter().enumerate() {
        nodes.iter().for_each(|node| misses.entry(*node).or_default().push(silence));
    }
    let mut groups: BTreeMap<Vec<usize>, Vec<NodeId>> = BTreeMap::new();
    for (node, silences) in misses {
        groups.entry(silences).or_default().push(node);
    }
    for (group, missed) in groups.keys().enumerate() {
        missed.iter().for_each(|silence| silences[*silence].groups.push(group));
    }
    (silences, groups.into_values().collect())
}

/// Place at which the token of a guard is missed.
fn entry(graph: &Graph, analysis: &Analysis, bits: &Bits, guard: usize) -> Option<Entry> {
    match analysis.guards[guard] {
        Guard::Input(_) => Some(Entry::Input { raises: bits.guard(guard)? }),
        Guard::Token(connection) => {
            let from = graph.connections[connection].from;
            let of_port = analysis.links.sends[from.node].iter().filter(|c| graph.connections[**c].from == from);
            let free = of_port.filter_map(|c| bits.free(*c)).collect();
            let (raises, occupies) = (bits.token(connection)?, bits.free(connection)?);
            Some(Entry::Connection { connection, raises, occupies, free })
        }
        Guard::Timer(_) | Guard::React | Guard::Events(_) => None,
    }
}

/// The rows of a node. Both orders are kept: a row says what its port does with activity unless an earlier one did.
fn rows(lower: Lower<'_>, bits: &Bits, node: NodeId) -> Vec<Port> {
    let Lower { graph, analysis, links, .. } = lower;
    let from = |c: &ConnectionId| graph.connections[*c].from;
    let sends = links.sends[node].chunk_by(|a, b| from(a) == from(b));
    let active: BTreeSet<PortId> =
        links.from(node).filter(|c| graph.connections[*c].active).map(|c| from(&c)).collect();
    let mut active = active.into_iter().peekable();
    let mut rows = vec![];
    for connections in sends {
        let end = from(&connections[0]);
        while let Some(before) = active.next_if(|before| *before < end) {
            rows.push(passing(lower, before));
        }
        let mut row = match active.next_if(|next| *next == end) {
            Some(end) => passing(lower, end),
            None => Port { end, is_active: false, takes_away: vec![], passes: None, sends: vec![] },
        };
        row.sends.extend(connections.iter().map(|connection| send(graph, analysis, bits, *connection)));
        rows.push(row);
    }
    rows.extend(active.map(|end| passing(lower, end)));
    rows
}

fn send(graph: &Graph, analysis: &Analysis, bits: &Bits, connection: ConnectionId) -> Send {
    let raises = bits.token(connection);
    let is_queued = analysis.asynchronous.delivery == Delivery::Queued && raises.is_none();
    Send {
        connection,
        queued: is_queued.then(|| analysis.asynchronous.slot(connection)),
        raises,
        occupies: bits.free(connection),
        absent: carries_missing(graph, connection),
    }
}

/// Effect of a token at `end` on activity.
fn passing(lower: Lower<'_>, end: PortId) -> Port {
    let Lower { graph, links, .. } = lower;
    let is_meant = |c: &ConnectionId| graph.connections[*c].active && graph.connections[*c].from == end;
    let mut connections: Vec<ConnectionId> = links.from(end.node).filter(is_meant).collect();
    connections.sort_unstable();
    let (mut along, mut takes_away) = (vec![], vec![]);
    for connection in connections {
        let c = &graph.connections[connection];
        match lower.carries(connection) {
            Carries::Sometimes => along.push(lower.flag(connection)),
            Carries::Away if graph.flow(c) != Flow::ToSlot => takes_away.push(Flag::Loses(c.to.node)),
            _ => {}
        }
    }
    let leaves = lower.is_active(end.node) && !takes_activity(graph, lower.catalog, end.node);
    // A delay keeps what its tokens carry, not what it is.
    let leaves = leaves || graph.nodes[end.node].is_delay();
    Port { end, is_active: true, takes_away, passes: leaves.then_some(along), sends: vec![] }
}

/// Returns `true` if an asynchronous connection of a part carries ⊥, because it stands for synchronous data flow.
fn carries_missing(graph: &Graph, connection: ConnectionId) -> bool {
    let c = &graph.connections[connection];
    match (&graph.nodes[c.from.node].kind, &graph.nodes[c.to.node].kind) {
        (_, NodeKind::Sender(_)) => graph.port(c.to).optional,
        (NodeKind::Receiver(_), _) => graph.port(c.from).optional && graph.flow(c) == Flow::ToInput && !c.relayed,
        _ => false,
    }
}
