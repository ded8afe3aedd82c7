//! The graph that all passes work on: nodes, ports, connections. Nested graphs are flattened; the scopes keep
//! where each node came from. Only the body of an `each` stays a graph of its own.

use crate::{
    catalog::{SignatureId, Type},
    source::Span,
    syntax::tree::PortKind,
    units::Dimension,
};
use std::{collections::BTreeSet, time::Duration};

/// A node, by number in [`Graph::nodes`].
pub type NodeId = usize;
/// A scope, by number in [`Graph::scopes`].
pub type ScopeId = usize;

/// The thread group of nodes that the text puts in no other.
pub const MAIN_GROUP: &str = "main";

/// Who watches the threads is on none of them.
pub const WATCH_GROUP: &str = "watch";

/// A resolved graph.
#[derive(Debug, Clone)]
pub struct Graph {
    /// Its name.
    pub name: String,
    /// Documentation.
    pub docs: String,
    /// Whether it is a `robot`.
    pub robot: bool,
    /// Whether a parameter has no value: it can be checked, but only be run as a part of another graph.
    pub is_open: bool,
    /// Whether it is the body of an `each`.
    pub is_body: bool,
    /// Its name in the text.
    pub span: Span,
    /// Nodes in the order of the text.
    pub nodes: Vec<Node>,
    /// Connections in the order of the text.
    pub connections: Vec<Connection>,
    /// Scope 0 is the graph itself, each other one an instance of a nested graph; parents come first.
    pub scopes: Vec<Scope>,
    /// The ports of the nested graphs.
    pub pins: Vec<Pin>,
    /// The connections as the text has them, before nested graphs were opened: what a picture shows.
    pub wires: Vec<Wire>,
    /// Claims.
    pub claims: Vec<Claim>,
    /// What the text says about the threads of groups.
    pub threads: Vec<ThreadSettings>,
    /// What its `record` statement says.
    pub record: Option<Record>,
    /// Nodes with an input that hangs on an unconnected port of the nested graph around them; reported there.
    pub open_pins: BTreeSet<NodeId>,
    /// Inputs whose connection could not be made, which has been reported.
    pub excused: BTreeSet<End>,
}

/// A `record` statement: the file, and ports whose tokens are recorded besides what comes from outside.
#[derive(Debug, Clone)]
pub struct Record {
    /// The file.
    pub file: String,
    /// The ports.
    pub ports: Vec<End>,
    /// Its place in the text.
    pub span: Span,
}

/// An instance of a nested graph.
#[derive(Debug, Clone)]
pub struct Scope {
    /// Instance name; empty for scope 0.
    pub name: String,
    /// Name of the graph.
    pub graph: String,
    /// The scope around it; itself for scope 0.
    pub parent: ScopeId,
    /// The thread group of its nodes, unless they have one of their own.
    pub group: Option<String>,
    /// The arguments of the instance.
    pub args: Vec<(String, Value)>,
    /// Documentation: of the instance if it has one, else of the graph.
    pub docs: String,
    /// The instance in the text.
    pub span: Span,
}

/// A port of a nested graph, seen from both sides: tokens come in from one and go out to the other.
#[derive(Debug, Clone)]
pub struct Pin {
    /// Its name.
    pub name: String,
    /// Its kind, seen from outside.
    pub kind: PortKind,
    /// The scope of the nested graph.
    pub scope: ScopeId,
    /// Where it is declared.
    pub span: Span,
    /// Documentation.
    pub docs: String,
    /// It stands for a port that every node has, of all nodes in the nested graph.
    pub standard: bool,
}

/// An end of a connection as written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// A port of a node.
    Port(End),
    /// A port of a nested graph, by number in [`Graph::pins`].
    Pin(usize),
}

/// A connection as written: it may begin and end at pins.
#[derive(Debug, Clone)]
pub struct Wire {
    /// Where tokens come from.
    pub from: Place,
    /// Where they go.
    pub to: Place,
    /// `=>`
    pub active: bool,
    /// Its ends carry different types, which has been reported.
    pub differs: bool,
    /// The arrow.
    pub span: Span,
}

