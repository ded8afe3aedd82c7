//! Recording and replay: where the code of a program lets tokens out to be recorded, or takes recorded ones in. Only
//! programs that can be recorded have it (`apex_rt::record`).

use super::{channels::Role, emitter::Emitter, generator::Generator, tokens::ident};
use crate::{
    graph::{Graph, NodeId, PortId},
    program::{BlockId, Storage, is_buffer},
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::Ident;

impl Generator<'_> {
    /// The channel of a port, and its role.
    fn channel(&self, end: PortId) -> Option<(usize, Role)> {
        let end = match self.part {
            Some((_, part)) => part.node(end)?,
            None => end,
        };
        let channels = self.channels?;
        let number = *channels.numbers.get(&end)?;
        Some((number, channels.rows[number].1))
    }

    /// Codec of the tokens of a port.
    fn codec(&self, graph: &Graph, end: PortId) -> TokenStream {
        let function = self.codec_function(graph, end);
        quote!(#function())
    }

    /// The function that returns the codec of the tokens of a port.
    fn codec_function(&self, graph: &Graph, end: PortId) -> Option<Ident> {
        let number = self.channels?.type_number(self.token_type(graph, end));
        Some(format_ident!("codec_{number}"))
    }

    /// The table of channels, and the file of the `record` statement.
    pub fn recording(&self, graph: &Graph) -> TokenStream {
        let Some(channels) = self.channels else { return quote!() };
        let rows = channels.rows.iter().map(|(end, role)| {
            let (name, node) = (graph.end_name(*end), self.index(end.node));
            let (group, role) = (channels.group(graph, end.node), ident(&format!("{role:?}")));
            let format = format_ident!("format_{}", channels.type_number(self.token_type(graph, *end)));
            quote!(::apex_rt::record::Channel::new(#name, #node, #group, ::apex_rt::record::Role::#role, #format()))
        });
        let file = graph.record.as_ref().map(|record| {
            // The runtime has one text for both: each option is in a line after the file.
            let limit = record.limit.map(|bytes| format!("\nlimit {bytes}")).unwrap_or_default();
            let age = record.age.map(|age| format!("\nage {}", age.as_nanos())).unwrap_or_default();
            let compress = if record.compress { "\ncompress" } else { "" };
            let file = format!("{}{limit}{age}{compress}", record.file);
            quote! { const RECORD: ::core::option::Option<&'static str> = Some(#file); }
        });
        quote! {
            #file
            fn channels() -> ::apex_rt::record::Channels { ::apex_rt::record::Channels::from([#(#rows),*]) }
        }
    }

    /// `react_with` of a program, or of a thread group that runs beside others. If the program can be recorded, the
    /// changes from outside since the last reaction are recorded around `react`: parameters and, in the main group,
    /// which has the mailboxes at `ports`, tokens.
    pub fn recorded_react(&self, graph: &Graph, ports: Option<&TokenStream>, react: &TokenStream) -> TokenStream {
        let (before, after) = ports.map(|ports| self.mailboxes(graph, ports)).unwrap_or_default();
        let body = match self.channels {
            None => quote!(#react),
            Some(_) => quote! {
                let ends_early = observer.ends_early();
                if let Some(tap) = ::apex_rt::Observer::tap(observer) {
                    tap.begin(now, ends_early);
                    tap.set_params(self);
                    #before
                }
                let next = #react;
                if let Some(tap) = ::apex_rt::Observer::tap(observer) { tap.keep_params(self); #after tap.end(); }
                next
            },
        };
        quote! {
            fn react_with<O: ::apex_rt::Observer>(&mut self, now: ::apex_rt::Time, observer: &mut O) -> ::apex_rt::Next {
                #body
            }
        }
    }

    /// Contents of the mailboxes before a reaction and after it.
    fn mailboxes(&self, graph: &Graph, ports: &TokenStream) -> (TokenStream, TokenStream) {
        let (mut before, mut after, mut puts) = (quote!(), quote!(), vec![]);
        for (number, (end, role)) in self.channels.iter().flat_map(|channels| channels.rows.iter().enumerate()) {
            let name = ident(&graph.nodes[end.node].name);
            match role {
                Role::Mailbox => {
                    let codec = self.codec(graph, *end);
                    let arrival = quote!(#ports.inputs.#name.arrival());
                    puts.push((number, arrival, quote! { tap.put_in(#number, #codec, &mut #ports.inputs.#name); }));
                    after.extend(quote! { tap.keep_mailbox(#number, #ports.inputs.#name.is_full()); });
                }
                Role::Event => {
                    before.extend(quote! { tap.taken_out(#number, &mut #ports.events.#name); });
                    after.extend(quote! { tap.keep_mailbox(#number, #ports.events.#name.is_full()); });
                }
                Role::Source | Role::Chosen | Role::Port => {}
            }
        }
        let puts = in_order(&puts);
        (quote! { #puts #before }, after)
    }

    /// A look at a cell between two thread groups: what it finds is recorded, or comes from the recording.
    pub fn look(&self, finds: TokenStream) -> TokenStream {
        match self.channels {
            Some(_) => quote!(::apex_rt::record::looked(observer, || #finds)),
            None => finds,
        }
    }

    /// The number of a source's port, of those that are recorded.
    fn sources(&self, graph: &Graph, node: NodeId) -> Vec<(PortId, usize)> {
        let ends = (0..graph.nodes[node].ports.len()).map(|port| PortId { node, port });
        let number = |end: PortId| self.channel(end).filter(|(_, role)| *role == Role::Source);
        ends.filter_map(|end| Some((end, number(end)?.0))).collect()
    }

    /// A call of a slot: a source that is recorded is not called again, its events come from the recording.
    pub fn recorded_slot(&self, graph: &Graph, node: NodeId, call: TokenStream) -> TokenStream {
        let ports = self.sources(graph, node);
        if ports.is_empty() {
            return call;
        }
        let events = ports.iter().filter(|(end, _)| graph.port(*end).kind == PortKind::Event);
        let (takes, sends) = events.map(|(end, number)| self.recorded_event(graph, *end, *number)).unzip();
        self.taken_or_called(node, &takes, &call, &sends)
    }

    /// The token of an event of a source, from the recording and to it.
    fn recorded_event(&self, graph: &Graph, end: PortId, number: usize) -> (TokenStream, TokenStream) {
        let (name, codec) = (self.name(end), self.codec(graph, end));
        (
            quote! { state.#name = tap.take(#number, #codec); },
            quote! { tap.source_sent(#number, #codec, state.#name.as_ref()); },
        )
    }

    /// Takes the tokens of a source from the recording, or calls it and records what it sends.
    fn taken_or_called(
        &self,
        node: NodeId,
        takes: &TokenStream,
        call: &TokenStream,
        sends: &TokenStream,
    ) -> TokenStream {
        let index = self.index(node);
        quote! {
            match ::apex_rt::Observer::tap(observer).map(|tap| (tap.calls(#index), tap)) {
                Some((true, tap)) => { #takes }
                _ => {
                    #call
                    if let Some(tap) = ::apex_rt::Observer::tap(observer) { #sends }
                }
            }
        }
    }

    /// Tokens that a source in a region with several rates sends in its firing number `i`, in arrays. `results` calls
    /// it; `processed` is what is triggered before.
    fn recorded_at_rate(
        &self,
        graph: &Graph,
        node: NodeId,
        ports: &[(PortId, usize)],
        results: &TokenStream,
        processed: &TokenStream,
    ) -> TokenStream {
        let parts = ports.iter().map(|(end, number)| {
            let (codec, name, rate) = (self.codec(graph, *end), self.name(*end), graph.port(*end).rate);
            if graph.port(*end).kind == PortKind::Event {
                return self.recorded_event(graph, *end, *number);
            }
            let places = quote!(#name[i * #rate..(i + 1) * #rate]);
            (
                quote! { for place in &mut #places { *place = tap.take(#number, #codec); } },
                quote! { for place in &#places { tap.source_sent(#number, #codec, place.as_ref()); } },
            )
        });
        let (takes, sends): (TokenStream, TokenStream) = parts.unzip();
        self.taken_or_called(node, &quote!(#processed #takes), results, &sends)
    }

    /// Shows the observer a token of a port.
    fn observe(&self, graph: &Graph, end: PortId, token: &TokenStream) -> Option<TokenStream> {
        let (number, codec) = (self.channel(end)?.0, self.codec_function(graph, end)?);
        Some(quote! { ::apex_rt::record::sent(observer, #number, #codec, #token); })
    }

    /// Shows the observer the token of an event when it is sent.
    pub fn observed_event(&self, graph: &Graph, end: PortId) -> Option<TokenStream> {
        if graph.port(end).kind != PortKind::Event {
            return None;
        }
        let name = self.name(end);
        self.observe(graph, end, &quote!(state.#name.as_ref()))
    }
}

/// Code for the tokens of several mailboxes, each with its channel and the number of its token, in the order in which
/// they came.
fn in_order(mailboxes: &[(usize, TokenStream, TokenStream)]) -> TokenStream {
    let channels = mailboxes.iter().map(|(channel, ..)| channel);
    let arrivals = mailboxes.iter().map(|(_, arrival, _)| arrival);
    let arms = mailboxes.iter().enumerate().map(|(place, (.., put))| quote!(#place => { #put }));
    match mailboxes {
        [] => quote!(),
        [(_, _, put)] => put.clone(),
        _ => quote! {
            let mut arrivals = [#(#arrivals),*];
            while let Some(place) = tap.next_in(&[#(#channels),*], &mut arrivals) {
                match place { #(#arms)* _ => {} }
            }
        },
    }
}

impl Emitter<'_> {
    /// Shows the observer the token at an output.
    pub fn observed(&self, end: PortId, block: BlockId) -> TokenStream {
        if self.plan.storage(end) != Storage::Array {
            return self.generator.observe(self.graph, end, &self.option(end, block)).unwrap_or_default();
        }
        let observe = self.generator.observe(self.graph, end, &quote!(place.as_ref()));
        let (name, rate) = (self.generator.name(end), self.graph.port(end).rate);
        observe
            .map(|observe| quote! { for place in &#name[i * #rate..(i + 1) * #rate] { #observe } })
            .unwrap_or_default()
    }

    /// Tokens that a node sends. A replayed source is not called. `results` calls the node and binds its results to
    /// names returns; `processed` is what is triggered before.
    pub fn recorded(&self, node: NodeId, block: BlockId, results: TokenStream, processed: TokenStream) -> TokenStream {
        let ports = self.generator.sources(self.graph, node);
        if ports.is_empty() {
            return results;
        }
        if self.plan.is_multirate {
            return self.generator.recorded_at_rate(self.graph, node, &ports, &results, &processed);
        }
        let index = self.generator.index(node);
        let mut code = Recorded::default();
        for (end, number) in ports {
            self.recorded_port(end, number, block, &mut code);
        }
        let Recorded { takes, patterns, named, set, sends } = code;
        quote! {
            let recorded = match ::apex_rt::Observer::tap(observer) {
                Some(tap) => if tap.calls(#index) { Some((#(#takes,)*)) } else { None },
                None => None,
            };
            let (#(#named,)*) = match recorded {
                Some((#(#patterns,)*)) => { #processed #(#set)* (#(#named,)*) }
                _ => {
                    #results
                    if let Some(tap) = ::apex_rt::Observer::tap(observer) { #(#sends)* }
                    (#(#named,)*)
                }
            };
        }
    }

    fn recorded_port(&self, end: PortId, number: usize, block: BlockId, code: &mut Recorded) {
        let (graph, generator) = (self.graph, self.generator);
        let (name, codec) = (generator.name(end), generator.codec(graph, end));
        let is_event = graph.port(end).kind == PortKind::Event;
        let token = if is_event { quote!(state.#name.as_ref()) } else { self.option(end, block) };
        code.sends.push(quote! { tap.source_sent(#number, #codec, #token); });
        let local = format_ident!("recorded_{number}");
        let always = !is_event && self.plan.storage(end) == Storage::Local;
        code.takes.push(match always {
            true => quote!(tap.take_or_last(#number, #codec)),
            false => quote!(tap.take(#number, #codec)),
        });
        code.patterns.push(if always { quote!(Some(#local)) } else { quote!(#local) });
        if is_event {
            code.set.push(quote! { state.#name = #local; });
        } else if is_buffer(graph, generator.catalog, end) {
            code.set.push(quote! { state.#name.begin(); if let Some(token) = #local { state.#name.set(token); } });
        } else if !self.plan.is_hoisted(end) {
            code.set.push(quote! { let #name = #local; });
            code.named.push(name);
        } else {
            let token = if always { quote!(Some(#local)) } else { quote!(#local) };
            code.set.push(quote! { #name = #token; });
        }
    }
}

/// The parts of the code of a source that is recorded.
#[derive(Default)]
struct Recorded {
    /// Each token from the recording.
    takes: Vec<TokenStream>,
    /// The names of these, where all are there that have to be.
    patterns: Vec<TokenStream>,
    /// Puts tokens where they are kept.
    set: Vec<TokenStream>,
    /// The names that are left: locals.
    named: Vec<syn::Ident>,
    /// Each token to the recording.
    sends: Vec<TokenStream>,
}
