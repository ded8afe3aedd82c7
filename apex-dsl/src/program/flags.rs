//! Flags of activity, and the places that they stand for.

use crate::graph::NodeId;

/// Something that is known about a node or a token besides their state: a bit of a set in the state of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Flag {
    /// The node is active.
    Active(NodeId),
    /// A token at an input brings activity.
    Gains(NodeId),
    /// A token at an input takes activity away.
    Loses(NodeId),
    /// The node is enabled.
    Enabled(NodeId),
    /// The token for a slot, by the slot's number, carries activity.
    Carries(usize),
}

/// Place of activity in the state of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Spot {
    /// A flag.
    Flag(Flag),
    /// A delay, which keeps the activity of its tokens.
    Held(NodeId),
}

/// Effect of a token on the activity of the node that takes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Carries {
    /// Not at all.
    Nothing,
    /// It activates: it is from `start`.
    Always,
    /// It activates if its sender was active: there is a flag for it.
    Sometimes,
    /// It takes activity away.
    Away,
}
