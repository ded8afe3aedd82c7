//! Limits of a program, and what is left of them while it is built.

/// Largest number of nodes and nested graphs of a program. It has at most four times as many connections.
pub const MAX_NODES: usize = 50_000;

/// Largest number of ports and ends of connections that are visited, which limits the time. A nested graph counts as
/// often as it is used.
const MAX_LOOKS: usize = 1_000_000;

/// Largest depth of nested graphs.
pub const MAX_NESTING: usize = 64;

/// Remaining budget for the programs of a source file.
pub struct Budget {
    /// Nodes and nested graphs that may be added.
    pub nodes: usize,
    /// Visits to ports or ends of connections.
    pub looks: usize,
    /// `true` if the budget was exceeded, which has been reported.
    pub exceeded: bool,
}

impl Budget {
    /// The whole budget.
    pub fn new() -> Self {
        Self { nodes: MAX_NODES, looks: MAX_LOOKS, exceeded: false }
    }
}
