//! Translation of an `fsm` item into a table. Nested states are flattened: a transition of an outer state applies to
//! every state inside that has no transition of its own for the token.

use super::{
    condition::Conditions,
    scope::{Evaluated, Scope},
    suggest::{Known, everywhere, suggest, unknown},
    time::time,
    value::evaluate,
    wanted::Wanted,
};
use crate::{
    catalog::Type,
    graph::Condition,
    machine::{Arm, Machine, Memory, Sending, Slot, Token, Wait},
    report::{Diagnostic, Diagnostics},
    source::Span,
    syntax::tree::{Action, Cause, FsmItem, Ident, PortItem, PortKind, StateItem, Transition},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};

/// Largest number of innermost states. A larger machine would not be readable.
const MAX_STATES: usize = 1_000;

/// Largest number of transitions between innermost states.
const MAX_TRANSITIONS: usize = 50_000;

/// Resolves `item`. `ty` determines the types of its ports, `scope` the meaning of names in values and guards.
pub fn resolve(
    item: &FsmItem,
    ty: &dyn Fn(&PortItem) -> Type,
    scope: &Scope<'_>,
    diagnostics: &mut Diagnostics,
) -> Option<Machine> {
    let mut opener = Opener { item, ports: BTreeMap::new(), states: vec![], waits: vec![], scope, diagnostics };
    opener.add_ports(ty);
    for state in &item.states {
        opener.open(state, None);
    }
    if opener.states.is_empty() {
        let error = Diagnostic::error("no-state", item.name.span, format!("`{}` has no state", item.name.text));
        opener.diagnostics.push(error.note("the smallest state is `state name { }`"));
        return None;
    }
    if opener.states.len() > MAX_STATES {
        let message = format!("a state machine has at most {MAX_STATES} states");
        opener.diagnostics.push(Diagnostic::error("too-large", item.name.span, message));
        return None;
    }
    opener.machine()
}

/// A state and the state around it.
struct Open<'a> {
    item: &'a StateItem,
    parent: Option<usize>,
}

struct Opener<'a> {
    item: &'a FsmItem,
    ports: BTreeMap<&'a str, (&'a PortItem, Type)>,
    /// All states, outer ones before those inside.
    states: Vec<Open<'a>>,
    /// The transitions with `after`, each with its state and its time.
    waits: Vec<(usize, &'a Transition, Duration)>,
    scope: &'a Scope<'a>,
    diagnostics: &'a mut Diagnostics,
}

impl<'a> Opener<'a> {
    fn add_ports(&mut self, ty: &dyn Fn(&PortItem) -> Type) {
        for port in &self.item.ports {
            if port.kind.is_synchronous() {
                let message = format!(
                    "a state machine can only have slots and events, but `{}` is {} {}",
                    port.name.text,
                    port.kind.article(),
                    port.kind.word()
                );
                self.diagnostics.push(Diagnostic::error("fsm-port", port.name.span, message).note(
                    "outputs can be connected to its slots, and its events to inputs, without a node in between",
                ));
            }
            if let Some(frame) = &port.frame {
                let message = "a port of a state machine has no frame";
                self.diagnostics.push(
                    Diagnostic::error("fsm-port", frame.span, message)
                        .note("write it at a port of the graph: a machine hands tokens on as they are"),
                );
            }
            if let Some((first, _)) = self.ports.get(port.name.text.as_str()) {
                let message = format!("`{}` is already defined here", port.name.text);
                let error = Diagnostic::error("duplicate-name", port.name.span, message);
                self.diagnostics.push(error.also(first.name.span, "first defined here"));
                continue;
            }
            self.ports.insert(&port.name.text, (port, ty(port)));
        }
    }

    fn open(&mut self, item: &'a StateItem, parent: Option<usize>) {
        if let Some(first) = self.states.iter().find(|s| s.item.name.text == item.name.text) {
            let message = format!("`{}` is already a state of this machine", item.name.text);
            let error = Diagnostic::error("duplicate-name", item.name.span, message);
            self.diagnostics.push(error.also(first.item.name.span, "first defined here"));
        }
        self.states.push(Open { item, parent });
        let index = self.states.len() - 1;
        for transition in &item.transitions {
            let Cause::After(after) = &transition.cause else { continue };
            match time(after, self.scope) {
                Ok(time) if time.is_zero() => {
                    let message = "the time must be greater than zero";
                    self.diagnostics.push(Diagnostic::error("out-of-range", after.span, message));
                }
                Ok(time) => self.waits.push((index, transition, time)),
                Err(error) => self.diagnostics.push(*error),
            }
        }
        for inner in &item.states {
            self.open(inner, Some(index));
        }
    }

