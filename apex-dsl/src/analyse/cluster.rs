//! Clusters, what they wait for, and the schedule of their nodes.

use crate::{
    graph::{ConnectionId, Graph, NodeId, PortId},
    index::id,
};
use std::collections::BTreeSet;

id! {
    /// Number of a cluster in [`Analysis::clusters`](super::Analysis::clusters).
    ClusterId
}

/// Condition that a cluster waits for and that the synchronous schedule does not decide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guard {
    /// The timer of a source with `every` or `after`.
    Timer(NodeId),
    /// A token at an input of the program.
    Input(NodeId),
    /// The next reaction, in which sources without a period fire once. Two of them share this guard if they have the
    /// same guards upstream and downstream.
    React,
    /// The token on an asynchronous connection to an input.
    Token(ConnectionId),
    /// The events of this node are enabled, so that it can trigger them (R1).
    Events(NodeId),
}

impl Guard {
    /// The guard as text: `input scan`.
    pub fn text(self, graph: &Graph) -> String {
        match self {
            Self::Timer(node) => {
                let modifiers = &graph.nodes[node].modifiers;
                let every = modifiers.every.map(|period| format!("every {period:?}"));
                let after = modifiers.after.map(|time| format!("after {time:?}"));
                let times: Vec<String> = every.into_iter().chain(after).collect();
                format!("timer of {} ({})", graph.path(node), times.join(" "))
            }
            Self::Token(connection) => format!("event {}", graph.end_name(graph.connections[connection].from)),
            Self::Events(node) => format!("events of {} enabled", graph.path(node)),
            Self::Input(node) => format!("input {}", graph.path(node)),
            Self::React => "each reaction".to_owned(),
        }
    }
}

/// The guards that are tokens of events, by their connections.
pub fn tokens(guards: &[Guard]) -> impl Iterator<Item = (ConnectionId, usize)> {
    let guards = guards.iter().enumerate();
    guards.filter_map(|(g, guard)| if let Guard::Token(c) = guard { Some((*c, g)) } else { None })
}

/// Nodes that fire together.
#[derive(Debug)]
pub struct Cluster {
    /// Region of its nodes.
    pub region: usize,
    /// Its nodes, producers before consumers.
    pub nodes: Vec<NodeId>,
    /// `true` if it can fire at all: all tokens that it waits for can arrive.
    pub fires: bool,
    /// All guards that its nodes depend on.
    pub guards: BTreeSet<usize>,
    /// Guards of its own nodes, which it tests. The clusters upstream have tested the others before they sent their
    /// tokens.
    pub own_guards: Vec<usize>,
    /// Clusters whose tokens it waits for.
    pub upstream: BTreeSet<ClusterId>,
    /// Clusters that wait for its tokens.
    pub downstream: BTreeSet<ClusterId>,
    /// Asynchronous connections that its nodes send on, in the order in which their tokens are emitted.
    pub sends: Vec<ConnectionId>,
    /// Schedule of a firing.
    pub block: Block,
}

impl Cluster {
    /// Nodes in the order in which they fire for the first time.
    pub fn schedule(&self) -> Vec<NodeId> {
        let mut order = vec![];
        let mut blocks: Vec<std::slice::Iter<'_, Step>> = vec![self.block.steps.iter()];
        while let Some(steps) = blocks.last_mut() {
            match steps.next() {
                Some(Step::Fire(node)) => order.push(*node),
                Some(Step::Block(inner)) => blocks.push(inner.steps.iter()),
                Some(Step::Repeat(run)) if run.from == 0 => order.push(run.node),
                Some(Step::Repeat(_)) => {}
                None => drop(blocks.pop()),
            }
        }
        order
    }

    /// Returns `true` if the cluster is in a region with several rates.
    pub fn is_multirate(&self) -> bool {
        matches!(self.block.steps.first(), Some(Step::Repeat(_)))
    }
}

/// Steps that are done if certain tokens are present.
#[derive(Debug, Default, Clone)]
pub struct Block {
    /// Tokens that must be present, in addition to those of the blocks around.
    pub opens: Vec<PortId>,
    /// Steps in order.
    pub steps: Vec<Step>,
}

/// A step of a schedule.
#[derive(Debug, Clone)]
pub enum Step {
    /// A node fires.
    Fire(NodeId),
    /// Steps that are done only if more tokens are present.
    Block(Block),
    /// A node of a region with several rates fires several times, each time if its tokens are present.
    Repeat(Run),
}

/// Consecutive firings of a node in one iteration of a region with several rates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Run {
    /// The node.
    pub node: NodeId,
    /// Number of the first firing.
    pub from: u64,
    /// Number after that of the last firing.
    pub to: u64,
}
