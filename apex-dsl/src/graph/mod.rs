//! The graph that all passes work on: nodes, ports, connections. Nested graphs are flattened; the scopes record the
//! instance that each node belongs to. Only the body of an `each` remains a graph of its own.

mod condition;
mod ids;
mod names;
mod node;
mod value;

use crate::{
    catalog::Type,
    index::IdVec,
    source::Span,
    syntax::tree::{Expr, Ident, PortKind},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};

pub use condition::{Condition, is_arithmetic};
pub use ids::{ConnectionId, NodeId, ScopeId};
pub use names::{camel, snake};
pub use node::{CellEnd, Each, Library, Modifiers, Node, NodeKind, Port, PortId, Standard, TypeArg};
pub use value::{Claim, ClaimKind, FieldValue, Number, StructValue, Subject, Value};

/// Thread group of nodes that are not assigned to another one.
pub const MAIN_GROUP: &str = "main";

/// Group of the watchdogs, which run on none of the threads. The parentheses keep it apart from all names of a source.
pub const WATCH_GROUP: &str = "(watch)";

/// A resolved graph.
#[derive(Debug, Clone)]
pub struct Graph {
    /// Name of the graph.
    pub name: String,
    /// Documentation.
    pub docs: String,
    /// `true` for a `robot`.
    pub robot: bool,
    /// `true` if a parameter has no value: the graph can be checked, but it can only run as a part of another graph.
    pub is_open: bool,
    /// `true` for the body of an `each`.
    pub is_body: bool,
    /// Its name in the source file.
    pub span: Span,
    /// Nodes in the order of the source file.
    pub nodes: IdVec<NodeId, Node>,
    /// Connections in the order of the source file.
    pub connections: IdVec<ConnectionId, Connection>,
    /// Scope 0 is the graph itself, each other one an instance of a nested graph; parents come first.
    pub scopes: IdVec<ScopeId, Scope>,
    /// The ports of the nested graphs.
    pub pins: Vec<Pin>,
    /// The connections as written, before nested graphs were flattened: the ones that a picture shows.
    pub wires: Vec<Wire>,
    /// Claims.
    pub claims: Vec<Claim>,
    /// Settings of the threads of groups.
    pub threads: Vec<ThreadSettings>,
    /// Its `record` statement.
    pub record: Option<Record>,
    /// Nodes with an input that belongs to an unconnected port of the nested graph around them. The error is reported
    /// at that port.
    pub open_pins: BTreeSet<NodeId>,
    /// Inputs whose connection could not be made; the error has been reported.
    pub suppressed: BTreeSet<PortId>,
    /// Sources that fire each time when certain other nodes have fired, although no connection leads from these to
    /// them: on another thread, their tokens are taken together. Only graphs of thread groups have some.
    pub paced: BTreeMap<NodeId, BTreeSet<NodeId>>,
}

/// A node that takes activity out of others, and gives it back.
#[derive(Debug, Clone)]
pub struct Interrupt {
    /// The node.
    pub node: NodeId,
    /// The node or nested graph that is meant.
    pub subject: Subject,
    /// Nodes from which it takes activity.
    pub takes: Vec<NodeId>,
}

/// A `record` statement: the file, and the ports that are recorded in addition to the inputs of the program.
#[derive(Debug, Clone)]
pub struct Record {
    /// The file.
    pub file: String,
    /// Maximum size of all its parts, in bytes.
    pub limit: Option<u64>,
    /// Age from which messages are removed.
    pub age: Option<Duration>,
    /// `true` if it is compressed.
    pub compress: bool,
    /// The ports.
    pub ports: Vec<PortId>,
    /// Place in the source file.
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
    /// The instance in the source file.
    pub span: Span,
}

/// A port of a nested graph. Tokens arrive at one side of it and leave on the other.
#[derive(Debug, Clone)]
pub struct Pin {
    /// Name of the port.
    pub name: String,
    /// Kind, seen from outside.
    pub kind: PortKind,
    /// The type of its tokens.
    pub ty: Type,
    /// The frame of its tokens, if one is declared.
    pub frame: Option<Ident>,
    /// The scope of the nested graph.
    pub scope: ScopeId,
    /// Place of the declaration.
    pub span: Span,
    /// Documentation.
    pub docs: String,
    /// `true` if it stands for a port that every node has (such as `enable`), of all nodes in the nested graph.
    pub standard: bool,
}