    /// A state and the states around it, from the inside out.
    fn around(&self, state: usize) -> Vec<usize> {
        std::iter::successors(Some(state), |s| self.states[*s].parent).collect()
    }

    /// The innermost state that is entered with `state`: always the first one inside.
    fn innermost(&self, mut state: usize) -> usize {
        while !self.states[state].item.states.is_empty() {
            // States are in the order of the source file, so that the first state inside follows its parent.
            state += 1;
        }
        state
    }

    fn path(&self, state: usize) -> String {
        let mut names: Vec<&str> =
            self.around(state).into_iter().map(|s| self.states[s].item.name.text.as_str()).collect();
        names.reverse();
        names.join(".")
    }

    fn machine(mut self) -> Option<Machine> {
        let leaves: Vec<usize> = (0..self.states.len()).filter(|s| self.states[*s].item.states.is_empty()).collect();
        let events: Vec<(String, Type)> = self.names(PortKind::Event);
        let slots = self.names(PortKind::Slot);
        let before = self.diagnostics.has_errors();
        // At the start nothing gives an event its token.
        let begin: Vec<&Action> = self.entry(leaves[0]);
        self.sendings(&begin, None);
        let entries = leaves.iter().map(|leaf| self.entry(*leaf)).collect::<Vec<_>>();
        let exits = leaves.iter().map(|leaf| self.exit(*leaf)).collect::<Vec<_>>();
        let mut machine = Machine {
            name: self.item.name.text.clone(),
            module: String::new(),
            is_own: false,
            docs: self.item.docs.clone(),
            states: leaves.iter().map(|s| self.path(*s)).collect(),
            entries: entries.iter().map(|actions| self.moved_from_outside(actions)).collect(),
            exits: exits.iter().map(|actions| self.moved_from_outside(actions)).collect(),
            memories: vec![],
            slots: slots.into_iter().map(|(name, ty)| Slot { name, ty, arms: vec![] }).collect(),
            waits: vec![],
            events,
        };
        self.check_names();
        if self.count(&leaves) > MAX_TRANSITIONS {
            let message = format!("a state machine has at most {MAX_TRANSITIONS} transitions between innermost states");
            let error = Diagnostic::error("too-large", self.item.name.span, message);
            self.diagnostics.push(error.note("a transition of a state counts once for each innermost state in it"));
            return None;
        }
        let mut reached = BTreeSet::from([0]);
        for (number, &leaf) in leaves.iter().enumerate() {
            for around in self.around(leaf) {
                for transition in &self.states[around].item.transitions {
                    let named = transition.slot();
                    let Some(slot) = machine.slots.iter().position(|s| named.is_some_and(|n| n.text == s.name)) else {
                        continue;
                    };
                    let arms = self.arms((number, leaf), transition, &leaves, &mut machine.memories);
                    // A state can be resumed only after it was entered.
                    reached.extend(arms.first().and_then(|arm| arm.target));
                    machine.slots[slot].arms.extend(arms);
                }
            }
        }
        for (state, transition, after) in self.waits.clone() {
            let is_in = |leaf: &usize| *leaf == state || self.is_inside(*leaf, state);
            let states: Vec<usize> = (0..leaves.len()).filter(|number| is_in(&leaves[*number])).collect();
            let mut arms = vec![];
            for &number in &states {
                arms.extend(self.arms((number, leaves[number]), transition, &leaves, &mut machine.memories));
            }
            reached.extend(arms.iter().filter_map(|arm| arm.target));
            let slot = Slot { name: format!("after {after:?}"), ty: Type::unit(), arms };
            machine.waits.push(Wait { after, states, slot });
        }
        for (number, &leaf) in leaves.iter().enumerate().filter(|(n, _)| !reached.contains(n)) {
            let message = format!("no transition leads to the state `{}`", machine.states[number]);
            self.diagnostics.push(Diagnostic::warning("never-entered", self.states[leaf].item.name.span, message));
        }
        (before || !self.diagnostics.has_errors()).then_some(machine)
    }

