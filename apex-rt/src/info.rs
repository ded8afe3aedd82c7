/// What a compiled graph is made of: a static table for recorders, monitors and `explain`.
#[derive(Debug)]
pub struct Info {
    /// The graph or robot.
    pub name: &'static str,
    /// All nodes in the order of the text.
    pub nodes: &'static [NodeInfo],
    /// The names of all nested graphs, with those around them: `fast.avoid`.
    pub graphs: &'static [&'static str],
    /// All connections.
    pub connections: &'static [ConnectionInfo],
    /// The nodes of each cluster in the order in which they fire.
    pub clusters: &'static [&'static [usize]],
    /// The thread groups, if there are several or something is said about them: the main group first.
    pub groups: &'static [GroupInfo],
    /// The code with which the program ends when a node hangs, if it does.
    pub end_if_hung: Option<u8>,
    /// All claims, as they stand in the text with full names: `exclusive(fast, slow)`.
    pub claims: &'static [&'static str],
}

/// A node of a compiled graph.
#[derive(Debug)]
pub struct NodeInfo {
    /// Instance name, with the names of the nested graphs around it: `fast.planner`.
    pub name: &'static str,
    /// The node type as the text names it.
    pub kind: &'static str,
    /// A ⊥ at this node must be passed on for an essential node downstream (thesis eq. 3.7).
    pub required: bool,
    /// A ⊥ at this node must be passed on for a join downstream (thesis eq. 3.8).
    pub siblings: bool,
}

/// A connection of a compiled graph.
#[derive(Debug)]
pub struct ConnectionInfo {
    /// The sending node.
    pub from: usize,
    /// Name of the sending port.
    pub output: &'static str,
    /// The receiving node.
    pub to: usize,
    /// Name of the receiving port.
    pub input: &'static str,
}

/// A thread group of a compiled graph.
#[derive(Debug)]
pub struct GroupInfo {
    /// Its name.
    pub name: &'static str,
    /// The cores that its thread may run on; all, if none is named.
    pub cores: &'static [usize],
    /// Its real-time priority, 1 (lowest) to 99.
    pub priority: Option<u8>,
    /// Threads of the same priority run in turn, instead of each until it sleeps.
    pub round_robin: bool,
    /// Without the right to that the program ends; else it says so and goes on.
    pub strict: bool,
    /// A node that runs for longer than this hangs.
    pub hang: Option<core::time::Duration>,
}

impl NodeInfo {
    /// One row of the table.
    pub const fn new(name: &'static str, kind: &'static str, required: bool, siblings: bool) -> Self {
        Self { name, kind, required, siblings }
    }
}

impl ConnectionInfo {
    /// One row of the table.
    pub const fn new(from: usize, output: &'static str, to: usize, input: &'static str) -> Self {
        Self { from, output, to, input }
    }
}
