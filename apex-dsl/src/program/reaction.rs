//! Lowering of a reaction: what each of its rounds looks at, which clusters fire, and which slots are served.

use super::{Entry, Lowering, Op, Ops};
use crate::{
    analyse::{ClusterId, Guard, at_start},
    graph::{CellEnd, NodeId, NodeKind, PortId},
    syntax::tree::PortKind,
};

/// A reaction. It consists of rounds: each polls for news, fires the clusters that are ready, and serves slots, until
/// nothing is left to do.
#[derive(Debug)]
pub struct Reaction {
    /// Service of slots after `start`, before the first reaction; `None` if nothing starts.
    pub start: Option<After>,
    /// Conditions that are raised once: sources without a period.
    pub once: Vec<usize>,
    /// Clusters that fire once, before the rounds.
    pub before: Vec<Firing>,
    /// Polls of each round.
    pub polls: Vec<Poll>,
    /// The clusters of a round, in their order.
    pub firings: Vec<Firing>,
    /// The reaction has rounds. Otherwise it is over when `before` has fired.
    pub has_rounds: bool,
    /// Slots that may have been left when the steps of the reaction before were used up.
    pub left: Ops,
}

/// A cluster in a reaction.
#[derive(Debug)]
pub struct Firing {
    /// The cluster.
    pub cluster: ClusterId,
    /// Its row in the table of the dispatcher; without one it fires once in a reaction.
    pub row: Option<usize>,
    /// Service of slots when it has fired.
    pub served: After,
}

/// Service of slots when something has sent tokens.
#[derive(Debug)]
pub enum After {
    /// All slots in the queue.
    Queue,
    /// These slots.
    Slots(Ops),
}

impl After {
    /// Nothing.
    pub const NOTHING: Self = Self::Slots(vec![]);
}

/// Something that may have happened since it was last polled.
#[derive(Debug)]
#[allow(missing_docs, reason = "the fields are called what they are")]
pub enum Poll {
    /// An event of the program has been taken out: the condition is raised.
    Room { event: NodeId, bit: usize },
    /// A token has been put in: the condition is raised.
    Input { input: NodeId, bit: usize },
    /// Timers are due.
    Timers,
    /// Tokens have been put into slots of the program. They enter in the order in which they were put in.
    Slots(Vec<Entering>),
    /// A token is on its way to another thread group, or has arrived there.
    Sender(Sender),
    /// A token has come from another thread group, or all that it caused has finished.
    Receiver(Receiver),
    /// The time has gone back since the event was last triggered.
    SetBack(Entering),
}

/// Entry of a token at a node, as soon as its connections are free.
#[derive(Debug)]
pub struct Entering {
    /// The node.
    pub node: NodeId,
    /// Conditions that its connections are free.
    pub free: Vec<usize>,
    /// Operations when it enters.
    pub then: Ops,
}

/// End of a cell from which tokens go to another thread group.
#[derive(Debug)]
pub struct Sender {
    /// Its node.
    pub node: NodeId,
    /// The cell.
    pub end: CellEnd,
    /// The port whose tokens go.
    pub from: PortId,
    /// The condition that the connection to the node is free.
    pub free: usize,
    /// The condition that a token is there.
    pub token: usize,
    /// Its tokens may carry activity.
    pub carries: bool,
    /// The stamp of the connection.
    pub stamp: Option<usize>,
    /// The cluster, by its row, that counts as finished when the token has been taken.
    pub settles: Option<usize>,
}

/// End of a cell at which tokens come from another thread group.
#[derive(Debug)]
pub struct Receiver {
    /// Its node.
    pub node: NodeId,
    /// The cell.
    pub end: CellEnd,
    /// Conditions that its connections are free.
    pub free: Vec<usize>,
    /// Something other than a token from the cell may occupy the connections: the end of a silence.
    pub is_silent: bool,
    /// Its tokens may carry activity.
    pub carries: bool,
    /// The time at which the source of a token fired is needed.
    pub is_stamped: bool,
    /// Operations for a token: activity passes; the token is sent; slots are served.
    pub then: [Ops; 3],
}