/// A node.
#[derive(Debug, Clone)]
pub struct Node {
    /// Instance name, unique in its scope.
    pub name: String,
    /// The scope it stands in.
    pub scope: ScopeId,
    /// What it is.
    pub kind: NodeKind,
    /// Its ports.
    pub ports: Vec<Port>,
    /// What the text says about its execution.
    pub modifiers: Modifiers,
    /// Its place in the text.
    pub span: Span,
    /// Documentation.
    pub docs: String,
    /// `start` gives it activity.
    pub starts_active: bool,
}

/// What a node is.
#[derive(Debug, Clone)]
pub enum NodeKind {
    /// A node of the catalog.
    Library(Library),
    /// A nested graph that runs once per element of a list.
    Each(Each),
    /// A port of the graph itself: an input or slot has one sending port, an output or event one taking port.
    Boundary(PortKind),
    /// Holds tokens back for some iterations. Starts with these values; `None` is the default of the type.
    Delay(Vec<Option<Value>>),
    /// Passes each token on: where a nested graph takes tokens together (or sends them together) that go to a slot.
    Relay,
    /// Where activity begins: an event that is triggered once, before anything else, and always carries activity.
    Start,
    /// Where a test looks: takes tokens at an input or slot, and never holds anybody back.
    Probe,
    /// An event from outside all threads: a node has been running for too long.
    Hung,
    /// A slot of the program that ends it with this code.
    Exit(u8),
    /// A slot of the program that takes all activity away and triggers `start` again.
    Reset,
    /// Where tokens go to another thread group: only in the graph of a group. Its input is occupied until they are
    /// taken there, or until what they cause there has finished.
    Sender(Far),
    /// Where tokens come from another thread group: only in the graph of a group.
    Receiver(Far),
}

/// One end of the cell that tokens pass on their way from one thread group to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Far {
    /// Number of the cell.
    pub cell: usize,
    /// The tokens take activity away.
    pub takes_activity: bool,
    /// Somebody on the other side asks when the source fired that a token descends from.
    pub stamped: bool,
}

/// Ports that every node has, besides those that it declares.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Standard {
    /// Slot: the node takes part again.
    Enable,
    /// Slot: the node takes its tokens and answers ⊥; its slots but `enable` swallow tokens.
    Disable,
    /// Event: the node became active.
    Activated,
    /// Event: the node is no longer active.
    Deactivated,
    /// Event: `process` ran.
    Processed,
    /// Event: `process` or a slot failed.
    Failed,
    /// Event: the node was active for as long as its `timeout` says.
    Timeout,
    /// Event: the node had finished later after the firing of its source than its `deadline` says.
    Late,
}

impl Standard {
    /// All of them, in the order of their ports.
    pub const ALL: [Self; 8] = [
        Self::Enable,
        Self::Disable,
        Self::Activated,
        Self::Deactivated,
        Self::Processed,
        Self::Failed,
        Self::Timeout,
        Self::Late,
    ];

    /// The name of the port.
    pub fn name(self) -> &'static str {
        match self {
            Self::Enable => "enable",
            Self::Disable => "disable",
            Self::Activated => "activated",
            Self::Deactivated => "deactivated",
            Self::Processed => "processed",
            Self::Failed => "failed",
            Self::Timeout => "timeout",
            Self::Late => "late",
        }
    }

    /// Whether a nested graph has it for all its nodes together.
    pub fn is_shared(self) -> bool {
        matches!(self, Self::Enable | Self::Disable | Self::Failed)
    }

    /// Whether it is a slot or an event.
    pub fn kind(self) -> PortKind {
        if matches!(self, Self::Enable | Self::Disable) { PortKind::Slot } else { PortKind::Event }
    }

    /// The type of its tokens.
    pub fn ty(self) -> Type {
        match self {
            Self::Failed => Type::Named("apex_rt::Failure".to_owned(), vec![]),
            _ => Type::unit(),
        }
    }
}