    fn names(&self, kind: PortKind) -> Vec<(String, Type)> {
        let ports = self.item.ports.iter().filter(|p| p.kind == kind);
        ports.map(|p| (p.name.text.clone(), self.ports[p.name.text.as_str()].1.clone())).collect()
    }

    /// Number of transitions between innermost states.
    fn count(&self, leaves: &[usize]) -> usize {
        let inside = |name: &Ident| {
            let named = self.states.iter().position(|state| state.item.name.text == name.text);
            named.map_or(0, |named| leaves.iter().filter(|leaf| self.is_inside(**leaf, named)).count())
        };
        let weight = |transition: &Transition| match &transition.target {
            Some(target) if transition.returns.is_some() => inside(target).max(1),
            _ => 1,
        };
        let of_state: Vec<usize> =
            self.states.iter().map(|state| state.item.transitions.iter().map(weight).sum()).collect();
        leaves.iter().flat_map(|leaf| self.around(*leaf)).map(|state| of_state[state]).sum()
    }

    /// Reports unknown slots and targets, and transitions that can never be taken.
    fn check_names(&mut self) {
        let states: Vec<&str> = self.states.iter().map(|s| s.item.name.text.as_str()).collect();
        let mut errors = vec![];
        for state in &self.states {
            let mut taken: BTreeMap<&str, Span> = BTreeMap::new();
            for transition in &state.item.transitions {
                if let Some(target) = &transition.target
                    && !states.contains(&target.text.as_str())
                {
                    errors.push(self.unknown_state(target));
                }
                errors.extend(self.nothing_to_resume(transition));
                let Some(slot) = transition.slot() else { continue };
                match self.ports.get(slot.text.as_str()) {
                    Some((port, _)) if port.kind == PortKind::Slot => {}
                    _ => errors.push(self.unknown(slot, PortKind::Slot)),
                }
                if let Some(first) = taken.get(slot.text.as_str()) {
                    let message = format!("unreachable transition: an earlier one already takes every `{}`", slot.text);
                    errors.push(Diagnostic::warning("never-taken", slot.span, message).also(*first, "this one"));
                } else if transition.guard.is_none() {
                    taken.insert(&slot.text, slot.span);
                }
            }
        }
        errors.extend(self.too_late());
        errors.into_iter().for_each(|e| self.diagnostics.push(e));
    }

    /// Warnings of times that never come, because the state is left before.
    fn too_late(&self) -> Vec<Diagnostic> {
        let mut warnings = vec![];
        for (number, (state, transition, after)) in self.waits.iter().enumerate() {
            let Cause::After(time) = &transition.cause else { continue };
            let leaves = |(other, (of, transition, before)): &(usize, &(usize, &Transition, Duration))| {
                of == state && transition.target.is_some() && (*before, *other) < (*after, number)
            };
            let earlier = self.waits.iter().enumerate().filter(leaves).min_by_key(|(_, wait)| wait.2);
            if let Some((_, (_, Transition { cause: Cause::After(first), .. }, before))) = earlier {
                let message = format!("unreachable transition: the state is left after {before:?}");
                let warning = Diagnostic::warning("never-taken", time.span, message);
                warnings.push(warning.also(first.span, "by this one"));
            }
        }
        warnings
    }

    /// The error about `resume` or `repeat` with a state that has no states inside.
    fn nothing_to_resume(&self, transition: &Transition) -> Option<Diagnostic> {
        let (word, target) = (transition.returns?.span, transition.target.as_ref()?);
        let state = self.states.iter().find(|state| state.item.name.text == target.text)?;
        if !state.item.states.is_empty() {
            return None;
        }
        let message = format!("`{}` has no states inside to return to", target.text);
        let before = Span { end: target.span.start, ..word };
        Some(Diagnostic::error("unknown-state", word, message).fix("enter the state itself", before, ""))
    }

    fn unknown_state(&self, target: &Ident) -> Diagnostic {
        let transitions = || self.states.iter().flat_map(|state| &state.item.transitions);
        let targets: Vec<&Ident> = transitions().filter_map(|transition| transition.target.as_ref()).collect();
        let uses: Vec<Span> = targets.iter().filter(|t| t.text == target.text).map(|t| t.span).collect();
        let known: Vec<Known<'_>> = self
            .states
            .iter()
            .map(|state| {
                let name = &state.item.name;
                Known { name: &name.text, declared: Some(name.span), used: targets.iter().any(|t| t.text == name.text) }
            })
            .collect();
        let message = format!("there is no state `{}`", target.text);
        unknown("unknown-state", message.clone(), target, &uses, &known)
            .unwrap_or_else(|| everywhere("unknown-state", message, target.span, &uses))
    }

