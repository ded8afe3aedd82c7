//! The program between analysis and Rust: what a graph does when it runs, as data. It is lowered from graph and
//! analysis; the code generator writes it down, and the listing prints it.
//!
//! A program consists of *rows* (nodes, ports, slots, timers, timeouts: [`Wiring`]), of the *conditions* that its
//! dispatcher looks at ([`Bits`]), and of *operations*.

mod activity;
mod bits;
mod carries;
mod claims;
mod clusters;
mod fire;
mod flags;
mod interrupt;
mod lower;
mod op;
mod plan;
mod print;
mod reaction;
mod slots;
mod verify;
mod wiring;

use crate::{
    analyse::ClusterId,
    catalog::ArgSig,
    graph::{Node, NodeKind, PortId},
    index::IdVec,
};
use std::collections::BTreeMap;

pub use bits::{Bits, ClusterRow, MissingRow};
pub use claims::{ActiveScope, Broken, ClaimCheck};
pub use fire::{Arg, Call, CallResult, Deadline, Failing, Fire, ParamOutput, SlotCall};
pub use flags::{Carries, Flag, Spot};
pub use lower::Lower;
pub use op::{Cancel, Op, Ops, Served, Taken};
pub use plan::{BlockId, Plan, Storage, is_buffer, storage};
pub use print::{Lines, numbers};
pub use reaction::{After, Entering, Firing, Poll, Reaction, Receiver, Sender};
pub use wiring::{Entry, Port, Send, Silence, Slot, Timeout, Wiring};

/// A program, the part of one that a thread runs, or the body of an `each`.
pub struct Program<'a> {
    /// Input of the lowering.
    pub lower: Lower<'a>,
    /// Its rows.
    pub wiring: Wiring,
    /// The clusters that the dispatcher looks at.
    pub rows: Vec<ClusterRow>,
    /// Storage of the tokens of each cluster.
    pub plans: IdVec<ClusterId, Plan>,
    /// Operations of clusters.
    pub clusters: IdVec<ClusterId, Ops>,
    /// Operations of slots.
    pub slots: Vec<Served>,
    /// Operations of timeouts.
    pub timeouts: Vec<Ops>,
    /// Operations before the first reaction.
    pub first: Ops,
    /// Operations of `reset`; none if nothing calls it.
    pub reset: Ops,
    /// Operations of `cancel` and `resume`, by their slots.
    pub interrupts: BTreeMap<PortId, Ops>,
    /// The reaction.
    pub reaction: Reaction,
    /// The claims that are looked at while it runs.
    pub claims: Vec<ClaimCheck>,
    /// The nested graphs that can be active.
    pub scopes: Vec<ActiveScope>,
}

/// A program in the making.
struct Lowering<'a> {
    lower: Lower<'a>,
    wiring: Wiring,
}

impl<'a> Program<'a> {
    /// Lowers a program.
    pub fn new(lower: Lower<'a>) -> Self {
        let Lower { graph, analysis, links, .. } = lower;
        let lowering = Lowering { lower, wiring: Wiring::new(lower) };
        let plans: IdVec<ClusterId, Plan> = analysis.clusters.ids().map(|cluster| Plan::new(lower, cluster)).collect();
        let wiring = &lowering.wiring;
        Self {
            lower,
            rows: wiring.bits.rows(graph, analysis, links),
            clusters: analysis.clusters.ids().map(|cluster| lowering.ops_of(cluster, &plans[cluster])).collect(),
            slots: (0..wiring.slots.len()).map(|slot| lowering.served(slot)).collect(),
            timeouts: (0..wiring.timeouts.len()).map(|timeout| lowering.expired(timeout)).collect(),
            first: lowering.first(),
            reset: if lower.has_reset() { lowering.reset() } else { vec![] },
            interrupts: lowering.interrupts().into_iter().collect(),
            reaction: lowering.reaction(),
            claims: lower.claim_checks(),
            scopes: lower.active_scopes(),
            plans,
            wiring: lowering.wiring,
        }
    }

    /// Returns `true` if something happens at a time, so that a late reaction has several instants.
    pub fn has_instants(&self) -> bool {
        !self.wiring.timers.is_empty() || !self.wiring.timeouts.is_empty() || !self.wiring.silences.is_empty()
    }

    /// Returns `true` if the time matters to a program: to its timers, or to a node that may look at it.
    pub fn has_time(&self) -> bool {
        let looks = |args: &[ArgSig]| args.contains(&ArgSig::Ctx);
        let is_told = |node: &Node| match &node.kind {
            NodeKind::Library(library) => {
                let signature = &self.lower.catalog.signatures[library.signature];
                let slots = signature.slots.iter().any(|slot| looks(&slot.args));
                slots || signature.process.as_deref().is_some_and(looks) || node.modifiers.deadline.is_some()
            }
            NodeKind::Each(_) | NodeKind::SetBack => true,
            _ => false,
        };
        self.has_instants() || self.lower.graph.nodes.iter().any(is_told)
    }
}
