//! Rows of the tables of a program with many slots or timeouts: generated code serves them by number.

use core::time::Duration;

/// A token that lies in the state of a program.
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
    /// Conditions "holds a token" that begin to hold.
    pub raises: &'static [u32],
    /// Conditions "is free" that end.
    pub occupies: &'static [u32],
    /// Stamps of connections that are set.
    pub stamps: &'static [u32],
    /// Nodes that activity is taken from.
    pub takes_away: &'static [u32],
    /// Activity goes along.
    pub passes: bool,
    /// Slots whose tokens then carry activity.
    pub carries: &'static [u32],
    /// Nodes whose inputs then hold activity.
    pub gains: &'static [u32],
}

impl Port {
    /// The port of a token that goes nowhere yet.
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

    /// It goes to slots, over connections that are then occupied.
    #[must_use]
    pub const fn queues(self, queued: &'static [u16], occupies: &'static [u32]) -> Self {
        Self { queued, occupies, ..self }
    }

    /// It goes to inputs.
    #[must_use]
    pub const fn raises(self, raises: &'static [u32]) -> Self {
        Self { raises, ..self }
    }

    /// Its age is kept.
    #[must_use]
    pub const fn stamps(self, stamps: &'static [u32]) -> Self {
        Self { stamps, ..self }
    }

    /// It takes activity from nodes.
    #[must_use]
    pub const fn takes_away(self, takes_away: &'static [u32]) -> Self {
        Self { takes_away, ..self }
    }

    /// Activity goes along to slots and to nodes with inputs.
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
    /// Takes activity away.
    Away,
}

/// The call of a slot (static data).
#[derive(Debug)]
pub struct Slot {
    /// Number of the node.
    pub node: usize,
    /// First of the node's ports, and the end of them.
    pub ports: (usize, usize),
    /// Conditions under which it is served.
    pub needs: &'static [u32],
    /// Number of the connection, unless it comes from another thread group.
    pub connection: Option<usize>,
    /// Condition "is free" of the connection.
    pub frees: Option<usize>,
    /// What the token does to the activity of the node.
    pub carries: Carries,
    /// Cluster that may have finished with this call.
    pub settles: Option<usize>,
    /// Stamp of the connection.
    pub stamp: Option<usize>,
}

impl Slot {
    /// A slot of a node with the ports from `first` to `end`.
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

    /// The connection has a number.
    #[must_use]
    pub const fn on(self, connection: usize) -> Self {
        Self { connection: Some(connection), ..self }
    }

    /// The connection is free again.
    #[must_use]
    pub const fn frees(self, bit: usize) -> Self {
        Self { frees: Some(bit), ..self }
    }

    /// The token is from `start` and activates the node.
    #[must_use]
    pub const fn always_activates(self) -> Self {
        Self { carries: Carries::Always, ..self }
    }

    /// The token activates the node if its sender was active.
    #[must_use]
    pub const fn activates(self) -> Self {
        Self { carries: Carries::Sometimes, ..self }
    }

    /// The token takes activity away.
    #[must_use]
    pub const fn deactivates(self) -> Self {
        Self { carries: Carries::Away, ..self }
    }

    /// A cluster may have finished.
    #[must_use]
    pub const fn settles(self, cluster: usize) -> Self {
        Self { settles: Some(cluster), ..self }
    }

    /// The age of the token is known.
    #[must_use]
    pub const fn stamp(self, stamp: usize) -> Self {
        Self { stamp: Some(stamp), ..self }
    }
}

/// The `timeout` of a node (static data).
#[derive(Debug)]
pub struct Timeout {
    /// Number of the node.
    pub node: usize,
    /// First of the node's ports, and the end of them.
    pub ports: (usize, usize),
    /// Time that the node may be active.
    pub after: Duration,
    /// Conditions under which the event can be triggered.
    pub needs: &'static [u32],
    /// The node must be enabled.
    pub gated: bool,
}

impl Timeout {
    /// The timeout of a node after a number of nanoseconds.
    pub const fn new(node: usize, first: usize, end: usize, after: u64, needs: &'static [u32], gated: bool) -> Self {
        Self { node, ports: (first, end), after: Duration::from_nanos(after), needs, gated }
    }
}