    fn unknown(&self, name: &Ident, kind: PortKind) -> Diagnostic {
        let known: Vec<&str> =
            self.item.ports.iter().filter(|p| p.kind == kind).map(|p| p.name.text.as_str()).collect();
        let message = format!("`{}` has no {} `{}`", self.item.name.text, kind.word(), name.text);
        let error = Diagnostic::error("unknown-port", name.span, message);
        if kind == PortKind::Event && self.states.iter().any(|state| state.item.name.text == name.text) {
            return error.note(format!("`{0}` is a state: write `=> {0}` to enter it", name.text));
        }
        suggest(error, name, known.iter().copied())
    }

    /// The transitions from a leaf, given by its number and its state. With `resume` or `repeat` there is one for each
    /// state that may be remembered, the first one inside before the others.
    fn arms(
        &mut self,
        (number, leaf): (usize, usize),
        transition: &'a Transition,
        leaves: &[usize],
        memories: &mut Vec<Memory>,
    ) -> Vec<Arm> {
        let guard = self.guard(transition);
        let position =
            |this: &Self, name: &Ident| this.states.iter().position(|state| state.item.name.text == name.text);
        let Some(named) = transition.target.as_ref().and_then(|name| position(self, name)) else {
            let sends = self.sendings(&transition.actions.iter().collect::<Vec<_>>(), Some(transition));
            return vec![Arm { state: number, guard, remembered: None, target: None, sends, begins: vec![] }];
        };
        let first = leaves.iter().position(|leaf| *leaf == self.innermost(named));
        let inside: Vec<usize> = (0..leaves.len()).filter(|state| self.is_inside(leaves[*state], named)).collect();
        let Some(returns) = transition.returns.filter(|_| !inside.is_empty()) else {
            let (sends, begins) = self.moved(leaf, named, self.innermost(named), transition);
            return vec![Arm { state: number, guard, remembered: None, target: first, sends, begins }];
        };
        let of = self.path(named);
        let memory = memories.iter().position(|memory| memory.of == of).unwrap_or_else(|| {
            memories.push(Memory { of, states: inside.clone() });
            memories.len() - 1
        });
        let arm = |state: usize| {
            let entered = if returns.deep { leaves[state] } else { self.beginning(leaves[state], named) };
            let (sends, begins) = self.moved(leaf, named, entered, transition);
            let (remembered, target) = (Some((memory, state)), leaves.iter().position(|leaf| *leaf == entered));
            Arm { state: number, guard: guard.clone(), remembered, target, sends, begins }
        };
        inside.into_iter().map(arm).collect()
    }

    /// The innermost state with which the state directly inside `outer` begins that contains `leaf`.
    fn beginning(&self, leaf: usize, outer: usize) -> usize {
        let direct = self.around(leaf).into_iter().take_while(|state| *state != outer).last();
        self.innermost(direct.unwrap_or(leaf))
    }

    fn guard(&mut self, transition: &Transition) -> Option<Condition> {
        let (guard, name) = (transition.guard.as_ref()?, &transition.slot()?.text);
        let ty = self.ports.get(name.as_str()).map(|(_, ty)| ty.clone());
        let unit = Type::unit();
        let ty = ty.as_ref().unwrap_or(&unit);
        let read = Conditions { name, token: name, ty, scope: self.scope }.read(guard);
        read.map_err(|error| self.diagnostics.push_once(*error)).ok()
    }

    /// Tokens that a transition from `leaf` to the innermost state `inner` of the state `named` sends, in order, and
    /// the times that begin with it.
    fn moved(
        &mut self,
        leaf: usize,
        named: usize,
        inner: usize,
        transition: &'a Transition,
    ) -> (Vec<Sending>, Vec<usize>) {
        let mut actions: Vec<&Action> = vec![];
        let (around, entered) = (self.around(leaf), self.around(inner));
        // States around both the old and the new state are kept. The old state and the named target are not, so that a
        // transition to the current state leaves and enters it.
        let stays = |s: &usize| around.contains(s) && entered.contains(s) && *s != named && *s != leaf;
        let kept: BTreeSet<usize> =
            around.iter().copied().filter(stays).filter(|s| !self.is_inside(*s, named)).collect();
        for state in around.iter().filter(|s| !kept.contains(s)) {
            actions.extend(&self.states[*state].item.exit);
        }
        actions.extend(&transition.actions);
        for state in entered.iter().rev().filter(|s| !kept.contains(s)) {
            actions.extend(&self.states[*state].item.entry);
        }
        let is_entered = |state: usize| entered.contains(&state) && !kept.contains(&state);
        let begins = (0..self.waits.len()).filter(|wait| is_entered(self.waits[*wait].0)).collect();
        (self.sendings(&actions, Some(transition)), begins)
    }

