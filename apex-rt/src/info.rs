/// Description of a compiled graph: a static table for recorders, monitors and `explain`.
///
/// ```
/// use apex_rt::{Info, prelude::*};
/// use std::time::Duration;
///
/// apex_macros::graph!("examples/blink.afg");
///
/// # fn main() {
/// const INFO: Info = Blink::INFO;
/// assert_eq!((INFO.nodes[0].name, INFO.kind(0).name), ("clock", "tick"));
/// assert_eq!(INFO.nodes[0].every, Some(Duration::from_millis(20)));
/// let to = &INFO.connections[0];
/// assert_eq!((to.output, INFO.nodes[to.to].name, to.input), ("signal", "count", "put"));
/// # }
/// ```
#[derive(Debug)]
pub struct Info {
    /// Name of the graph or robot.
    pub name: &'static str,
    /// Documentation of the graph in its source file.
    pub docs: &'static str,
    /// Paths of the source files.
    pub files: &'static [&'static str],
    /// All nodes in the order of the source file, and then the states of state machines, which are of the kind `state`.
    pub nodes: &'static [NodeInfo],
    /// The kinds of nodes: those that have the same node type and the same types of tokens are of one kind.
    pub kinds: &'static [KindInfo],
    /// Full names of all nested graphs: `fast.avoid`.
    pub graphs: &'static [&'static str],
    /// All connections.
    pub connections: &'static [ConnectionInfo],
    /// Nodes of each cluster, in firing order.
    pub clusters: &'static [&'static [usize]],
    /// The thread groups, the main group first. Empty if there is only one, without settings.
    pub groups: &'static [GroupInfo],
    /// Exit code if the program ends when a node hangs.
    pub end_if_hung: Option<u8>,
    /// All claims as written in the source file, with full names: `exclusive(fast, slow)`.
    pub claims: &'static [&'static str],
}

/// A node of a compiled graph.
#[derive(Debug)]
pub struct NodeInfo {
    /// Full name of the instance, with the names of the nested graphs around it: `fast.planner`.
    pub name: &'static str,
    /// Index of its kind in [`Info::kinds`].
    pub kind: usize,
    /// Place of its declaration.
    pub place: Place,
    /// `true` if a ⊥ at this node must be passed on for an essential node downstream (thesis eq. 3.7).
    pub required: bool,
    /// `true` if a ⊥ at this node must be passed on for a join downstream (thesis eq. 3.8).
    pub siblings: bool,
    /// Period of a source with `every`.
    pub every: Option<core::time::Duration>,
}

/// A place in the source files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// Index of the file in [`Info::files`].
    pub file: usize,
    /// Line, from 1.
    pub line: u32,
    /// Column, from 1.
    pub column: u32,
}

/// A kind of nodes.
#[derive(Debug)]
pub struct KindInfo {
    /// The node type as written in the source file, or the role of a node that the compiler adds: `input`, `delay`,
    /// `state`.
    pub name: &'static str,
    /// First sentence of the documentation of the node type.
    pub docs: &'static str,
    /// Its ports, without those of parameters, which [`Parameters::PARAMS`](crate::Parameters::PARAMS) has, and those
    /// that every node has.
    pub ports: &'static [PortInfo],
}

/// A port of a kind of nodes.
#[derive(Debug)]
pub struct PortInfo {
    /// Name of the port.
    pub name: &'static str,
    /// Kind of the port.
    pub kind: PortKind,
    /// Type of its tokens.
    pub ty: &'static str,
}

/// Kind of a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PortKind {
    /// Synchronous input.
    Input,
    /// Synchronous output.
    Output,
    /// Asynchronous input.
    Slot,
    /// Asynchronous output.
    Event,
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
    /// `true` if activity flows over it.
    pub activity: bool,
}

/// A thread group of a compiled graph.
#[derive(Debug)]
pub struct GroupInfo {
    /// Name of the group.
    pub name: &'static str,
    /// Cores that its thread may run on; empty for all.
    pub cores: &'static [usize],
    /// Real-time priority of its thread, 1 (lowest) to 99.
    pub priority: Option<u8>,
    /// `true` if threads of the same priority take turns (round robin), instead of each running until it sleeps (FIFO).
    pub round_robin: bool,
    /// Effect of missing scheduling rights: the program ends (`true`), or warns and continues (`false`).
    pub strict: bool,
    /// Running time after which a node counts as hanging.
    pub hang: Option<core::time::Duration>,
}

impl Info {
    /// Returns the kind of node `node`.
    pub const fn kind(&self, node: usize) -> &'static KindInfo {
        &self.kinds[self.nodes[node].kind]
    }
}

#[doc(hidden)]
impl NodeInfo {
    /// Returns a row of the table of nodes. `place` has file, line and column.
    pub const fn new(name: &'static str, kind: usize, place: [u32; 3], required: bool, siblings: bool) -> Self {
        let [file, line, column] = place;
        let place = Place { file: file as usize, line, column };
        Self { name, kind, place, required, siblings, every: None }
    }

    /// Returns the row of a source with a period, in ns.
    #[must_use]
    pub const fn every(self, period: u64) -> Self {
        Self { every: Some(core::time::Duration::from_nanos(period)), ..self }
    }
}

#[doc(hidden)]
impl KindInfo {
    /// Returns a row of the table of kinds.
    pub const fn new(name: &'static str, docs: &'static str, ports: &'static [PortInfo]) -> Self {
        Self { name, docs, ports }
    }
}

#[doc(hidden)]
impl PortInfo {
    /// Returns the row of an input.
    pub const fn input(name: &'static str, ty: &'static str) -> Self {
        Self { name, kind: PortKind::Input, ty }
    }

    /// Returns the row of an output.
    pub const fn output(name: &'static str, ty: &'static str) -> Self {
        Self { name, kind: PortKind::Output, ty }
    }

    /// Returns the row of a slot.
    pub const fn slot(name: &'static str, ty: &'static str) -> Self {
        Self { name, kind: PortKind::Slot, ty }
    }

    /// Returns the row of an event.
    pub const fn event(name: &'static str, ty: &'static str) -> Self {
        Self { name, kind: PortKind::Event, ty }
    }
}

#[doc(hidden)]
impl ConnectionInfo {
    /// Returns a row of the table of connections.
    pub const fn new(from: usize, output: &'static str, to: usize, input: &'static str, activity: bool) -> Self {
        Self { from, output, to, input, activity }
    }
}
