//! Rows of the tables of a program with many slots or timeouts, which generated code processes by number.

use core::time::Duration;

/// A token in the state of a program.
pub trait Token {
    /// Returns `true` unless it is ⊥.
    fn is_there(&self) -> bool;
    /// Makes it ⊥.
    fn clear(&mut self);
}

impl<T> Token for Option<T> {
    fn is_there(&self) -> bool {
        self.is_some()
    }

    fn clear(&mut self) {
        *self = None;
    }
}

/// Effects of a token at an event of a node (static data).
#[derive(Debug)]
pub struct Port {
    /// Number of the token.
    pub token: usize,
    /// Slots whose tokens are queued.
    pub queued: &'static [u16],
    /// Conditions "holds a token" that are set.
    pub raises: &'static [u32],
    /// Conditions "is free" that are cleared.
    pub occupies: &'static [u32],
    /// Stamps of connections that are set.
    pub stamps: &'static [u32],
    /// Nodes that lose activity.
    pub takes_away: &'static [u32],
    /// `true` if the token passes activity on.
    pub passes: bool,
    /// Slots whose tokens carry activity if the token does.
    pub carries: &'static [u32],
    /// Nodes whose inputs hold activity if the token carries it.
    pub gains: &'static [u32],
}

impl Port {
    /// Returns the port of a token without connections.
    pub const fn new(token: usize) -> Self {
        Self {
            token,
            queued: &[],
            raises: &[],
            occupies: &[],
            stamps: &[],
            takes_away: &[],
            passes: false,
            carries: &[],
            gains: &[],
        }
    }

    /// Adds slots to which the token goes, and the connections that are then occupied.
    #[must_use]
    pub const fn queues(self, queued: &'static [u16], occupies: &'static [u32]) -> Self {
        Self { queued, occupies, ..self }
    }

    /// Adds inputs to which the token goes.
    #[must_use]
    pub const fn raises(self, raises: &'static [u32]) -> Self {
        Self { raises, ..self }
    }

    /// Adds connections that store the stamp of the token.
    #[must_use]
    pub const fn stamps(self, stamps: &'static [u32]) -> Self {
        Self { stamps, ..self }
    }

    /// Adds nodes that lose activity.
    #[must_use]
    pub const fn takes_away(self, takes_away: &'static [u32]) -> Self {
        Self { takes_away, ..self }
    }

    /// Passes activity on to slots and to nodes with inputs.
    #[must_use]
    pub const fn passes(self, carries: &'static [u32], gains: &'static [u32]) -> Self {
        Self { passes: true, carries, gains, ..self }
    }
}

/// Effect of a token on the activity of a slot's node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Carries {
    /// None.
    Nothing,
    /// Activates the node: the token comes from `start`.
    Always,
    /// Activates the node if the sender was active.
    Sometimes,
    /// Deactivates the node.
    Away,
}

/// Call of a slot (static data).
#[derive(Debug)]
pub struct Slot {
    /// Number of the node.
    pub node: usize,
    /// Range of the node's ports: first and end (exclusive).
    pub ports: (usize, usize),
    /// Conditions for the call.
    pub needs: &'static [u32],
    /// Number of the connection, unless the token comes from another thread group.
    pub connection: Option<usize>,
    /// Condition "is free" of the connection.
    pub frees: Option<usize>,
    /// Effect of the token on the activity of the node.
    pub carries: Carries,
    /// Cluster that may have finished after this call.
    pub settles: Option<usize>,
    /// Stamp of the connection.
    pub stamp: Option<usize>,
}

impl Slot {
    /// Returns a slot of a node with the ports `first..end`.
    pub const fn new(node: usize, first: usize, end: usize, needs: &'static [u32]) -> Self {
        Self {
            node,
            ports: (first, end),
            needs,
            connection: None,
            frees: None,
            carries: Carries::Nothing,
            settles: None,
            stamp: None,
        }
    }

    /// Sets the number of the connection.
    #[must_use]
    pub const fn on(self, connection: usize) -> Self {
        Self { connection: Some(connection), ..self }
    }

    /// Sets the condition "is free" of the connection.
    #[must_use]
    pub const fn frees(self, bit: usize) -> Self {
        Self { frees: Some(bit), ..self }
    }

    /// Declares that the token comes from `start` and activates the node.
    #[must_use]
    pub const fn always_activates(self) -> Self {
        Self { carries: Carries::Always, ..self }
    }

    /// Declares that the token activates the node if its sender was active.
    #[must_use]
    pub const fn activates(self) -> Self {
        Self { carries: Carries::Sometimes, ..self }
    }

    /// Declares that the token deactivates the node.
    #[must_use]
    pub const fn deactivates(self) -> Self {
        Self { carries: Carries::Away, ..self }
    }

    /// Sets the cluster that may have finished after the call.
    #[must_use]
    pub const fn settles(self, cluster: usize) -> Self {
        Self { settles: Some(cluster), ..self }
    }

    /// Sets the stamp of the connection.
    #[must_use]
    pub const fn stamp(self, stamp: usize) -> Self {
        Self { stamp: Some(stamp), ..self }
    }
}

/// Timeout of a node (static data).
#[derive(Debug)]
pub struct Timeout {
    /// Number of the node.
    pub node: usize,
    /// Range of the node's ports: first and end (exclusive).
    pub ports: (usize, usize),
    /// Longest time that the node may be active.
    pub after: Duration,
    /// Conditions under which the event can be triggered.
    pub needs: &'static [u32],
    /// `true` if the node must be enabled.
    pub gated: bool,
}

impl Timeout {
    /// Returns the timeout of a node after `after` nanoseconds.
    pub const fn new(node: usize, first: usize, end: usize, after: u64, needs: &'static [u32], gated: bool) -> Self {
        Self { node, ports: (first, end), after: Duration::from_nanos(after), needs, gated }
    }
}
