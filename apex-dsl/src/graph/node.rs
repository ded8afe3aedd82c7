//! Nodes, their ports and their modifiers.

use super::{
    Graph,
    ids::{NodeId, ScopeId},
    value::{Subject, Value},
};
use crate::{
    catalog::{Limits, SignatureId, Type},
    source::Span,
    syntax::tree::{Ident, PortKind},
};
use std::time::Duration;

/// A node.
#[derive(Debug, Clone)]
pub struct Node {
    /// Instance name, unique in its scope.
    pub name: String,
    /// Scope that contains the node.
    pub scope: ScopeId,
    /// Kind of the node.
    pub kind: NodeKind,
    /// Ports of the node.
    pub ports: Vec<Port>,
    /// Modifiers of its execution.
    pub modifiers: Modifiers,
    /// Place in the source file.
    pub span: Span,
    /// Documentation.
    pub docs: String,
    /// `true` if `start` activates the node.
    pub starts_active: bool,
}

/// Kind of a node.
#[derive(Debug, Clone)]
pub enum NodeKind {
    /// A node of the catalog.
    Library(Library),
    /// A nested graph that runs once per element of a list.
    Each(Each),
    /// A port of the graph itself: an input or slot has one sending port, an output or event one taking port.
    Boundary(PortKind),
    /// Holds tokens back for some iterations. Initially holds these values; `None` is the default of the type.
    Delay(Vec<Option<Value>>),
    /// Passes each token on. Inserted where a port of a nested graph merges or distributes tokens on their way to a
    /// slot.
    Relay,
    /// Origin of activity: an event that is triggered once, before anything else, and always carries activity.
    Start,
    /// Observation point of a test: takes the tokens of an input or slot, and never blocks their sender.
    Probe,
    /// An event of the watchdog, outside all threads: a node has been running for too long.
    Watchdog,
    /// An event of the main thread group: the time of the reactions has gone back.
    SetBack,
    /// A slot of the program that ends it with this code.
    Exit(u8),
    /// A slot of the program that takes all activity away and triggers `start` again.
    Reset,
    /// Takes all activity out of a node or nested graph, and gives it back. Its ports are [`Standard::OF_INTERRUPT`].
    Interrupt(Subject),
    /// Sends tokens to another thread group: only in the graph of a group. Its input is occupied until the other group
    /// has taken the token, or has finished everything that the token causes there.
    Sender(CellEnd),
    /// Receives tokens from another thread group: only in the graph of a group.
    Receiver(CellEnd),
}

/// One end of the cell that tokens pass on their way from one thread group to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CellEnd {
    /// Number of the cell.
    pub cell: usize,
    /// `true` if the tokens may carry activity.
    pub carries_activity: bool,
    /// `true` if the tokens take activity away.
    pub takes_activity: bool,
    /// `true` if the receiving group needs the time at which the source of a token fired.
    pub stamped: bool,
}

/// Ports that every node has in addition to those that it declares.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Standard {
    /// Slot: ends the effect of `disable`.
    Enable,
    /// Slot: from now on the node consumes its tokens and answers ⊥; all its slots except `enable` discard tokens.
    Disable,
    /// Event: the node became active.
    Activated,
    /// Event: the node is no longer active.
    Deactivated,
    /// Event: `process` has run.
    Processed,
    /// Event: `process` or a slot failed.
    Failed,
    /// Event: the node was active for as long as its `timeout`.
    Timeout,
    /// Event: the node finished later after the firing of its source than its `deadline` allows.
    Late,
    /// Slot: takes all activity out of the node, or out of everything in the nested graph.
    Cancel,
    /// Slot: gives the activity back to where the last `cancel` took it from.
    Resume,
    /// Event: `cancel` has taken activity, which goes along.
    Cancelled,
}

impl Standard {
    /// All standard ports, in the order of their numbers.
    pub const ALL: [Self; 11] = [
        Self::Enable,
        Self::Disable,
        Self::Activated,
        Self::Deactivated,
        Self::Processed,
        Self::Failed,
        Self::Timeout,
        Self::Late,
        Self::Cancel,
        Self::Resume,
        Self::Cancelled,
    ];