impl Lowering<'_> {
    /// The reaction.
    pub fn reaction(&self) -> Reaction {
        let analysis = self.lower.analysis;
        let bits = &self.wiring.bits;
        let polls = self.polls();
        let expires = !self.wiring.timeouts.is_empty() || !self.wiring.silences.is_empty();
        let has_rounds = !bits.dispatched().is_empty() || !polls.is_empty() || expires;
        let any_stays = !bits.is_all_free();
        // Slots see in which order clusters fire: that of the text.
        let ordered = any_stays || self.lower.has_slots();
        let firings = analysis.clusters.iter_enumerated().filter(|(_, c)| c.fires).map(|(cluster, c)| {
            let served = match self.lower.has_queue() {
                false => After::Slots(self.deliver(&c.sends)),
                true if c.sends.is_empty() && !any_stays => After::NOTHING,
                true => After::Queue,
            };
            Firing { cluster, row: bits.row(cluster), served }
        });
        let (firings, before) = firings.partition(|firing| has_rounds && (firing.row.is_some() || ordered));
        let start = self.lower.has_start().then(|| match self.lower.has_queue() {
            true => After::Queue,
            false => After::Slots(self.deliver(&at_start(self.lower.graph, analysis))),
        });
        let guards = analysis.guards.iter().enumerate().filter(|(_, guard)| **guard == Guard::React);
        let once = guards.filter_map(|(guard, _)| bits.guard(guard)).collect();
        let left = if self.lower.is_endless() { self.deliver(&analysis.asynchronous.slots) } else { vec![] };
        Reaction { start, once, before, polls, firings, has_rounds, left }
    }

    /// Polls of each round.
    fn polls(&self) -> Vec<Poll> {
        let (graph, bits) = (self.lower.graph, &self.wiring.bits);
        let rooms = bits.room().iter().map(|(event, bit)| Poll::Room { event: *event, bit: *bit });
        let inputs = self.lower.analysis.guards.iter().enumerate().filter_map(|(guard, what)| match what {
            Guard::Input(input) => Some(Poll::Input { input: *input, bit: bits.guard(guard)? }),
            _ => None,
        });
        let mut polls: Vec<Poll> = rooms.chain(inputs).collect();
        if !self.wiring.timers.is_empty() {
            polls.push(Poll::Timers);
        }
        let slots: Vec<NodeId> = graph.nodes.ids().filter(|node| self.is_entered(*node)).collect();
        let enter = |node: &NodeId| Entering { node: *node, free: self.free_to_send(*node), then: self.sent(*node) };
        if slots.len() > 1 {
            polls.push(Poll::Slots(slots.iter().map(enter).collect()));
        }
        for (id, node) in graph.nodes.iter_enumerated() {
            match node.kind {
                NodeKind::Boundary(_) if slots == [id] => polls.push(Poll::Slots(vec![enter(&id)])),
                NodeKind::Sender(end) => polls.extend(self.sender(id, end).map(Poll::Sender)),
                NodeKind::Receiver(end) => polls.push(Poll::Receiver(self.receiver(id, end))),
                NodeKind::SetBack => {
                    let trigger = Op::Trigger(PortId { node: id, port: 0 });
                    let then = [trigger].into_iter().chain(self.sent(id)).collect();
                    polls.push(Poll::SetBack(Entering { node: id, free: self.free_to_send(id), then }));
                }
                _ => {}
            }
        }
        polls
    }

    /// A token of a node that does not fire is sent, and slots are served.
    fn sent(&self, node: NodeId) -> Ops {
        let serves = self.deliver(&self.lower.links.sends[node]);
        self.emit(node, false).into_iter().chain(serves).collect()
    }

    /// Returns `true` for a slot of the program whose tokens can go on.
    fn is_entered(&self, node: NodeId) -> bool {
        let is_slot = matches!(self.lower.graph.nodes[node].kind, NodeKind::Boundary(PortKind::Slot));
        is_slot && !self.lower.links.sends[node].is_empty()
    }

    /// The conditions that all connections on which a node sends are free.
    fn free_to_send(&self, node: NodeId) -> Vec<usize> {
        self.lower.links.sends[node].iter().filter_map(|c| self.wiring.bits.free(*c)).collect()
    }

    fn sender(&self, node: NodeId, end: CellEnd) -> Option<Sender> {
        let (graph, bits) = (self.lower.graph, &self.wiring.bits);
        let connection = *self.lower.links.inputs[node].first()?;
        let from = graph.connections[connection].from;
        let is_output = graph.port(from).kind == PortKind::Output;
        Some(Sender {
            node,
            end,
            from,
            free: bits.free(connection)?,
            token: bits.token(connection)?,
            carries: self.lower.is_active(node) && !end.takes_activity,
            stamp: self.lower.stamp(connection),
            settles: is_output.then(|| bits.row(self.lower.analysis.cluster_of[from.node])).flatten(),
        })
    }

    fn receiver(&self, node: NodeId, end: CellEnd) -> Receiver {
        let graph = self.lower.graph;
        let of_port = PortId { node, port: 0 };
        let is_silent = self.wiring.silences.iter().any(|silence| {
            matches!(&silence.entry, Entry::Connection { connection, .. } if graph.connections[*connection].from == of_port)
        });
        let sends = &self.lower.links.sends[node];
        Receiver {
            node,
            end,
            free: self.free_to_send(node),
            is_silent,
            carries: self.lower.is_active(node) && !end.takes_activity,
            is_stamped: sends.iter().any(|c| self.lower.stamp(*c).is_some()),
            then: [self.pass_activity(node, &|_| true), self.emit(node, false), self.deliver(sends)],
        }
    }
}
