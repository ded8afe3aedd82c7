//! State machines.

use super::{Expr, Ident, PortItem};
use crate::source::Span;

/// `fsm Name { … }`
#[derive(Debug)]
pub struct FsmItem {
    /// Documentation.
    pub docs: String,
    /// Name of the machine.
    pub name: Ident,
    /// Slots and events.
    pub ports: Vec<PortItem>,
    /// States, of which the first is the initial one.
    pub states: Vec<StateItem>,
    /// From its documentation to its closing bracket.
    pub extent: Span,
}

/// `state name { … }`
#[derive(Debug)]
pub struct StateItem {
    /// Documentation.
    pub docs: String,
    /// Name of the state.
    pub name: Ident,
    /// Events that are triggered when it is entered.
    pub entry: Vec<Action>,
    /// Events that are triggered when it is left.
    pub exit: Vec<Action>,
    /// Transitions, in order.
    pub transitions: Vec<Transition>,
    /// States inside. The first of them is entered together with this state.
    pub states: Vec<StateItem>,
    /// From its documentation to its closing bracket.
    pub extent: Span,
}

/// `on slot if guard => state -> event, event(value);`, `after 5s => state;`
#[derive(Debug)]
pub struct Transition {
    /// The reason for it.
    pub cause: Cause,
    /// Condition for the transition.
    pub guard: Option<Expr>,
    /// The new state; `None` if the state remains the same.
    pub target: Option<Ident>,
    /// Return to the state inside the new one that was left last.
    pub returns: Option<Return>,
    /// Events that are triggered.
    pub actions: Vec<Action>,
}

/// Reason for a transition.
#[derive(Debug)]
pub enum Cause {
    /// A token at this slot.
    Slot(Ident),
    /// The machine has been in the state for so long.
    After(Expr),
}

impl Transition {
    /// The slot whose token causes it.
    pub fn slot(&self) -> Option<&Ident> {
        match &self.cause {
            Cause::Slot(slot) => Some(slot),
            Cause::After(_) => None,
        }
    }
}

/// `event`, `event(value)`
#[derive(Debug)]
pub struct Action {
    /// The event.
    pub event: Ident,
    /// The token; without it the token of the slot.
    pub value: Option<Expr>,
}

/// A return to what a state was in when it was left.
#[derive(Debug, Clone, Copy)]
pub struct Return {
    /// `true` for `resume`: to the last of its innermost states. `false` for `repeat`: to the state directly inside it,
    /// from its beginning.
    pub deep: bool,
    /// The word.
    pub span: Span,
}
