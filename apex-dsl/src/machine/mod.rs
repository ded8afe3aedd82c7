//! State machines: an `fsm` item with its nested states becomes a table of transitions between the innermost ones
//! (thesis 7.2.1). It is used as a node with slots and events.

mod translate;

pub use translate::translation;

use crate::{
    catalog::{ArgSig, Catalog, MachineSig, PortSig, Signature, SignatureId, SlotSig, Type, WaitSig},
    graph::{Condition, Graph, Node, NodeId, NodeKind, Value},
    syntax::tree::PortKind,
};
use std::{collections::BTreeMap, path::PathBuf, time::Duration};

/// A resolved state machine.
#[derive(Debug, Clone)]
pub struct Machine {
    /// Name of the machine.
    pub name: String,
    /// Rust module of the machine, in the module of the source file.
    pub module: String,
    /// `true` if it is declared in the first source file.
    pub is_own: bool,
    /// Documentation.
    pub docs: String,
    /// The innermost states, by path: `fetch.drive`. The first one is the initial state.
    pub states: Vec<String>,
    /// For each innermost state, the events of the `entry` of it and of the states around it. Those of the initial
    /// state are triggered at the start.
    pub entries: Vec<Vec<Sending>>,
    /// For each innermost state, the events of the `exit` of it and of the states around it.
    pub exits: Vec<Vec<Sending>>,
    /// The states to which transitions with `resume` lead.
    pub memories: Vec<Memory>,
    /// Its slots.
    pub slots: Vec<Slot>,
    /// The times after which it leaves states by itself.
    pub waits: Vec<Wait>,
    /// Its events, with the types of their tokens.
    pub events: Vec<(String, Type)>,
}

/// A way from outside to move a machine to another state.
#[derive(Debug, Clone, Copy)]
pub enum Move {
    /// `reset`: it is left, and `start` enters its first state.
    Restart,
    /// `cancel`: back to its first state.
    Cancel,
    /// `resume`: back to where it was before `cancel`.
    Resume,
}

impl Move {
    /// The method that does it.
    pub fn method(self) -> &'static str {
        match self {
            Self::Restart => "restart",
            Self::Cancel => "cancel",
            Self::Resume => "resume",
        }
    }
}

/// The state machines in the source files of a program, by their signatures as nodes.
pub type Machines = BTreeMap<SignatureId, Machine>;

/// The state machines among the nodes of a graph.
pub fn machines<'a>(graph: &'a Graph, catalog: &'a Catalog) -> impl Iterator<Item = (NodeId, &'a MachineSig)> {
    let machine = |node: &Node| match &node.kind {
        NodeKind::Library(library) => catalog.signatures[library.signature].machine.as_ref(),
        _ => None,
    };
    graph.nodes.iter_enumerated().filter_map(move |(id, node)| Some((id, machine(node)?)))
}

/// A slot of a state machine.
#[derive(Debug, Clone)]
pub struct Slot {
    /// Name of the slot.
    pub name: String,
    /// Type of its tokens.
    pub ty: Type,
    /// Possible transitions, of which the first that fits is taken.
    pub arms: Vec<Arm>,
}

/// A time for which the machine may be in a state.
#[derive(Debug, Clone)]
pub struct Wait {
    /// The time since the state was entered.
    pub after: Duration,
    /// Its innermost states.
    pub states: Vec<usize>,
    /// Transitions then, as if a token without a value had come to a slot.
    pub slot: Slot,
}

/// A state whose last innermost state is remembered.
#[derive(Debug, Clone)]
pub struct Memory {
    /// Path of the state.
    pub of: String,
    /// Its innermost states. The first is remembered until another one was entered.
    pub states: Vec<usize>,
}

/// A transition from an innermost state.
#[derive(Debug, Clone)]
pub struct Arm {
    /// The current state.
    pub state: usize,
    /// A condition on the token.
    pub guard: Option<Condition>,
    /// Memory, by its number, and the state that it must hold: one of the arms of a transition with `resume`.
    pub remembered: Option<(usize, usize)>,
    /// The new state, if the transition has a target.
    pub target: Option<usize>,
    /// Events that are triggered: first those of exits, then of the transition, then of entries.
    pub sends: Vec<Sending>,
    /// The times that begin, because their states are entered. Those of states that it leaves end.
    pub begins: Vec<usize>,
}

/// An event that a transition triggers.
#[derive(Debug, Clone, PartialEq)]
pub struct Sending {
    /// Number of the event.
    pub event: usize,
    /// The token.
    pub token: Token,
}

/// Token of an event.
#[derive(Debug, Clone, PartialEq)]
pub enum Token {
    /// `()`
    Unit,
    /// The token that arrived at the slot.
    Same,
    /// A constant.
    Value(Value),
}