    /// Actions when an innermost state is entered, with all states around it.
    fn entry(&self, leaf: usize) -> Vec<&'a Action> {
        self.around(leaf).into_iter().rev().flat_map(|state| &self.states[state].item.entry).collect()
    }

    /// Actions when an innermost state is left, with all states around it.
    fn exit(&self, leaf: usize) -> Vec<&'a Action> {
        self.around(leaf).into_iter().flat_map(|state| &self.states[state].item.exit).collect()
    }

    /// Tokens that are sent when `start`, `reset`, `cancel` or `resume` moves the machine. An event that carries the
    /// token of a transition has none then, and does not happen; of two tokens of one event the last counts.
    fn moved_from_outside(&mut self, actions: &[&'a Action]) -> Vec<Sending> {
        let events = self.names(PortKind::Event);
        let mut sends: BTreeMap<usize, Token> = BTreeMap::new();
        for action in actions {
            let event = events.iter().position(|(name, _)| *name == action.event.text);
            let Some((event, ty)) = event.map(|event| (event, &events[event].1)) else { continue };
            if action.value.is_none() && !ty.is_unit() {
                continue;
            }
            match self.token(action, ty, None) {
                Ok(token) => drop(sends.insert(event, token)),
                Err(error) => self.diagnostics.push_once(*error),
            }
        }
        sends.into_iter().map(|(event, token)| Sending { event, token }).collect()
    }

    /// Returns `true` if `state` is inside `outer`.
    fn is_inside(&self, state: usize, outer: usize) -> bool {
        state != outer && self.around(state).contains(&outer)
    }

    fn sendings(&mut self, actions: &[&'a Action], cause: Option<&'a Transition>) -> Vec<Sending> {
        let events = self.names(PortKind::Event);
        let mut sends: Vec<(Sending, Span)> = vec![];
        for action in actions {
            let Some(event) = events.iter().position(|(name, _)| *name == action.event.text) else {
                let error = self.unknown(&action.event, PortKind::Event);
                self.diagnostics.push_once(error);
                continue;
            };
            if let Some((_, first)) = sends.iter().find(|(s, _)| s.event == event) {
                let message = format!("one transition would trigger the event `{}` twice", action.event.text);
                let error = Diagnostic::error("twice", action.event.span, message).also(*first, "first triggered here");
                self.diagnostics.push_once(error.note("a transition can trigger each event only once"));
                continue;
            }
            match self.token(action, &events[event].1, cause) {
                Ok(token) => sends.push((Sending { event, token }, action.event.span)),
                Err(error) => self.diagnostics.push_once(*error),
            }
        }
        sends.into_iter().map(|(sending, _)| sending).collect()
    }

    fn token(&self, action: &Action, ty: &Type, cause: Option<&Transition>) -> Evaluated<Token> {
        match &action.value {
            Some(value) => {
                let name = &action.event.text;
                let declared = format!("`{name}` carries `{ty}`");
                let wanted = Wanted { name, ty, unit: None, range: None, declared };
                evaluate(value, self.scope).and_then(|token| wanted.fit(token, value)).map(Token::Value)
            }
            None if ty.is_unit() => Ok(Token::Unit),
            None => {
                let slot = cause.and_then(Transition::slot);
                let came = slot.and_then(|slot| self.ports.get(slot.text.as_str())).map(|(_, ty)| ty);
                match came {
                    Some(came) if came.compare(ty) != crate::catalog::Match::Different && !came.is_unit() => {
                        Ok(Token::Same)
                    }
                    _ => {
                        let name = &action.event.text;
                        let message = format!("`{name}` carries `{ty}`, but there is no token of this type here");
                        Err(Box::new(
                            Diagnostic::error("missing-argument", action.event.span, message)
                                .note(format!("give it a value: `{name}(…)`")),
                        ))
                    }
                }
            }
        }
    }
}