/// An end of a connection as written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum WireEnd {
    /// A port of a node.
    Port(PortId),
    /// A port of a nested graph, by number in [`Graph::pins`].
    Pin(usize),
}

impl WireEnd {
    /// The end as it is written in the graph around it: `node.port`, or a port of that graph.
    pub fn text(self, nodes: &IdVec<NodeId, Node>, pins: &[Pin], scopes: &IdVec<ScopeId, Scope>) -> String {
        match self {
            Self::Port(end) => match &nodes[end.node] {
                Node { name, kind: NodeKind::Boundary(_), .. } => name.clone(),
                Node { name, ports, .. } => format!("{name}.{}", ports[end.port].name),
            },
            Self::Pin(pin) => format!("{}.{}", scopes[pins[pin].scope].name, pins[pin].name),
        }
    }
}

/// A connection as written: each end is a port of a node or of a nested graph.
#[derive(Debug, Clone)]
pub struct Wire {
    /// Origin of the tokens.
    pub from: WireEnd,
    /// Destination of the tokens.
    pub to: WireEnd,
    /// `=>`
    pub active: bool,
    /// `true` if its ends carry different types, which has been reported.
    pub differs: bool,
    /// `port(value)` at its end.
    pub given: Option<Box<Given>>,
    /// The arrow.
    pub span: Span,
}

/// A value that a slot gets in place of each token of a connection.
#[derive(Debug, Clone)]
pub struct Given {
    /// The value.
    pub value: Value,
    /// The value as written.
    pub written: Expr,
}

/// A connection between two nodes.
#[derive(Debug, Clone)]
pub struct Connection {
    /// Origin of the tokens.
    pub from: PortId,
    /// Destination of the tokens.
    pub to: PortId,
    /// `true` for `=>`, on which activity passes.
    pub active: bool,
    /// `true` if its ends carry different types, which has been reported.
    pub differs: bool,
    /// The value that comes in place of its tokens: its end is a slot then.
    pub given: Option<Box<Given>>,
    /// Boundaries of nested graphs that it crosses, from its origin to its destination.
    pub crossings: Vec<Crossing>,
    /// `true` if it passes a slot or an event of a nested graph. It is asynchronous then, whatever its ends are.
    pub relayed: bool,
    /// The arrow in the source file; the last one, if the connection leads through ports of nested graphs.
    pub span: Span,
}

/// Manner in which tokens travel on a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// Output to input: one token per iteration, value or ⊥.
    Synchronous,
    /// Event or output to slot: values only, taken one at a time.
    ToSlot,
    /// Event (or output by way of a slot of a nested graph) to input: values only. The connection is occupied until the
    /// region behind it has finished.
    ToInput,
}

/// Crossing of the boundary of a nested graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Crossing {
    /// Tokens enter the nested graph.
    Enter(ScopeId),
    /// Tokens leave the nested graph.
    Leave(ScopeId),
}

/// Settings of the thread of a group.
#[derive(Debug, Clone, Default)]
pub struct ThreadSettings {
    /// The group.
    pub group: String,
    /// Cores that the thread may run on. An empty list means all.
    pub cores: Vec<usize>,
    /// Real-time priority, 1 (lowest) to 99.
    pub priority: Option<u8>,
    /// `policy = rr`: threads of the same priority run in turn. Otherwise (`fifo`) each thread runs until it sleeps.
    pub round_robin: bool,
    /// `rights = strict`: the program ends if it lacks the rights for these settings.
    pub strict: bool,
    /// `hang`: a node that runs for longer than this is considered hung.
    pub hang: Option<Duration>,
}

impl Scope {
    /// The scope of the graph itself.
    pub fn top(graph: &str, span: Span) -> Self {
        let (name, docs, parent) = (String::new(), String::new(), ScopeId::TOP);
        Self { name, graph: graph.to_owned(), parent, group: None, args: vec![], docs, span }
    }
}

