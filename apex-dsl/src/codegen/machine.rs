//! A state machine as Rust: an enum of its states, and a method with one `match` for each slot.

use super::{
    condition::holds,
    tokens::{constant, ident, to_rust},
};
use crate::{
    catalog::{Catalog, Type},
    machine::{Arm, Machine, Move, Sending, Slot, Token, Wait},
};
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens as _, format_ident, quote};
use syn::Ident;

/// Name of the enum of states: `State`, unless the machine is called so.
pub fn states_name(machine: &Machine) -> Ident {
    ident(if machine.name == "State" { "States" } else { "State" })
}

/// Rust for a state machine.
pub fn item(machine: &Machine, catalog: &Catalog) -> TokenStream {
    let (name, states_name) = (ident(&machine.name), states_name(machine));
    let docs =
        if machine.docs.is_empty() { format!("The state machine `{}`.", machine.name) } else { machine.docs.clone() };
    let states = states(machine);
    let first = &states[0];
    let texts = &machine.states;
    let known = machine.memories.iter().map(|memory| &states[memory.states[0]]);
    let (places, moves) = (1 + machine.memories.len(), moves(machine, &states, catalog));
    let methods = machine.slots.iter().map(|slot| {
        let docs = format!("What it does about a token at `{}`.", slot.name);
        method(machine, &Machine::method(&slot.name), &docs, slot, &states, catalog)
    });
    let expired = machine.waits.iter().enumerate().map(|(number, wait)| {
        let docs = format!("What it does {} after a state was entered.", wait.slot.name);
        method(machine, &Wait::method(number), &docs, &wait.slot, &states, catalog)
    });
    let Waits { field, first: waits_first, function } = waits(machine);
    let begin = begin(machine, catalog);
    let slots = machine.slots.iter().map(|slot| &slot.ty).chain((!machine.begin().is_empty()).then_some(&UNIT));
    let slots = slots.enumerate().map(|(i, ty)| {
        let ty = token_type(ty, catalog);
        quote! { impl ::apex_rt::Slot<#i> for #name { type Token = #ty; } }
    });
    let events = machine.events.iter().enumerate().map(|(i, (_, ty))| {
        let ty = token_type(ty, catalog);
        quote! { impl ::apex_rt::Trigger<#i> for #name { type Token = #ty; } }
    });
    quote! {
        #[doc = #docs]
        #[derive(Debug)]
        pub struct #name {
            /// Its state, and the states to which `resume` leads.
            now: [#states_name; #places],
            /// The same before the last `cancel`.
            left: Option<[#states_name; #places]>,
            #field
        }
        /// The states of the machine.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum #states_name { #(#[doc = #texts] #states,)* }
        impl #name {
            /// The state that it is in.
            pub fn state(&self) -> #states_name { self.now[0] }
            #(#methods)*
            #(#expired)*
            #function
            #begin
            const FIRST: [#states_name; #places] = [#states_name::#first, #(#states_name::#known,)*];
            #moves
        }
        impl ::apex_rt::Construct<()> for #name {
            fn construct((): ()) -> Self { Self { now: Self::FIRST, left: None, #waits_first } }
        }
        const _: () = { #(#slots)* #(#events)* };
    }
}

static UNIT: Type = Type::Tuple(vec![]);

/// The names of the states in the enum: `fetch.drive` → `FetchDrive`.
fn states(machine: &Machine) -> Vec<Ident> {
    let mut names: Vec<Ident> = vec![];
    for state in &machine.states {
        let mut name = crate::graph::camel(&state.replace('.', "_"));
        // The only word of Rust with a capital letter; and nothing is left of `__`.
        if name == "Self" || name.is_empty() {
            name.push_str("State_");
        }
        while names.iter().any(|other| *other == name) {
            name.push('_');
        }
        names.push(ident(&name));
    }
    names
}

fn token_type(ty: &Type, catalog: &Catalog) -> TokenStream {
    to_rust(ty, catalog).unwrap_or_else(|| ty.without_unit().to_string().parse().unwrap_or_default())
}

/// The arguments for the events that a method may trigger.
fn event_args(machine: &Machine, events: &[usize], catalog: &Catalog) -> Vec<TokenStream> {
    let arg = |event: &usize| {
        let (name, ty) = &machine.events[*event];
        let (name, ty) = (event_arg(name), token_type(ty, catalog));
        quote!(#name: ::apex_rt::Event<#ty>)
    };
    events.iter().map(arg).collect()
}

/// Events and the token are both arguments.
fn event_arg(name: &str) -> Ident {
    format_ident!("event_{name}")
}

/// Code for the times of the states of a machine.
struct Waits {
    /// Field for the times that have begun or ended since the program asked.
    field: TokenStream,
    /// Its value at the start.
    first: TokenStream,
    /// The method by which the program asks.
    function: TokenStream,
}

fn waits(machine: &Machine) -> Waits {
    let count = machine.waits.len();
    if count == 0 {
        return Waits { field: quote!(), first: quote!(), function: quote!() };
    }
    let first = in_state(machine, 0);
    Waits {
        field: quote! {
            /// The times that have begun (`true`) or ended since the last call of `waits`.
            waits: [Option<bool>; #count],
        },
        first: quote! { waits: [#(#first),*], },
        function: quote! {
            /// The times of its states that have begun (`true`) or ended since the last call.
            #[inline]
            pub fn waits(&mut self) -> [Option<bool>; #count] {
                ::core::mem::replace(&mut self.waits, [None; #count])
            }
        },
    }
}

/// The times of the states that a machine is in, which begin, and the others, which end.
fn in_state(machine: &Machine, state: usize) -> Vec<TokenStream> {
    let begins = |wait: &Wait| wait.states.contains(&state);
    machine.waits.iter().map(begins).map(|begins| quote!(Some(#begins))).collect()
}

/// The times that begin and end with a transition.
fn waited(machine: &Machine, arm: &Arm) -> TokenStream {
    let Some(target) = arm.target else { return quote!() };
    let turns = machine.waits.iter().enumerate().filter_map(|(number, wait)| {
        let begins = arm.begins.contains(&number);
        let ends = wait.states.contains(&arm.state) && !wait.states.contains(&target);
        (begins || ends).then(|| quote! { self.waits[#number] = Some(#begins); })
    });
    turns.collect()
}

fn method(machine: &Machine, name: &str, docs: &str, slot: &Slot, states: &[Ident], catalog: &Catalog) -> TokenStream {
    let (name, states_name) = (ident(name), states_name(machine));
    let token = slot.uses_token().then(|| {
        let ty = token_type(&slot.ty, catalog);
        quote!(token: &#ty,)
    });
    let events = event_args(machine, &slot.events(), catalog);
    let arms = slot.arms.iter().map(|arm| {
        let state = &states[arm.state];
        let guard = arm.guard.as_ref().map(|guard| holds(guard, &slot.ty));
        let memory = arm.remembered.map(|(memory, last)| {
            let (memory, last) = (remembered(memory), &states[last]);
            quote!(self.now[#memory] == #states_name::#last)
        });
        let guard = match (guard, memory) {
            (Some(guard), Some(memory)) => quote!(if #memory && (#guard)),
            (Some(condition), None) | (None, Some(condition)) => quote!(if #condition),
            (None, None) => quote!(),
        };
        let target = arm.target.map(|target| {
            let inside = machine.memories.iter().enumerate().filter(|(_, memory)| memory.states.contains(&target));
            let kept = inside.map(|(memory, _)| remembered(memory));
            let target = &states[target];
            quote! { self.now[0] = #states_name::#target; #(self.now[#kept] = self.now[0];)* }
        });
        let sends = arm.sends.iter().map(|sending| send(machine, sending));
        let waited = waited(machine, arm);
        quote! { #states_name::#state #guard => { #target #waited #(#sends)* } }
    });
    quote! {
        #[doc = #docs]
        #[inline]
        pub fn #name(&mut self, #token #(#events),*) {
            match self.now[0] { #(#arms)* _ => {} }
        }
    }
}

/// Place of the last innermost state of a state.
fn remembered(memory: usize) -> Literal {
    Literal::usize_unsuffixed(1 + memory)
}

fn begin(machine: &Machine, catalog: &Catalog) -> TokenStream {
    let begin = machine.begin();
    if begin.is_empty() {
        return quote!();
    }
    let (name, events) = (ident(Machine::BEGIN_METHOD), begin.iter().map(|s| s.event).collect::<Vec<_>>());
    let (args, sends) = (event_args(machine, &events, catalog), begin.iter().map(|s| send(machine, s)));
    quote! {
        /// Its first state is entered.
        pub fn #name(&mut self, #(#args),*) { #(#sends)* }
    }
}

/// The methods by which `reset`, `cancel` and `resume` move the machine to another state.
fn moves(machine: &Machine, states: &[Ident], catalog: &Catalog) -> TokenStream {
    let (states_name, places) = (states_name(machine), 1 + machine.memories.len());
    let moved = machine.moved();
    let args = event_args(machine, &moved, catalog);
    let names: Vec<Ident> = moved.iter().map(|event| event_arg(&machine.events[*event].0)).collect();
    let sends = |sendings: &[Vec<Sending>]| -> TokenStream {
        let of_states = states.iter().zip(sendings).filter(|(_, sends)| !sends.is_empty());
        let arms = of_states.map(|(state, sends)| {
            let sends = sends.iter().map(|sending| {
                let event = event_arg(&machine.events[sending.event].0);
                send_on(machine, sending, &quote!(#event.by_ref()))
            });
            quote! { #states_name::#state => { #(#sends)* } }
        });
        let arms: TokenStream = arms.collect();
        if arms.is_empty() {
            arms
        } else {
            quote! { match self.now[0] { #arms _ => {} } }
        }
    };
    let (leave, enter) = (sends(&machine.exits), sends(&machine.entries));
    let wait = (!machine.waits.is_empty()).then(|| {
        let arms = states.iter().enumerate().map(|(number, state)| {
            let waits = in_state(machine, number);
            quote! { #states_name::#state => [#(#waits),*], }
        });
        quote! { self.waits = match self.now[0] { #(#arms)* }; }
    });
    let [restart, cancel, resume] = [Move::Restart, Move::Cancel, Move::Resume].map(|how| ident(how.method()));
    quote! {
        /// It is left. Its first state is entered at `start`.
        #[allow(unused_mut, unused_variables)]
        pub fn #restart(&mut self, #(mut #args),*) {
            #leave
            (self.now, self.left) = (Self::FIRST, None);
            #wait
        }
        /// It goes back to its first state, and remembers where it was.
        pub fn #cancel(&mut self, #(#args),*) {
            if self.now != Self::FIRST {
                self.left = Some(self.now);
                self.go(Self::FIRST, #(#names),*);
            }
        }
        /// It goes back to where it was before `cancel`.
        pub fn #resume(&mut self, #(#args),*) {
            if let Some(left) = self.left.take() {
                self.go(left, #(#names),*);
            }
        }
        #[allow(unused_mut, unused_variables)]
        fn go(&mut self, to: [#states_name; #places], #(mut #args),*) {
            let moves = to[0] != self.now[0];
            if moves { #leave }
            self.now = to;
            if moves { #wait #enter }
        }
    }
}

fn send(machine: &Machine, sending: &Sending) -> TokenStream {
    let event = event_arg(&machine.events[sending.event].0);
    send_on(machine, sending, &event.into_token_stream())
}

fn send_on(machine: &Machine, sending: &Sending, event: &TokenStream) -> TokenStream {
    let ty = &machine.events[sending.event].1;
    match &sending.token {
        Token::Unit => quote! { #event.emit(()); },
        Token::Same => quote! { #event.emit(::core::clone::Clone::clone(token)); },
        Token::Value(value) => {
            let value = constant(value, ty);
            quote! { #event.emit(#value); }
        }
    }
}
