//! The graph that all passes work on: nodes, ports, connections. Nested graphs are flattened; the scopes keep
//! where each node came from. Only the body of an `each` stays a graph of its own.

mod condition;
mod names;
mod node;
mod value;

use crate::{catalog::Type, source::Span, syntax::tree::PortKind};
use std::{collections::BTreeSet, time::Duration};

pub use condition::{Condition, is_arithmetic};
pub use names::camel;
pub use node::{Each, End, Far, Library, Modifiers, Node, NodeKind, Port, Standard, TypeArg};
pub use value::{Claim, ClaimKind, Number, Subject, Value};

/// A node, by number in [`Graph::nodes`].
pub type NodeId = usize;
/// A scope, by number in [`Graph::scopes`].
pub type ScopeId = usize;

/// The thread group of nodes that the text puts in no other.
pub const MAIN_GROUP: &str = "main";

/// The group of what watches the threads and is on none of them: a name that no text can give to one.
pub const WATCH_GROUP: &str = "(watch)";

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
    /// The type of its tokens.
    pub ty: Type,
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

impl Scope {
    /// The scope of the graph itself.
    pub fn top(graph: &str, span: Span) -> Self {
        let name = String::new();
        Self { name, graph: graph.to_owned(), parent: 0, group: None, args: vec![], docs: String::new(), span }
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

    /// The port whose tokens a port sends: delays and relays only pass them on.
    pub fn origin(&self, end: End) -> End {
        let mut end = end;
        // A loop of nothing but delays has no origin.
        for _ in 0..self.nodes.len() {
            let passes_on = matches!(self.nodes[end.node].kind, NodeKind::Delay(_) | NodeKind::Relay);
            match self.incoming(End { node: end.node, port: 0 }).filter(|_| passes_on && self.port(end).kind.sends()) {
                Some(connection) => end = connection.from,
                None => break,
            }
        }
        end
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
