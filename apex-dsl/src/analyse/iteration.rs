//! Iteration of a cluster with several rates: the order in which its nodes fire as often as the balance equations ask.
//!
//! A node may fire when its tokens of this iteration are there. Each node in turn fires as often as it can, until all
//! have fired often enough: a periodic admissible sequential schedule (Lee 1987). Without a loop every node has a
//! single turn. In a loop, a delay with fewer tokens than one iteration takes lets nodes have several turns. If none
//! can fire before all are done, the loop holds too few tokens.

use super::{cluster::Run, links::Links};
use crate::{
    graph::{Graph, NodeId, NodeKind, PortId},
    index::IdVec,
    report::{Diagnostic, Diagnostics},
};
use std::collections::BTreeMap;

/// Maximum number of turns in one iteration: each is a row of a table.
const MAX_TURNS: usize = 10_000;

/// Numbers of firings so far in an iteration.
struct Iteration<'a> {
    graph: &'a Graph,
    links: &'a Links,
    repetitions: &'a IdVec<NodeId, u64>,
    fired: BTreeMap<NodeId, u64>,
    /// A delay, and a number of tokens that it holds instead of those in the source file.
    assumed: Option<(NodeId, u64)>,
}

/// Reason why an iteration has no schedule.
enum Fault {
    /// These nodes wait for each other.
    Stuck(Vec<NodeId>),
    /// The nodes take too many turns.
    Long,
}

/// Order of the firings of `nodes`, which are a cluster. `None` after an error.
pub fn runs(
    graph: &Graph,
    links: &Links,
    repetitions: &IdVec<NodeId, u64>,
    nodes: &[NodeId],
    diagnostics: &mut Diagnostics,
) -> Option<Vec<Run>> {
    let begin = |assumed| {
        let fired = nodes.iter().map(|node| (*node, 0)).collect();
        Iteration { graph, links, repetitions, fired, assumed }
    };
    let waiting = match begin(None).runs(nodes) {
        Ok(runs) => return Some(runs),
        Err(Fault::Long) => {
            let message = format!("one iteration would need more than {MAX_TURNS} turns of nodes");
            let note = "the nodes of a loop take turns if its delay holds few tokens; a delay that holds the tokens of one iteration needs one turn of each";
            diagnostics.push(Diagnostic::error("rates", graph.nodes[nodes[0]].span, message).note(note));
            return None;
        }
        Err(Fault::Stuck(waiting)) => waiting,
    };
    let held = |node: &NodeId| match &graph.nodes[*node].kind {
        NodeKind::Delay(held) => Some((*node, held.len() as u64)),
        _ => None,
    };
    // One of the delays is the cause: the others would do.
    let enough = waiting.iter().filter_map(held).find_map(|(delay, holds)| {
        let mut more = holds + 1..=repetitions[delay];
        let is_enough = |count: &u64| !matches!(begin(Some((delay, *count))).runs(nodes), Err(Fault::Stuck(_)));
        Some((delay, holds, more.find(is_enough)?))
    });
    let (place, message) = match enough {
        Some((delay, holds, needed)) => {
            let tokens = if holds == 1 { "token" } else { "tokens" };
            (delay, format!("this delay holds {holds} {tokens}, but the nodes of its loop can only fire with {needed}"))
        }
        None => (waiting[0], "the delays of a loop hold too few tokens for its nodes to fire".to_owned()),
    };
    diagnostics.push(Diagnostic::error("rates", graph.nodes[place].span, message));
    None
}

impl Iteration<'_> {
    fn runs(mut self, nodes: &[NodeId]) -> Result<Vec<Run>, Fault> {
        let mut runs = vec![];
        loop {
            let turns_before = runs.len();
            for &node in nodes {
                let (from, to) = (self.fired[&node], self.reach(node));
                if to > from {
                    runs.push(Run { node, from, to });
                    self.fired.insert(node, to);
                }
            }
            let waiting: Vec<NodeId> =
                nodes.iter().copied().filter(|node| self.fired[node] < self.repetitions[*node]).collect();
            match runs.len() {
                _ if waiting.is_empty() => return Ok(runs),
                turns if turns == turns_before => return Err(Fault::Stuck(waiting)),
                turns if turns > MAX_TURNS => return Err(Fault::Long),
                _ => {}
            }
        }
    }

    /// Number of firings that the node can have had when it has fired as often as it can.
    fn reach(&self, node: NodeId) -> u64 {
        let inputs = self.links.into[node].iter().map(|c| &self.graph.connections[*c]);
        let allowed = inputs.map(|c| {
            let sent = self.sent(c.from).unwrap_or(u64::MAX);
            match &self.graph.nodes[node].kind {
                // A delay first sends what it holds.
                NodeKind::Delay(held) => {
                    let assumed = self.assumed.filter(|(delay, _)| *delay == node).map(|(_, count)| count);
                    sent.saturating_add(assumed.unwrap_or(held.len() as u64))
                }
                _ => sent / self.graph.port(c.to).rate as u64,
            }
        });
        allowed.min().unwrap_or(u64::MAX).min(self.repetitions[node])
    }

    /// Number of tokens that a port has sent in this iteration; `None` if its node is in another cluster, which has
    /// fired.
    fn sent(&self, end: PortId) -> Option<u64> {
        let fired = self.fired.get(&end.node)?;
        Some(fired * self.graph.port(end).rate as u64)
    }
}
