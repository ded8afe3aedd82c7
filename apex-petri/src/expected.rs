//! Changes of activity that a record has to show.

use apex_dsl::graph::NodeId;
use std::collections::{BTreeMap, VecDeque};

/// A change of activity that should be recorded.
pub struct Change {
    pub active: bool,
    /// Step in which it happened.
    pub step: usize,
    /// `true` for initial activity, which is recorded before anything else, or not at all.
    pub optional: bool,
}

/// Changes of activity that have not been recorded yet, in their order for each node.
#[derive(Default)]
pub struct Expected(BTreeMap<NodeId, VecDeque<Change>>);

impl Expected {
    /// Adds a change.
    pub fn add(&mut self, node: NodeId, change: Change) {
        self.0.entry(node).or_default().push_back(change);
    }

    /// Drops initial activity that was not recorded.
    pub fn forget_optional(&mut self) {
        self.0.values_mut().for_each(|changes| changes.retain(|c| !c.optional));
    }

    /// Takes the next change of a node if it is this one. Returns `true` then.
    pub fn takes(&mut self, node: NodeId, active: bool) -> bool {
        let Some(changes) = self.0.get_mut(&node) else { return false };
        // Initial activity that is missing in the record is skipped.
        while changes.front().is_some_and(|c| c.optional && c.active != active) {
            changes.pop_front();
        }
        let same = changes.front().is_some_and(|c| c.active == active);
        if same {
            changes.pop_front();
        }
        same
    }

    /// A change that has to be recorded.
    pub fn open(&self) -> Option<(NodeId, &Change)> {
        self.0.iter().find_map(|(node, changes)| changes.iter().find(|c| !c.optional).map(|c| (*node, c)))
    }
}