/// A node of the catalog.
#[derive(Debug, Clone)]
pub struct Library {
    /// Its signature.
    pub signature: SignatureId,
    /// Type arguments, one for each generic of the signature.
    pub types: Vec<TypeArg>,
    /// Values of the parameters, in the order of the signature.
    pub params: Vec<Value>,
    /// Made in Rust and handed to the constructor.
    pub handed_in: bool,
}

/// A type argument.
#[derive(Debug, Clone)]
pub enum TypeArg {
    /// Not known (yet).
    Open,
    /// A type that the text or the connections say.
    Known(Type),
    /// A type that the text spells, as Rust.
    Spelled(Type, String),
    /// The type of the tokens at this port, which only rustc can spell.
    TokenOf(End),
    /// The element type of the lists at this port.
    ItemOf(End),
}

/// A nested graph that runs once per element of a list.
#[derive(Debug, Clone)]
pub struct Each {
    /// The graph; its boundary nodes have the names of the ports.
    pub body: Box<Graph>,
    /// The port that takes the list.
    pub list: usize,
    /// Elements in parallel.
    pub parallel: bool,
}

/// A port of a node.
#[derive(Debug, Clone)]
pub struct Port {
    /// Its name.
    pub name: String,
    /// Its kind.
    pub kind: PortKind,
    /// Type of one token.
    pub ty: Type,
    /// Tokens per firing.
    pub rate: usize,
    /// Input: need not be connected, and ⊥ reaches the node. Output: may be ⊥ although the node fired.
    pub optional: bool,
    /// The parameter that it reads or sets.
    pub parameter: Option<usize>,
    /// A port that every node has.
    pub standard: Option<Standard>,
    /// Documentation.
    pub docs: String,
}

/// Port `port` of node `node`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct End {
    /// The node.
    pub node: NodeId,
    /// Number of the port in [`Node::ports`].
    pub port: usize,
}

/// A connection between two nodes.
#[derive(Debug, Clone)]
pub struct Connection {
    /// Where tokens come from.
    pub from: End,
    /// Where they go.
    pub to: End,
    /// Whether activity passes.
    pub active: bool,
    /// Its ends carry different types, which has been reported.
    pub differs: bool,
    /// The sides of nested graphs that it passes, from its origin to its end.
    pub crossings: Vec<Crossing>,
    /// It passes a slot or an event of a nested graph: it is asynchronous, whatever its ends are.
    pub relayed: bool,
    /// The arrow in the text (the last one, if it leads through ports of nested graphs).
    pub span: Span,
}

/// How tokens travel on a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// Output to input: one token per iteration, value or ⊥.
    Synchronous,
    /// Event or output to slot: values only, taken one at a time.
    ToSlot,
    /// Event (or output by way of a slot of a nested graph) to input: values only; occupied until the region behind it has finished.
    ToInput,
}

/// A side of a nested graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Crossing {
    /// Tokens come in.
    Enter(ScopeId),
    /// Tokens go out.
    Leave(ScopeId),
}

/// What the text says about the execution of a node.
#[derive(Debug, Clone, Default)]
pub struct Modifiers {
    /// `every`: period of a source.
    pub every: Option<Duration>,
    /// `after`: time of the first firing of a source.
    pub after: Option<Duration>,
    /// `timeout`
    pub timeout: Option<Duration>,
    /// `deadline`
    pub deadline: Option<Duration>,
    /// `on`: thread group.
    pub group: Option<String>,
    /// `pipelined`
    pub pipelined: bool,
    /// `essential`
    pub essential: bool,
    /// `restart`: after a failure the node is made anew.
    pub restart: bool,
}

/// What the text says about the thread of a group.
#[derive(Debug, Clone, Default)]
pub struct ThreadSettings {
    /// The group.
    pub group: String,
    /// The cores that the thread may run on; all, if none is named.
    pub cores: Vec<usize>,
    /// Its real-time priority, 1 (lowest) to 99.
    pub priority: Option<u8>,
    /// `policy = rr`: threads of the same priority run in turn. Else (`fifo`) each runs until it sleeps.
    pub round_robin: bool,
    /// `rights = strict`: without the right to that the program ends.
    pub strict: bool,
    /// `hang`: a node that runs for longer than this hangs.
    pub hang: Option<Duration>,
}