impl Graph {
    /// The ports of the graph itself that are meant, each a node.
    pub fn boundaries(&self, is_meant: impl Fn(PortKind) -> bool) -> Vec<NodeId> {
        self.nodes.ids().filter(|n| matches!(self.nodes[*n].kind, NodeKind::Boundary(k) if is_meant(k))).collect()
    }

    /// The port at `end`.
    pub fn port(&self, end: PortId) -> &Port {
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

    /// The full name of the subject of a claim.
    pub fn subject_name(&self, subject: Subject) -> String {
        match subject {
            Subject::Node(node) => self.path(node),
            Subject::Scope(scope) => self.scope_path(scope),
        }
    }

    /// A claim as written in a source file.
    pub fn claim_text(&self, claim: &Claim) -> String {
        let names: Vec<String> = claim.of.iter().map(|s| self.subject_name(*s)).collect();
        match names.as_slice() {
            [] => claim.kind.word().to_owned(),
            names => format!("{}({})", claim.kind.word(), names.join(", ")),
        }
    }

    /// A port as written in a source file: `node.port`.
    pub fn end_name(&self, end: PortId) -> String {
        match self.nodes[end.node].kind {
            NodeKind::Boundary(_) | NodeKind::Sender(_) | NodeKind::Receiver(_) => self.path(end.node),
            NodeKind::Interrupt(subject) => format!("{}.{}", self.subject_name(subject), self.port(end).name),
            _ => format!("{}.{}", self.path(end.node), self.port(end).name),
        }
    }

    /// A connection as written in a source file.
    pub fn connection_text(&self, connection: ConnectionId) -> String {
        let c = &self.connections[connection];
        let arrow = if c.active { "=>" } else { "->" };
        let given = c.given.as_ref().map_or_else(String::new, |given| format!("({})", given.value.text()));
        format!("{} {arrow} {}{given}", self.end_name(c.from), self.end_name(c.to))
    }

    /// The scopes of all nested graphs.
    pub fn nested(&self) -> impl Iterator<Item = ScopeId> + use<> {
        self.scopes.ids().skip(1)
    }

    /// The scopes around a node, innermost first, without scope 0.
    pub fn scopes_of(&self, node: NodeId) -> Vec<ScopeId> {
        let mut scopes = vec![];
        let mut scope = self.nodes[node].scope;
        while scope != ScopeId::TOP {
            scopes.push(scope);
            scope = self.scopes[scope].parent;
        }
        scopes
    }

    /// The thread group of a node: its own, or that of the innermost nested graph with one.
    pub fn group(&self, node: NodeId) -> &str {
        match self.nodes[node].kind {
            NodeKind::Watchdog => return WATCH_GROUP,
            NodeKind::SetBack => return MAIN_GROUP,
            _ => {}
        }
        let own = self.nodes[node].modifiers.group.as_deref();
        let around = || self.scopes_of(node).into_iter().find_map(|scope| self.scopes[scope].group.as_deref());
        own.or_else(around).unwrap_or(MAIN_GROUP)
    }

    /// The thread groups: the main group, then the others in the order of the source file.
    pub fn groups(&self) -> Vec<&str> {
        let mut groups = vec![MAIN_GROUP];
        for node in self.nodes.ids() {
            let group = self.group(node);
            if group != WATCH_GROUP && !groups.contains(&group) {
                groups.push(group);
            }
        }
        groups
    }

    /// Returns `true` if the program runs on several threads.
    pub fn has_several_groups(&self) -> bool {
        self.groups().len() > 1
    }

    /// Returns `true` if a node can be active. `start` is an event in time without a state, and nodes that end the
    /// program or form its boundary hold no activity.
    pub fn can_hold_activity(&self, node: NodeId) -> bool {
        use NodeKind::{Delay, Each, Interrupt, Library, Receiver, Relay, Sender};
        matches!(
            self.nodes[node].kind,
            Library(_) | Each(_) | Relay | Delay(_) | Interrupt(_) | Sender(_) | Receiver(_)
        )
    }

    /// The nodes that take activity out of others.
    pub fn interrupts(&self) -> impl Iterator<Item = Interrupt> + '_ {
        self.nodes.iter_enumerated().filter_map(|(node, n)| {
            let subject = n.interrupts()?;
            Some(Interrupt { node, subject, takes: self.nodes_of(subject) })
        })
    }

