//! State machines: an `fsm` item with its nested states becomes a table of transitions between the innermost ones
//! (thesis 7.2.1). It is used as a node with slots and events.

mod resolve;
mod translate;

pub use resolve::resolve;
pub use translate::translation;

use crate::{catalog::Type, graph::Value};

/// A resolved state machine.
#[derive(Debug, Clone)]
pub struct Machine {
    /// Its name.
    pub name: String,
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
    /// A condition on the token, as Rust.
    pub guard: Option<String>,
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
    /// The slot that is called at the start.
    pub const BEGIN: &str = "begin";
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