/// A claim about activity.
#[derive(Debug, Clone)]
pub struct Claim {
    /// What is claimed.
    pub kind: ClaimKind,
    /// Of which nodes or nested graphs.
    pub of: Vec<Subject>,
    /// Its place in the text.
    pub span: Span,
}

/// What a claim says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClaimKind {
    /// No two of them are ever active at the same time.
    Exclusive,
    /// Whenever the first is active, there is a way on which activity can come to the second.
    Reaches,
    /// There is always as much activity in the program as `start` gave.
    Conserved,
}

impl ClaimKind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Exclusive, Self::Reaches, Self::Conserved];

    /// The word for it in a text.
    pub fn word(self) -> &'static str {
        match self {
            Self::Exclusive => "exclusive",
            Self::Reaches => "reaches",
            Self::Conserved => "conserved",
        }
    }
}

/// What a claim is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subject {
    /// A node.
    Node(NodeId),
    /// A nested graph: active while a node inside is, or while activity is under way between two of them.
    Scope(ScopeId),
}

/// A constant.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number in SI.
    Number(Number),
    /// `true`, `false`
    Bool(bool),
    /// A string
    Text(String),
    /// A list
    List(Vec<Value>),
    /// `()`
    Unit,
    /// A duration
    Duration(Duration),
    /// A constant of Rust, by path.
    Path(Vec<String>),
    /// The default that is written in Rust and that only rustc can evaluate.
    RustDefault,
}

/// A number in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number {
    /// Its value.
    pub value: f64,
    /// Its exact value, if it was written as an integer without a unit.
    pub integer: Option<i128>,
    /// What it measures.
    pub dimension: Dimension,
}

impl NodeKind {
    /// Whether it is a place where a test looks.
    pub fn is_probe(&self) -> bool {
        matches!(self, Self::Probe)
    }
}

impl Scope {
    /// The scope of the graph itself.
    pub fn top(graph: &str, span: Span) -> Self {
        let name = String::new();
        Self { name, graph: graph.to_owned(), parent: 0, group: None, args: vec![], docs: String::new(), span }
    }
}

impl Modifiers {
    /// Whether a source with these fires by a timer.
    pub fn has_pace(&self) -> bool {
        self.every.is_some() || self.after.is_some()
    }
}

impl Node {
    /// Its port of this kind, if somebody named it.
    pub fn standard(&self, standard: Standard) -> Option<usize> {
        self.ports.iter().position(|p| p.standard == Some(standard))
    }

    /// Whether it can be disabled.
    pub fn can_be_disabled(&self) -> bool {
        self.standard(Standard::Disable).is_some()
    }

    /// Whether it holds tokens back for some iterations.
    pub fn is_delay(&self) -> bool {
        matches!(self.kind, NodeKind::Delay(_))
    }

    /// Whether its failures are contained: somebody wants to know of them, or it is to be made anew.
    pub fn is_contained(&self) -> bool {
        self.modifiers.restart || self.standard(Standard::Failed).is_some()
    }

    /// Whether it may send nothing although it takes tokens.
    pub fn may_be_silent(&self) -> bool {
        self.can_be_disabled() || self.is_contained()
    }
}

impl Port {
    /// A port for one token per firing that need not be connected.
    pub fn new(name: &str, kind: PortKind, ty: Type) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            ty,
            rate: 1,
            optional: true,
            parameter: None,
            standard: None,
            docs: String::new(),
        }
    }

    /// Whether it is the event that activity came, or went.
    pub fn tells_of_activity(&self) -> bool {
        matches!(self.standard, Some(Standard::Activated | Standard::Deactivated))
    }
}

impl Graph {
    /// The port at `end`.
    pub fn port(&self, end: End) -> &Port {
        &self.nodes[end.node].ports[end.port]
    }