impl Machine {
    /// The slot that is called at the start. The parentheses keep its name apart from all names that can be written.
    pub const BEGIN: &str = "(begin)";

    /// Its slots, and those of the times after which it leaves states.
    pub fn all_slots(&self) -> impl Iterator<Item = &Slot> {
        self.slots.iter().chain(self.waits.iter().map(|wait| &wait.slot))
    }
}

impl Machine {
    /// The signature of the machine as a node with slots and events. It has the slot [`Self::BEGIN`] if the initial
    /// state triggers events.
    pub fn signature(&self, (file, line): (PathBuf, usize)) -> Signature {
        let port = |name: &str, kind, ty: &Type, index| PortSig {
            name: name.to_owned(),
            kind,
            ty: ty.clone(),
            rate: 1,
            optional: false,
            any_number: false,
            failure: false,
            index,
            field: None,
            field_is_option: false,
            docs: String::new(),
        };
        let events = self.events.iter().enumerate().map(|(i, (name, ty))| port(name, PortKind::Event, ty, i));
        let mut ports: Vec<PortSig> = events.collect();
        let mut slots = vec![];
        for (index, slot) in self.slots.iter().enumerate() {
            ports.push(port(&slot.name, PortKind::Slot, &slot.ty, index));
            let token = slot.uses_token().then(|| ArgSig::Port(ports.len() - 1));
            let args = token.into_iter().chain(slot.events().into_iter().map(ArgSig::Port)).collect();
            let method = Self::method(&slot.name);
            slots.push(SlotSig { port: ports.len() - 1, method, args, fallible: false });
        }
        if !self.begin().is_empty() {
            ports.push(port(Self::BEGIN, PortKind::Slot, &Type::unit(), self.slots.len()));
            let args = self.begin().iter().map(|s| ArgSig::Port(s.event)).collect();
            let method = Self::BEGIN_METHOD.to_owned();
            slots.push(SlotSig { port: ports.len() - 1, method, args, fallible: false });
        }
        Signature {
            name: self.name.clone(),
            docs: self.docs.clone(),
            file,
            line,
            path: vec!["super".to_owned(), self.module.clone(), self.name.clone()],
            stateful: true,
            computed: true,
            ports,
            slots,
            machine: Some(MachineSig {
                states: self.states.clone(),
                moved: self.moved(),
                waits: self.waits.iter().enumerate().map(|(number, wait)| wait.signature(number)).collect(),
            }),
            ..Signature::default()
        }
    }

    /// Events that are triggered at the start, because the initial state is entered.
    pub fn begin(&self) -> &[Sending] {
        &self.entries[0]
    }

    /// The events that may be triggered when `reset`, `cancel` or `resume` moves it to another state.
    pub fn moved(&self) -> Vec<usize> {
        events(self.exits.iter().chain(&self.entries).flatten())
    }

    /// The condition of a transition, as text.
    pub fn condition(&self, slot: &Slot, arm: &Arm) -> Option<String> {
        let remembered =
            |(memory, state): (usize, usize)| format!("{} was last {}", self.memories[memory].of, self.states[state]);
        let parts = arm.guard.iter().map(|guard| guard.text(&slot.name)).chain(arm.remembered.map(remembered));
        parts.reduce(|all, part| format!("{all}, {part}"))
    }

    /// The method that enters the initial state.
    pub const BEGIN_METHOD: &str = "begin";

    /// The method of a slot. The prefix keeps it apart from all other methods.
    pub fn method(slot: &str) -> String {
        format!("on_{slot}")
    }
}

impl Wait {
    fn signature(&self, number: usize) -> WaitSig {
        WaitSig { after: self.after, method: Self::method(number), events: self.slot.events() }
    }

    /// The method that is called when the time with this number is over.
    pub fn method(number: usize) -> String {
        format!("after_{}", number + 1)
    }
}

impl Slot {
    /// Returns `true` if its method uses the token.
    pub fn uses_token(&self) -> bool {
        self.arms.iter().any(|arm| arm.guard.is_some() || arm.sends.iter().any(|s| s.token == Token::Same))
    }

    /// The events that it may trigger.
    pub fn events(&self) -> Vec<usize> {
        events(self.arms.iter().flat_map(|arm| &arm.sends))
    }
}

/// The events of these sendings, each once.
fn events<'a>(sendings: impl Iterator<Item = &'a Sending>) -> Vec<usize> {
    let mut events: Vec<usize> = sendings.map(|sending| sending.event).collect();
    events.sort_unstable();
    events.dedup();
    events
}
