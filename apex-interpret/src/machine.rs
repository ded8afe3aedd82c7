//! State machines: their transitions are looked up in the table from which their code is generated.

use crate::{Library, Value, condition};
use apex_dsl::{
    codegen::compute_guards,
    machine::{Arm, Machine, Move, Sending, Slot, Token},
};
use std::rc::Rc;

/// Tokens of events, by the numbers of their ports.
pub type Sent = Vec<(usize, Value)>;

/// A state machine in one of its states.
pub struct Running<'a> {
    machine: &'a Machine,
    library: &'a dyn Library,
    /// Its innermost state, and the states to which `resume` leads.
    now: Vec<usize>,
    /// The same before the last `cancel`.
    left: Option<Vec<usize>>,
    /// The times that have begun (`true`) or ended since they were last taken.
    waits: Vec<Option<bool>>,
}

impl<'a> Running<'a> {
    /// A machine in its first state.
    ///
    /// # Errors
    /// Returns what the interpreter does not know.
    pub fn new(machine: &'a Machine, library: &'a dyn Library) -> Result<Self, String> {
        compute_guards(machine)?;
        let mut running = Self { machine, library, now: first(machine), left: None, waits: vec![] };
        running.time_all();
        Ok(running)
    }

    /// Its innermost state.
    pub fn state(&self) -> usize {
        self.now[0]
    }

    /// Takes the times that have begun or ended.
    pub fn take_waits(&mut self) -> Vec<Option<bool>> {
        let none = vec![None; self.waits.len()];
        std::mem::replace(&mut self.waits, none)
    }

    /// A token comes to one of its slots, by the number of the port.
    pub fn slot(&mut self, port: usize, token: Option<&Value>) -> Sent {
        let machine = self.machine;
        match machine.slots.get(port - machine.events.len()) {
            Some(slot) => self.take(slot, token),
            None => self.sent(machine.begin(), None),
        }
    }

    /// A time in a state is over.
    pub fn expire(&mut self, wait: usize) -> Sent {
        self.take(&self.machine.waits[wait].slot, None)
    }

    /// Moves it to another state.
    pub fn go(&mut self, how: Move) -> Sent {
        let first = first(self.machine);
        match how {
            Move::Restart => {
                let sent = self.sent(&self.machine.exits[self.now[0]], None);
                (self.now, self.left) = (first, None);
                self.time_all();
                sent
            }
            Move::Cancel if self.now == first => vec![],
            Move::Cancel => {
                self.left = Some(self.now.clone());
                self.go_to(first)
            }
            Move::Resume => match self.left.take() {
                Some(left) => self.go_to(left),
                None => vec![],
            },
        }
    }

    fn go_to(&mut self, to: Vec<usize>) -> Sent {
        let (before, machine) = (self.now[0], self.machine);
        self.now = to;
        if self.now[0] == before {
            return vec![];
        }
        self.time_all();
        let sendings: Vec<&Sending> = machine.exits[before].iter().chain(&machine.entries[self.now[0]]).collect();
        self.sent(sendings, None)
    }

    /// Takes the first transition that fits.
    fn take(&mut self, slot: &'a Slot, token: Option<&Value>) -> Sent {
        let fits = |arm: &&Arm| {
            arm.state == self.now[0]
                && arm.remembered.is_none_or(|(memory, last)| self.now[1 + memory] == last)
                && arm
                    .guard
                    .as_ref()
                    .is_none_or(|guard| token.is_some_and(|token| condition::holds(guard, token, &slot.ty)))
        };
        let Some(arm) = slot.arms.iter().find(fits) else { return vec![] };
        if let Some(target) = arm.target {
            self.enter(arm, target);
        }
        self.sent(&arm.sends, token)
    }

    /// A transition leads to a state.
    fn enter(&mut self, arm: &Arm, target: usize) {
        self.now[0] = target;
        for (memory, kept) in self.machine.memories.iter().zip(&mut self.now[1..]) {
            if memory.states.contains(&target) {
                *kept = target;
            }
        }
        for (number, wait) in self.machine.waits.iter().enumerate() {
            let begins = arm.begins.contains(&number);
            if begins || wait.states.contains(&arm.state) && !wait.states.contains(&target) {
                self.waits[number] = Some(begins);
            }
        }
    }

    /// The times of its state begin, and all others end.
    fn time_all(&mut self) {
        self.waits = self.machine.waits.iter().map(|wait| Some(wait.states.contains(&self.now[0]))).collect();
    }

    fn sent<'s>(&self, sendings: impl IntoIterator<Item = &'s Sending>, token: Option<&Value>) -> Sent {
        let value = |sending: &Sending| match &sending.token {
            Token::Unit => Some(Rc::new(()) as Value),
            Token::Same => token.cloned(),
            Token::Value(value) => self.library.token(Some(value), &self.machine.events[sending.event].1),
        };
        sendings.into_iter().filter_map(|sending| Some((sending.event, value(sending)?))).collect()
    }
}

/// The first state, and the states to which `resume` leads before any other was entered.
fn first(machine: &Machine) -> Vec<usize> {
    [0].into_iter().chain(machine.memories.iter().map(|memory| memory.states[0])).collect()
}