    /// The names of a node's scopes and its own, with dots: `fast.planner`.
    pub fn path(&self, node: NodeId) -> String {
        path(&self.scopes, self.nodes[node].scope, Some(&self.nodes[node].name))
    }

    /// The names of a nested graph and of those around it, with dots.
    pub fn scope_path(&self, scope: ScopeId) -> String {
        path(&self.scopes, scope, None)
    }

    /// The full name of what a claim is about.
    pub fn subject_name(&self, subject: Subject) -> String {
        match subject {
            Subject::Node(node) => self.path(node),
            Subject::Scope(scope) => self.scope_path(scope),
        }
    }

    /// A claim as a person would write it.
    pub fn claim_text(&self, claim: &Claim) -> String {
        let names: Vec<String> = claim.of.iter().map(|s| self.subject_name(*s)).collect();
        match names.as_slice() {
            [] => claim.kind.word().to_owned(),
            names => format!("{}({})", claim.kind.word(), names.join(", ")),
        }
    }

    /// `node.port` as a person would write it.
    pub fn end_name(&self, end: End) -> String {
        match self.nodes[end.node].kind {
            NodeKind::Boundary(_) | NodeKind::Sender(_) | NodeKind::Receiver(_) => self.path(end.node),
            _ => format!("{}.{}", self.path(end.node), self.port(end).name),
        }
    }

    /// A connection as a person would write it.
    pub fn connection_text(&self, connection: usize) -> String {
        let c = &self.connections[connection];
        let arrow = if c.active { "=>" } else { "->" };
        format!("{} {arrow} {}", self.end_name(c.from), self.end_name(c.to))
    }

    /// The scopes around a node, innermost first, without scope 0.
    pub fn scopes_of(&self, node: NodeId) -> Vec<ScopeId> {
        let mut scopes = vec![];
        let mut scope = self.nodes[node].scope;
        while scope != 0 {
            scopes.push(scope);
            scope = self.scopes[scope].parent;
        }
        scopes
    }

    /// The thread group of a node: its own, or that of the nested graph around it.
    pub fn group(&self, node: NodeId) -> &str {
        if matches!(self.nodes[node].kind, NodeKind::Hung) {
            return WATCH_GROUP;
        }
        let own = self.nodes[node].modifiers.group.as_deref();
        let around = || self.scopes_of(node).into_iter().find_map(|scope| self.scopes[scope].group.as_deref());
        own.or_else(around).unwrap_or(MAIN_GROUP)
    }

    /// Whether a node can be active. `start` is a moment, not a state; what ends the program or leaves it has none.
    pub fn can_hold_activity(&self, node: NodeId) -> bool {
        use NodeKind::{Delay, Each, Library, Receiver, Relay, Sender};
        matches!(self.nodes[node].kind, Library(_) | Each(_) | Relay | Delay(_) | Sender(_) | Receiver(_))
    }

    /// The connection into a port, if there is one.
    pub fn incoming(&self, end: End) -> Option<&Connection> {
        self.connections.iter().find(|c| c.to == end)
    }

    /// How tokens travel on a connection.
    pub fn flow(&self, connection: &Connection) -> Flow {
        match (self.port(connection.from).kind, self.port(connection.to).kind) {
            (_, PortKind::Slot) => Flow::ToSlot,
            (PortKind::Output, _) if !connection.relayed => Flow::Synchronous,
            _ => Flow::ToInput,
        }
    }

    /// Whether a connection takes part in synchronous data flow at both ends.
    pub fn is_synchronous(&self, connection: &Connection) -> bool {
        self.flow(connection) == Flow::Synchronous
    }
}

/// The names of `scope` and of those around it, then `name`, with dots.
pub fn path(scopes: &[Scope], mut scope: ScopeId, name: Option<&str>) -> String {
    let mut names: Vec<&str> = name.into_iter().collect();
    while scope != 0 {
        names.push(&scopes[scope].name);
        scope = scopes[scope].parent;
    }
    names.reverse();
    names.join(".")
}
