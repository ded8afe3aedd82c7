//! Time: the timers of sources, the timeouts of nodes, and when a program wants to be called because of them.

use super::{
    field::{Kind, StateField},
    generator::Generator,
    numbered::{Arm, Numbered},
    stamps,
    tokens::nanos,
    view::ProgramView,
};
use crate::{
    analyse::silence_parameter,
    graph::{ConnectionId, NodeId},
    program::{Entering, Entry, Flag, Silence, Timeout, is_buffer},
};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use std::time::Duration;
use syn::Ident;

/// Something that happens at a time.
#[derive(PartialEq, Eq)]
enum Timed {
    Timer,
    Timeout,
    Silence,
}

impl Generator<'_> {
    /// Timers and timeouts in the state of a program.
    pub fn timer_state(&self, view: ProgramView<'_>) -> Vec<StateField> {
        let ProgramView { graph, wiring, .. } = view;
        let mut kept = vec![];
        let of = |nodes: &mut dyn Iterator<Item = NodeId>| nodes.map(|node| graph.path(node)).collect();
        if !wiring.timers.is_empty() {
            let timers = wiring.timers.iter().map(|(node, _)| {
                let modifiers = &graph.nodes[*node].modifiers;
                let first = nanos(modifiers.after.unwrap_or_default());
                let period = nanos(modifiers.every.unwrap_or(Duration::MAX));
                quote!(::apex_rt::Timer::new(#first, #period))
            });
            let (count, make) = (wiring.timers.len(), quote!([#(#timers),*]));
            let of = of(&mut wiring.timers.iter().map(|(node, _)| *node));
            kept.push(StateField::list(
                Kind::Timer,
                of,
                format_ident!("timers"),
                quote!([::apex_rt::Timer; #count]),
                make,
            ));
        }
        if !wiring.timeouts.is_empty() {
            let count = wiring.timeouts.len();
            let (ty, make) =
                (quote!([::apex_rt::Timeout; #count]), quote!([const { ::apex_rt::Timeout::new() }; #count]));
            let of = of(&mut wiring.timeouts.iter().map(|timeout| timeout.node));
            kept.push(StateField::list(Kind::Timer, of, format_ident!("timeouts"), ty, make));
        }
        if !wiring.silences.is_empty() {
            let count = wiring.silences.len();
            let (ty, make) =
                (quote!([::apex_rt::Timeout; #count]), quote!([const { ::apex_rt::Timeout::new() }; #count]));
            let of = wiring.silences.iter().map(|silence| view.analysis.guards[silence.guard].text(graph));
            kept.push(StateField::list(Kind::Timer, of.collect(), format_ident!("silences"), ty, make));
        }
        kept
    }

    /// Lists of everything that happens at a time, with their lengths.
    fn timed(view: ProgramView<'_>) -> impl Iterator<Item = (Timed, TokenStream, usize)> {
        let wiring = view.wiring;
        let lists = [
            (Timed::Timer, quote!(core.timers), wiring.timers.len()),
            (Timed::Timeout, quote!(core.timeouts), wiring.timeouts.len()),
            (Timed::Silence, quote!(core.silences), wiring.silences.len()),
        ];
        lists.into_iter().filter(|(.., count)| *count > 0)
    }

    /// The next instant of a reaction: the earliest time after the last instant at which something is due, else `now`.
    pub fn next_instant(&self, view: ProgramView<'_>) -> TokenStream {
        let each = Self::timed(view).map(|(_, list, count)| match view.wiring.has_agenda() {
            true => quote! { for timed in &self.#list { at = timed.instant(last, at); } },
            false => (0..count).map(|index| quote! { at = self.#list[#index].instant(last, at); }).collect(),
        });
        let each: TokenStream = each.collect();
        let each = match view.wiring.has_agenda() {
            true => quote! { if self.core.agenda.is_due(now) { #each } },
            false => each,
        };
        quote! {
            let last = self.state.time.last();
            let mut at = now;
            #each
            self.state.time.begin(at);
        }
    }

    /// Sources with `skip` leave out the firings that they have missed.
    pub fn skips(&self, view: ProgramView<'_>) -> TokenStream {
        let timers = view.wiring.timers.iter().enumerate();
        let skipping = timers.filter(|(_, (node, _))| view.graph.nodes[*node].modifiers.skip);
        let skips = skipping.map(|(timer, _)| quote! { self.core.timers[#timer].skip(now); });
        let skips: TokenStream = skips.collect();
        match view.wiring.has_agenda() && !skips.is_empty() {
            true => quote! { if self.core.agenda.is_due(now) { #skips self.core.agenda.open(); } },
            false => skips,
        }
    }

    /// The times of silences begin.
    pub fn hear(&self, view: ProgramView<'_>, silences: &[usize]) -> TokenStream {
        let starts = silences.iter().map(|index| {
            let after = self.silence(view, &view.wiring.silences[*index]);
            quote! { core.silences[#index].start(ctx.now(), #after); }
        });
        let open = self.open_agenda(view);
        quote! { #(#starts)* #open }
    }

    /// Duration of a silence: the shortest of its nodes.
    fn silence(&self, view: ProgramView<'_>, silence: &Silence) -> TokenStream {
        let times = silence.groups.iter().map(|group| match view.wiring.patience[*group].as_slice() {
            [node] => self.patience(view, *node),
            _ => {
                let name = patience_of(*group);
                quote!(Self::#name(nodes))
            }
        });
        times
            .reduce(|shortest, next| quote!(#shortest.min(#next)))
            .unwrap_or_else(|| self.bug(view.graph.nodes[NodeId::from(0)].span, "a silence has no node"))
    }

    /// Functions for the groups of nodes that miss the same tokens: how long they do without them.
    pub fn patience_functions(&self, view: ProgramView<'_>) -> TokenStream {
        let several = view.wiring.patience.iter().enumerate().filter(|(_, nodes)| nodes.len() > 1);
        let functions = several.map(|(group, nodes)| {
            let (name, ty) = (patience_of(group), self.nodes_type(view));
            let times = nodes.iter().map(|node| self.patience(view, *node));
            quote! {
                fn #name(nodes: &mut #ty) -> ::core::time::Duration {
                    let times = [#(#times),*];
                    times.into_iter().fold(::core::time::Duration::MAX, ::core::cmp::Ord::min)
                }
            }
        });
        functions.collect()
    }

    /// Time for which a node does without a token.
    fn patience(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        let Some(parameter) = silence_parameter(view.graph, self.catalog, node) else {
            return self.bug(view.graph.nodes[node].span, "a node that misses tokens has no `silence`");
        };
        let (place, parameter) = (self.node_place(view.graph, node), Literal::usize_unsuffixed(parameter));
        quote!(::apex_rt::endured::<#parameter, _>(&mut #place))
    }

    /// Silences that have lasted too long: ⊥ takes the place of the tokens that did not come.
    pub fn silences_end(&self, view: ProgramView<'_>) -> TokenStream {
        let is_input = |silence: &Silence| matches!(silence.entry, Entry::Input { .. });
        let silences: Vec<(usize, &Silence)> = view.wiring.silences.iter().enumerate().collect();
        let runs = silences.chunk_by(|(_, a), (_, b)| is_input(a) && is_input(b));
        let ends = runs.map(|run| match run {
            [(index, silence)] => self.silence_ends(view, *index, silence),
            inputs => {
                let raises = inputs.iter().filter_map(|(_, silence)| match silence.entry {
                    Entry::Input { raises } => Some(Literal::usize_unsuffixed(raises)),
                    Entry::Connection { .. } => None,
                });
                let first = Literal::usize_unsuffixed(inputs[0].0);
                let ends = silence_of_input(&quote!(silence), &quote!(bit));
                quote! { for (silence, bit) in (#first..).zip([#(#raises),*]) { #ends } }
            }
        });
        ends.collect()
    }

    fn silence_ends(&self, view: ProgramView<'_>, index: usize, silence: &Silence) -> TokenStream {
        match &silence.entry {
            Entry::Input { raises } => silence_of_input(&quote!(#index), &quote!(#raises)),
            Entry::Connection { connection, raises, occupies, free } => {
                let (clear, stamp) = self.absent_on(view, *connection);
                quote! {
                    if quiet && self.core.silences[#index].is_due(at) #(&& self.core.dispatcher.has(#free))* {
                        #clear
                        #stamp
                        self.core.dispatcher.clear(#occupies);
                        self.core.dispatcher.raise(#raises);
                        quiet = false;
                    }
                }
            }
        }
    }

    /// Puts ⊥ on an asynchronous connection, with the time of the instant as its stamp.
    fn absent_on(&self, view: ProgramView<'_>, connection: ConnectionId) -> (TokenStream, Option<TokenStream>) {
        let from = view.graph.connections[connection].from;
        let name = self.name(from);
        let clear = match is_buffer(view.graph, self.catalog, from) {
            true => quote! { self.state.#name.clear(); },
            false => quote! { self.state.#name = None; },
        };
        (clear, stamps::of_connection(view, connection).map(|stamp| quote! { self.#stamp = at; }))
    }

    /// A timer changes.
    pub fn open_agenda(&self, view: ProgramView<'_>) -> Option<TokenStream> {
        view.wiring.has_agenda().then(|| quote! { core.agenda.open(); })
    }

    /// The guards of timers that are due hold.
    pub fn timers_due(&self, view: ProgramView<'_>) -> TokenStream {
        let timers = &view.wiring.timers;
        if timers.is_empty() {
            return quote!();
        }
        if view.wiring.has_agenda() {
            let bits = timers.iter().map(|(_, bit)| Literal::usize_unsuffixed(*bit));
            return quote! {
                for (timer, bit) in self.core.timers.iter().zip([#(#bits),*]) {
                    if timer.is_due(at) { self.core.dispatcher.raise(bit); }
                }
            };
        }
        let looks = timers.iter().enumerate().map(|(index, (_, bit))| {
            quote! { if self.core.timers[#index].is_due(at) { self.core.dispatcher.raise(#bit); } }
        });
        looks.collect()
    }

    /// The time has gone back since the event of `node` was last triggered.
    pub fn goes_back(&self, view: ProgramView<'_>, Entering { node, free, then }: &Entering) -> TokenStream {
        let told = Self::told_ahead(*node);
        let (test, then) = (self.allows(view, free), self.ops(view, then));
        quote! {
            if self.state.#told != self.state.time.ahead() #test {
                let Self { state, core, .. } = self;
                state.#told = state.time.ahead();
                #then
                quiet = false;
            }
        }
    }

    /// Field with how far the program's time was ahead when the event of `node` was last triggered.
    pub fn told_ahead(node: NodeId) -> Ident {
        format_ident!("ahead_{}", node.index())
    }

    /// When a program wants to be called because of its timers.
    pub fn wishes(&self, view: ProgramView<'_>) -> TokenStream {
        if !view.wiring.has_agenda() {
            let wishes = Self::timed(view).flat_map(|(_, list, count)| {
                (0..count).map(move |index| quote! { next = next.or(self.#list[#index].wish(at)); })
            });
            return wishes.collect();
        }
        let wishes = Self::timed(view).map(|(what, list, _)| {
            // What is due already, but held back, is looked at again.
            let held_back = (what != Timed::Timer).then(|| quote! { held_back |= timed.is_due(at); });
            quote! { for timed in &self.#list { wish = wish.or(timed.wish(at)); #held_back } }
        });
        quote! {
            if self.core.agenda.is_due(at) {
                let (mut wish, mut held_back) = (::apex_rt::Next::Input, false);
                #(#wishes)*
                self.core.agenda.close(wish, held_back);
            }
            next = next.or(self.core.agenda.wish());
        }
    }

    /// Conditions under which a timeout that is due expires. A node that is disabled sends nothing; it does so when it
    /// is enabled, if it is still active.
    fn may_expire(&self, view: ProgramView<'_>, timeout: &Timeout) -> Option<TokenStream> {
        let needs = timeout.needs.iter().map(|bit| quote!(self.core.dispatcher.has(#bit)));
        let enabled = view.graph.nodes[timeout.node].can_be_disabled().then(|| {
            let is_enabled = self.is_set(Flag::Enabled(timeout.node));
            quote!(self.#is_enabled)
        });
        needs.chain(enabled).reduce(|all, test| quote!(#all && #test))
    }

    /// Functions for the timeouts by number, and the one by which the first of them expires that is due and can.
    pub fn expire_functions(&self, view: ProgramView<'_>) -> TokenStream {
        let timeouts = &view.wiring.timeouts;
        if timeouts.is_empty() {
            return quote!();
        }
        let arms = (0..timeouts.len()).map(|index| self.timeout_arm(view, index)).collect();
        let numbered = Numbered { name: "timeout", count: timeouts.len(), arms, rest: quote!({}) };
        let (functions, call) = (numbered.functions(), numbered.call());
        let tests = timeouts.iter().enumerate().filter_map(|(index, timeout)| {
            let (index, test) = (Literal::usize_unsuffixed(index), self.may_expire(view, timeout)?);
            Some(quote! { #index => #test, })
        });
        let tests: Vec<TokenStream> = tests.collect();
        let test = (!tests.is_empty()).then(|| quote! { && match timeout { #(#tests)* _ => true } });
        let count = Literal::usize_unsuffixed(timeouts.len());
        quote! {
            #functions
            /// The first timeout expires that is due and can. Returns `true` if there is one.
            #[inline]
            fn expire<O: ::apex_rt::Observer>(&mut self, at: ::apex_rt::Time, ctx: &::apex_rt::Ctx, observer: &mut O) -> bool {
                for timeout in 0..#count {
                    if self.core.timeouts[timeout as usize].is_due(at) #test {
                        #call
                        return true;
                    }
                }
                false
            }
        }
    }

    /// The event of a timeout is triggered, with the activity of the node.
    fn timeout_arm(&self, view: ProgramView<'_>, index: usize) -> Arm {
        let (graph, Timeout { node, wait, .. }) = (view.graph, &view.wiring.timeouts[index]);
        let word = if wait.is_some() { "after" } else { "timeout" };
        let docs = format!(" `{word}` of `{}`, {}.", graph.path(*node), self.line(graph.nodes[*node].span));
        Arm { number: index, docs, code: self.ops(view, &view.program.timeouts[index]) }
    }
}

/// Code for a silence at an input that has lasted too long, by its number and its condition.
fn silence_of_input(silence: &TokenStream, bit: &TokenStream) -> TokenStream {
    quote! {
        if quiet && self.core.silences[#silence].is_due(at) && !self.core.dispatcher.has(#bit) {
            self.core.dispatcher.raise(#bit);
            quiet = false;
        }
    }
}

/// Name of the function for a group of nodes that miss the same tokens.
fn patience_of(group: usize) -> Ident {
    format_ident!("patience_{group}")
}
