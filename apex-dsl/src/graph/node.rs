//! Nodes, their ports, and what the text says about them.

use super::{Graph, NodeId, ScopeId, Value};
use crate::{
    catalog::{SignatureId, Type},
    source::Span,
    syntax::tree::PortKind,
};
use std::time::Duration;

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

impl NodeKind {
    /// Whether it is a place where a test looks.
    pub fn is_probe(&self) -> bool {
        matches!(self, Self::Probe)
    }
}

impl Modifiers {
    /// Whether a source with these fires by a timer.
    pub fn has_pace(&self) -> bool {
        self.every.is_some() || self.after.is_some()
    }
}

impl Node {
    /// Makes the list of an `each` an input that has to be there, and its elements as well.
    pub fn require_list(&mut self) {
        let NodeKind::Each(each) = &mut self.kind else { return };
        let Some(list) = self.ports.get_mut(each.list) else { return };
        list.optional = false;
        let is_element = |n: &&mut Self| matches!(n.kind, NodeKind::Boundary(PortKind::Input)) && n.name == list.name;
        if let Some(element) = each.body.nodes.iter_mut().find(is_element) {
            element.ports[0].optional = false;
        }
    }

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