    /// The ports of a [`NodeKind::Interrupt`], in the order of their numbers.
    pub const OF_INTERRUPT: [Self; 3] = [Self::Cancel, Self::Resume, Self::Cancelled];

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
            Self::Cancel => "cancel",
            Self::Resume => "resume",
            Self::Cancelled => "cancelled",
        }
    }

    /// Returns `true` if a nested graph has the port on behalf of all its nodes.
    pub fn is_shared(self) -> bool {
        matches!(self, Self::Enable | Self::Disable | Self::Failed) || self.of_interrupt().is_some()
    }

    /// Number of the port of a [`NodeKind::Interrupt`] that stands for the port.
    pub fn of_interrupt(self) -> Option<usize> {
        Self::OF_INTERRUPT.iter().position(|port| *port == self)
    }

    /// Returns `true` if this is the port with this number of a [`NodeKind::Interrupt`].
    pub fn is_of_interrupt(self, port: usize) -> bool {
        self.of_interrupt() == Some(port)
    }

    /// Kind of the port: slot or event.
    pub fn kind(self) -> PortKind {
        match self {
            Self::Enable | Self::Disable | Self::Cancel | Self::Resume => PortKind::Slot,
            _ => PortKind::Event,
        }
    }

    /// Type of its tokens.
    pub fn ty(self) -> Type {
        match self {
            Self::Failed => Type::Named("apex_rt::Failure".to_owned(), vec![]),
            Self::Cancel | Self::Resume => Type::Unknown("any type".to_owned()),
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
    /// Ranges of parameters of the graph that are passed on, for each parameter. They hold beside its own.
    pub ranges: Vec<Vec<Limits>>,
    /// `true` if the node is made in Rust and passed to the constructor.
    pub handed_in: bool,
}

/// A type argument.
#[derive(Debug, Clone)]
pub enum TypeArg {
    /// Not known, or not yet.
    Open,
    /// A type that the source file or the connections determine.
    Known(Type),
    /// A type that is written in the source file, and its Rust code.
    Verbatim(Type, String),
    /// The type of the tokens at this port, which generated code cannot spell, as far as it is known.
    TokenOf(PortId, Type),
    /// The element type of the lists at this port, as far as it is known.
    ItemOf(PortId, Type),
}

/// A nested graph that runs once per element of a list.
#[derive(Debug, Clone)]
pub struct Each {
    /// The graph; its boundary nodes have the names of the ports.
    pub body: Box<Graph>,
    /// The input port of the list; `None` until it is chosen by the types.
    pub list: Option<usize>,
    /// `true` if the elements run in parallel.
    pub parallel: bool,
}

/// A port of a node.
#[derive(Debug, Clone)]
pub struct Port {
    /// Name of the port.
    pub name: String,
    /// Kind of the port.
    pub kind: PortKind,
    /// Type of one token.
    pub ty: Type,
    /// Tokens per firing.
    pub rate: usize,
    /// For an input: it need not be connected, and ⊥ reaches the node. For an output: it may be ⊥ although the node
    /// fired.
    pub optional: bool,
    /// For one of any number of inputs: the port that the signature declares for all of them, which is the first.
    pub element_of: Option<usize>,
    /// Frame of its tokens, if the source file says one.
    pub frame: Option<Ident>,
    /// Parameter that the port reads or sets.
    pub parameter: Option<usize>,
    /// Meaning, if it is a port that every node has.
    pub standard: Option<Standard>,
    /// `true` for an event of a state machine that may come when `reset`, `cancel` or `resume` moves it.
    pub comes_with_moves: bool,
    /// A state machine may send on it when it has been in a state for some time.
    pub comes_with_time: bool,
    /// Documentation.
    pub docs: String,
}

/// Port `port` of node `node`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PortId {
    /// The node.
    pub node: NodeId,
    /// Number of the port in [`Node::ports`].
    pub port: usize,
}

/// Modifiers of the execution of a node.
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
    /// `skip`: a late source does not make up for the firings that it has missed.
    pub skip: bool,
    /// `essential`
    pub essential: bool,
    /// `restart`: a new node replaces the node after a failure.
    pub restart: bool,
}

impl NodeKind {
    /// Returns `true` for an observation point of a test.
    pub fn is_probe(&self) -> bool {
        matches!(self, Self::Probe)
    }
}

impl Modifiers {
    /// Returns `true` if a source with these modifiers is fired by a timer.
    pub fn has_pace(&self) -> bool {
        self.every.is_some() || self.after.is_some()
    }
}

impl Node {
    /// Makes the list of an `each` a required input, and the element a required input of the body.
    pub fn require_list(&mut self) {
        let NodeKind::Each(each) = &mut self.kind else { return };
        let Some(list) = each.list.and_then(|list| self.ports.get_mut(list)) else { return };
        list.optional = false;
        let is_element = |n: &&mut Self| matches!(n.kind, NodeKind::Boundary(PortKind::Input)) && n.name == list.name;
        if let Some(element) = each.body.nodes.iter_mut().find(is_element) {
            element.ports[0].optional = false;
        }
    }

    /// Its port of this kind, if it is used.
    pub fn standard(&self, standard: Standard) -> Option<usize> {
        self.ports.iter().position(|p| p.standard == Some(standard))
    }

    /// Number of the port that the signature declares for a port.
    pub fn declared(&self, port: usize) -> usize {
        self.ports[port].element_of.unwrap_or(port)
    }

    /// The ports of a declared port: those of all connections if it takes any number of them.
    pub fn elements(&self, port: usize) -> impl Iterator<Item = usize> {
        (0..self.ports.len()).filter(move |element| self.declared(*element) == port)
    }

    /// Returns `true` if the node can be disabled.
    pub fn can_be_disabled(&self) -> bool {
        self.standard(Standard::Disable).is_some()
    }

    /// The node or nested graph whose activity the node takes away and gives back.
    pub fn interrupts(&self) -> Option<Subject> {
        if let NodeKind::Interrupt(subject) = self.kind { Some(subject) } else { None }
    }

    /// Returns `true` if the node is a delay.
    pub fn is_delay(&self) -> bool {
        matches!(self.kind, NodeKind::Delay(_))
    }

    /// Returns `true` if failures of the node are contained: its event `failed` is used, or it restarts.
    pub fn is_contained(&self) -> bool {
        self.modifiers.restart || self.standard(Standard::Failed).is_some()
    }

    /// Returns `true` if the node may send nothing although it consumes tokens.
    pub fn may_produce_absent(&self) -> bool {
        self.can_be_disabled() || self.is_contained()
    }
}

impl Port {
    /// An optional port for one token per firing.
    pub fn new(name: &str, kind: PortKind, ty: Type) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            ty,
            rate: 1,
            optional: true,
            element_of: None,
            frame: None,
            parameter: None,
            standard: None,
            comes_with_moves: false,
            comes_with_time: false,
            docs: String::new(),
        }
    }

    /// Returns `true` for the events `activated` and `deactivated`.
    pub fn tells_of_activity(&self) -> bool {
        matches!(self.standard, Some(Standard::Activated | Standard::Deactivated))
    }
}
