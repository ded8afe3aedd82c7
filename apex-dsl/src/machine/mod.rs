//! State machines: an `fsm` item with its nested states becomes a table of transitions between the innermost ones
//! (thesis 7.2.1). It is used as a node with slots and events.

mod translate;

pub use translate::translation;

use crate::{
    catalog::{ArgSig, PortSig, Signature, SignatureId, SlotSig, Type},
    graph::{Condition, Value},
    syntax::tree::PortKind,
};
use std::{collections::BTreeMap, path::PathBuf};

/// A resolved state machine.
#[derive(Debug, Clone)]
pub struct Machine {
    /// Its name.
    pub name: String,
    /// Its Rust module in that of the text.
    pub module: String,
    /// It stands in the text that was read first.
    pub is_own: bool,
    /// Documentation.
    pub docs: String,
    /// The innermost states, by path: `fetch.drive`. It begins in the first.
    pub states: Vec<String>,
    /// What is triggered at the start, because the first state is entered.
    pub begin: Vec<Sending>,
    /// Its slots.
    pub slots: Vec<Slot>,
    /// Its events, with the types of their tokens.
    pub events: Vec<(String, Type)>,
}

/// The state machines of a program's texts, by the nodes that they are.
pub type Machines = BTreeMap<SignatureId, Machine>;

/// A slot of a state machine.
#[derive(Debug, Clone)]
pub struct Slot {
    /// Its name.
    pub name: String,
    /// The type of its tokens.
    pub ty: Type,
    /// What happens; the first that fits is done.
    pub arms: Vec<Arm>,
}

/// A transition from an innermost state.
#[derive(Debug, Clone)]
pub struct Arm {
    /// The state.
    pub state: usize,
    /// A condition on the token.
    pub guard: Option<Condition>,
    /// The state that it leads to, if it leads anywhere.
    pub target: Option<usize>,
    /// What is triggered: what is left, then the transition, then what is entered.
    pub sends: Vec<Sending>,
}

/// An event that a transition triggers.
#[derive(Debug, Clone, PartialEq)]
pub struct Sending {
    /// The event, by number.
    pub event: usize,
    /// The token.
    pub token: Token,
}

/// What an event carries.
#[derive(Debug, Clone, PartialEq)]
pub enum Token {
    /// `()`
    Unit,
    /// The token that came to the slot.
    Same,
    /// A constant.
    Value(Value),
}

impl Machine {
    /// The slot that is called at the start: a name that no text can give to one.
    pub const BEGIN: &str = "(begin)";
}

impl Machine {
    /// A state machine as a node: slots and events. If something happens when it starts, `begin` is a slot too.
    pub fn signature(&self, (file, line): (PathBuf, usize)) -> Signature {
        let port = |name: &str, kind, ty: &Type, index| PortSig {
            name: name.to_owned(),
            kind,
            ty: ty.clone(),
            rate: 1,
            optional: false,
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
        if !self.begin.is_empty() {
            ports.push(port(Self::BEGIN, PortKind::Slot, &Type::unit(), self.slots.len()));
            let args = self.begin.iter().map(|s| ArgSig::Port(s.event)).collect();
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
            ports,
            slots,
            ..Signature::default()
        }
    }

    /// The method that enters the first state.
    pub const BEGIN_METHOD: &str = "begin";

    /// The method of a slot, which is none of the others, whatever the slot is called.
    pub fn method(slot: &str) -> String {
        format!("on_{slot}")
    }
}

impl Slot {
    /// Whether its method looks at the token.
    pub fn uses_token(&self) -> bool {
        self.arms.iter().any(|arm| arm.guard.is_some() || arm.sends.iter().any(|s| s.token == Token::Same))
    }

    /// The events that it may trigger.
    pub fn events(&self) -> Vec<usize> {
        let mut events: Vec<usize> = self.arms.iter().flat_map(|arm| &arm.sends).map(|s| s.event).collect();
        events.sort_unstable();
        events.dedup();
        events
    }
}