    /// Nodes whose activity can be cancelled.
    pub fn cancelled(&self) -> BTreeSet<NodeId> {
        self.interrupts().flat_map(|interrupt| interrupt.takes).collect()
    }

    /// A node, or the nodes in a nested graph, as far as they can hold activity; and the relays in the same thread
    /// group whose tokens go only to them, because these are not in the source file.
    pub fn nodes_of(&self, subject: Subject) -> Vec<NodeId> {
        let is_meant = |node: &NodeId| match subject {
            Subject::Node(of) => *node == of,
            Subject::Scope(scope) => {
                self.can_hold_activity(*node)
                    && self.nodes[*node].interrupts().is_none()
                    && self.scopes_of(*node).contains(&scope)
            }
        };
        let mut found: BTreeSet<NodeId> = self.nodes.ids().filter(is_meant).collect();
        let group = found.first().map(|node| self.group(*node));
        let is_relay =
            |node: &NodeId| matches!(self.nodes[*node].kind, NodeKind::Relay) && group == Some(self.group(*node));
        let mut relays: BTreeMap<NodeId, Vec<NodeId>> = BTreeMap::new();
        for c in self.connections.iter().filter(|c| is_relay(&c.from.node)) {
            relays.entry(c.from.node).or_default().push(c.to.node);
        }
        loop {
            let leads_there = |(relay, next): &(&NodeId, &Vec<NodeId>)| {
                !found.contains(*relay) && next.iter().all(|node| found.contains(node))
            };
            let more: Vec<NodeId> = relays.iter().filter(leads_there).map(|(relay, _)| *relay).collect();
            if more.is_empty() {
                return found.into_iter().collect();
            }
            found.extend(more);
        }
    }

    /// The nodes that receive the activity of a token that leads to `node`: itself, or those behind it if it is a
    /// relay.
    pub fn receivers(&self, node: NodeId) -> BTreeSet<NodeId> {
        let (mut found, mut open, mut seen) = (BTreeSet::new(), vec![node], BTreeSet::new());
        while let Some(node) = open.pop() {
            match self.nodes[node].kind {
                NodeKind::Relay if seen.insert(node) => {
                    let active = self.connections.iter().filter(|c| c.active && c.from.node == node);
                    open.extend(active.map(|c| c.to.node));
                }
                NodeKind::Relay => {}
                _ => _ = found.insert(node),
            }
        }
        found
    }

    /// The connection into a port, if there is one.
    pub fn incoming(&self, end: PortId) -> Option<&Connection> {
        self.connections.iter().find(|c| c.to == end)
    }

    /// The port from which the tokens of a port originate: delays and relays only pass them on.
    pub fn origin(&self, end: PortId) -> PortId {
        let mut end = end;
        // The number of steps is bounded, as a loop of nothing but delays has no origin.
        for _ in 0..self.nodes.len() {
            let passes_on = matches!(self.nodes[end.node].kind, NodeKind::Delay(_) | NodeKind::Relay);
            if !passes_on || !self.port(end).kind.sends() {
                break;
            }
            match self.incoming(PortId { node: end.node, port: 0 }) {
                Some(connection) => end = connection.from,
                None => break,
            }
        }
        end
    }

    /// Manner in which tokens travel on a connection.
    pub fn flow(&self, connection: &Connection) -> Flow {
        match (self.port(connection.from).kind, self.port(connection.to).kind) {
            (_, PortKind::Slot) => Flow::ToSlot,
            (PortKind::Output, _) if !connection.relayed => Flow::Synchronous,
            _ => Flow::ToInput,
        }
    }

    /// Returns `true` if both ends of a connection are synchronous.
    pub fn is_synchronous(&self, connection: &Connection) -> bool {
        self.flow(connection) == Flow::Synchronous
    }
}

/// The names of the scopes from the outermost to `scope`, then `name`, separated by dots.
pub fn path(scopes: &IdVec<ScopeId, Scope>, mut scope: ScopeId, name: Option<&str>) -> String {
    let mut names: Vec<&str> = name.into_iter().collect();
    while scope != ScopeId::TOP {
        names.push(&scopes[scope].name);
        scope = scopes[scope].parent;
    }
    names.reverse();
    names.join(".")
}
