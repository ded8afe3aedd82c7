//! One cluster as straight-line code: blocks, firings, and how tokens get from one to the next.

use super::{
    Generator,
    activity::ProgramView,
    types::{ident, path},
};
use crate::{
    analyse::{Analysis, Block, ClusterId, Links, Step, handles_absence},
    catalog::{ArgSig, Signature},
    graph::{ConnectionId, Graph, Library, NodeId, NodeKind, PortId, Standard},
    syntax::tree::PortKind,
    program::{BlockId, Plan, Storage, Flag},
};
use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote, quote_spanned};
use syn::Ident;

/// Writes the code of one cluster.
pub struct Emitter<'a> {
    pub generator: &'a Generator<'a>,
    pub view: ProgramView<'a>,
    pub graph: &'a Graph,
    pub analysis: &'a Analysis,
    pub links: &'a Links,
    pub plan: Plan,
    pub cluster: ClusterId,
}

impl<'a> Emitter<'a> {
    /// An emitter for `cluster`.
    pub fn new(generator: &'a Generator<'a>, view: ProgramView<'a>, cluster: ClusterId) -> Self {
        let ProgramView { graph, analysis, links, .. } = view;
        let plan = Plan::new(graph, generator.catalog, links, analysis, cluster);
        Self { generator, view, graph, analysis, links, plan, cluster }
    }

    /// The cluster of a program: around what it does, events are emptied before and emitted when all is done.
    pub fn program_cluster(&self) -> TokenStream {
        let cluster = &self.analysis.clusters[self.cluster];
        let clear = cluster.nodes.iter().map(|node| self.generator.clear_events(self.view, *node));
        let code = self.cluster();
        let order = cluster.schedule();
        // A node that was skipped because of ⊥ took its tokens all the same (A1).
        let take = order.iter().map(|node| self.generator.take_activity(self.view, *node));
        let emit = order.iter().map(|node| self.generator.emit(self.view, *node, true));
        let stamp = self.generator.stamp_of_firing(self.view, self.cluster);
        quote! { #stamp #(#clear)* #code #(#take)* #(#emit)* }
    }

    /// Everything that the cluster does.
    pub fn cluster(&self) -> TokenStream {
        let cluster = &self.analysis.clusters[self.cluster];
        let read = cluster.nodes.iter().map(|node| self.read_first(*node));
        let block = self.block(&cluster.block, &mut 0);
        let left = cluster.nodes.iter().map(|node| self.leave(*node));
        quote! { #(#read)* #block #(#left)* }
    }

    /// Tokens that wait in the program are taken when the cluster starts.
    fn read_first(&self, node: NodeId) -> TokenStream {
        let sends = self.graph.nodes[node].ports.iter().position(|p| p.kind == PortKind::Output);
        let Some(end) = sends.map(|port| PortId { node, port }).filter(|_| !self.plan.is_multirate) else {
            return quote!();
        };
        let name = self.generator.name(end);
        match self.graph.nodes[node].kind {
            NodeKind::Delay(_) => {
                let held = self.generator.held(node);
                let pass = self.view.analysis.active.contains(&node).then(|| self.pass(node, BlockId::OUTERMOST));
                quote! { let #name = state.#held.take(); #pass }
            }
            NodeKind::Boundary(_) if !self.graph.is_body => {
                let port = ident(&self.graph.nodes[node].name);
                quote! { let #name = inputs.#port.take(); }
            }
            _ => quote!(),
        }
    }

    /// Tokens for other clusters are left in the program when the cluster ends.
    fn leave(&self, node: NodeId) -> TokenStream {
        let to_others = self.links.out_of[node]
            .iter()
            .map(|c| &self.graph.connections[*c])
            .filter(|c| self.analysis.cluster_of[c.to.node] != self.cluster)
            .map(|c| c.from);
        let asynchronous = self.links.sends[node].iter().map(|c| self.graph.connections[*c].from);
        let outputs = asynchronous.filter(|end| self.graph.port(*end).kind == PortKind::Output);
        let mut ends: Vec<PortId> = to_others.chain(outputs).collect();
        ends.sort_unstable();
        ends.dedup();
        let stores = ends.into_iter().filter(|end| self.plan.storage(*end) != Storage::Buffer).map(|end| {
            let name = self.generator.name(end);
            let token = match self.plan.storage(end) {
                // The only one of an iteration.
                Storage::Array => quote!(#name[0].as_ref()),
                _ => self.option(end, BlockId::OUTERMOST),
            };
            self.generator.store(self.graph, end, &quote!(state.#name), &token)
        });
        let hold = self.hold_iteration(node);
        quote! { #(#stores)* #hold }
    }

    fn block(&self, block: &Block, next: &mut usize) -> TokenStream {
        let id = BlockId::from(*next);
        *next += 1;
        let hoisted = self.plan.hoisted_to(id).into_iter().map(|end| {
            let name = self.generator.name(end);
            match self.plan.storage(end) {
                Storage::Buffer => quote! { state.#name.clear(); },
                Storage::Array => self.array(end),
                _ => quote! { let mut #name = None; },
            }
        });
        let hoisted: TokenStream = hoisted.collect();
        if self.plan.is_multirate {
            let iteration = self.iteration(block);
            return quote! { #hoisted #iteration };
        }
        let steps: TokenStream = block
            .steps
            .iter()
            .map(|step| match step {
                Step::Fire(node) => self.step(*node, id),
                Step::Block(inner) => {
                    let test = self.test(BlockId::from(*next));
                    let body = self.block(inner, next);
                    quote! { if let #test { #body } }
                }
                Step::Repeat(_) => quote!(),
            })
            .collect();
        quote! { #hoisted #steps }
    }

    /// `Some(a) = &a`, or the same of several tokens.
    fn test(&self, block: BlockId) -> TokenStream {
        let tests = &self.plan.tests[block];
        let names: Vec<_> = tests.iter().map(|end| self.generator.name(*end)).collect();
        // Inside, a name that is bound further out stands for the value itself.
        let tokens: Vec<_> = tests.iter().map(|end| self.stored(*end)).collect();
        match (names.as_slice(), tokens.as_slice()) {
            ([name], [token]) => quote!(Some(#name) = #token),
            _ => quote!((#(Some(#names)),*) = (#(#tokens),*)),
        }
    }

    /// A token that may be ⊥, where it is kept.
    fn stored(&self, end: PortId) -> TokenStream {
        let name = self.generator.name(end);
        match self.plan.storage(end) {
            Storage::Buffer => quote!(state.#name.get()),
            Storage::Outside => quote!(&state.#name),
            Storage::MaybeArgument => quote!(#name),
            _ => quote!(&#name),
        }
    }

    /// A token as `Option<&T>`.
    pub fn option(&self, end: PortId, block: BlockId) -> TokenStream {
        let name = self.generator.name(end);
        if self.plan.is_bound(end, block) || self.plan.storage(end) == Storage::Argument {
            return quote!(Some(#name));
        }
        match self.plan.storage(end) {
            Storage::Buffer => quote!(state.#name.get()),
            Storage::Outside => quote!(state.#name.as_ref()),
            Storage::MaybeArgument => quote!(#name),
            Storage::Array => {
                let place = self.place_in_array(end);
                quote!(#name[#place].as_ref())
            }
            _ if self.plan.is_plain(end) => quote!(Some(&#name)),
            _ => quote!(#name.as_ref()),
        }
    }

    /// The token that arrives at an input, as `Option<&T>`; `None` if nothing is connected.
    pub fn arriving(&self, to: PortId, block: BlockId) -> Option<TokenStream> {
        let from = self.incoming(to)?;
        Some(match self.plan.storage(from) {
            Storage::Array => self.arriving_in_iteration(to, from),
            _ => self.option(from, block),
        })
    }

    /// The token that has arrived at an input for certain, as `&T`.
    pub fn arrived(&self, to: PortId, block: BlockId) -> Option<TokenStream> {
        let from = self.incoming(to)?;
        match self.plan.is_multirate {
            true => Some(self.tested(to).into_token_stream()),
            false => Some(self.reference(from, block)),
        }
    }

    /// Name of a token whose presence the firing of its node tests.
    pub fn tested(&self, to: PortId) -> Ident {
        let node = &self.graph.nodes[to.node];
        // The names of further elements are no identifiers.
        match node.declared(to.port) == to.port {
            true => ident(&format!("token_{}", node.ports[to.port].name)),
            false => format_ident!("token_{}", to.port),
        }
    }

    /// The token that arrives at an input, as `Option<&T>`, with its origin.
    fn arrival(&self, to: PortId, block: BlockId) -> Option<(PortId, TokenStream)> {
        Some((self.incoming(to)?, self.arriving(to, block)?))
    }

    /// A copy of the token that arrives at an input, as `Option<T>`.
    pub fn copied(&self, to: PortId, block: BlockId) -> Option<TokenStream> {
        let (from, token) = self.arrival(to, block)?;
        Some(self.generator.cloned(self.graph, from, &token))
    }

    /// A token that is there, as `&T`.
    pub fn reference(&self, end: PortId, block: BlockId) -> TokenStream {
        let name = self.generator.name(end);
        if self.plan.is_bound(end, block) || self.plan.storage(end) == Storage::Argument {
            quote!(#name)
        } else {
            quote!(&#name)
        }
    }

    /// A node fires: its tokens' activity counts before, and its own goes with what it sends.
    pub fn step(&self, node: NodeId, block: BlockId) -> TokenStream {
        let (take, fire) = (self.generator.take_activity(self.view, node), self.fire(node, block));
        // A delay has sent its token before it takes one.
        let pass = (!self.graph.nodes[node].is_delay()).then(|| self.pass(node, block));
        let (heard, observed) = (self.heard(node, block), self.observed_outputs(node, block));
        quote! { #take #fire #heard #observed #pass }
    }

    /// A source whose silence is watched has sent something.
    fn heard(&self, node: NodeId, block: BlockId) -> TokenStream {
        let watch = self.generator.watch_silence(self.view, node);
        if watch.is_empty() {
            return watch;
        }
        let ports = (0..self.graph.nodes[node].ports.len()).map(|port| PortId { node, port });
        let sent = ports.filter_map(|end| match self.graph.port(end).kind {
            PortKind::Output if self.plan.is_used(end) => {
                let token = self.option(end, block);
                Some(quote!(#token.is_some()))
            }
            PortKind::Event if self.graph.port(end).standard.is_none() => self.generator.sent_event(self.view, end),
            _ => None,
        });
        quote! { if false #(|| #sent)* { #watch } }
    }

    fn pass(&self, node: NodeId, block: BlockId) -> TokenStream {
        self.generator.pass_activity(self.view, node, &|end| match self.graph.port(end).kind {
            PortKind::Output => {
                let token = self.option(end, block);
                Some(quote!(&#token.is_some()))
            }
            _ => self.generator.is_sent_event(self.view, end).then(|| self.generator.kept(end)),
        })
    }

    fn fire(&self, node: NodeId, block: BlockId) -> TokenStream {
        match &self.graph.nodes[node].kind {
            NodeKind::Library(library) => self.fire_library(node, library, block),
            NodeKind::Each(each) => {
                let (fire, late) = (self.fire_each(node, each, block), self.generator.check_late(self.graph, node));
                let copies = self.copies(node);
                quote! { #fire #copies #late }
            }
            NodeKind::Delay(_) => {
                let held = self.generator.held(node);
                let token = self.copied(PortId { node, port: 0 }, block).unwrap_or_else(|| quote!(None));
                let activity = self.generator.hold_activity(self.view, node);
                quote! { state.#held.put(#token); #activity }
            }
            NodeKind::Boundary(PortKind::Output) if !self.graph.is_body => {
                let port = ident(&self.graph.nodes[node].name);
                match self.arrival(PortId { node, port: 0 }, block) {
                    Some((from, token)) => self.generator.store(self.graph, from, &quote!(outputs.#port), &token),
                    None => quote!(),
                }
            }
            NodeKind::Relay => {
                let token = self.copied(PortId { node, port: 0 }, block);
                let out = PortId { node, port: 1 };
                // Nothing may ever come, which then says nothing of the type.
                let token = token.unwrap_or_else(|| {
                    let ty = self.generator.token_type(self.graph, out);
                    quote!(::core::option::Option::<#ty>::None)
                });
                self.bind(out, token, true)
            }
            NodeKind::Probe => match self.arrival(PortId { node, port: 0 }, block) {
                Some((from, token)) => self.generator.see(self.graph, node, from, &token),
                None => quote!(),
            },
            _ => quote!(),
        }
    }

    /// Origin of the tokens of an input.
    pub fn incoming(&self, to: PortId) -> Option<PortId> {
        self.connection(to).map(|c| self.graph.connections[c].from)
    }

    fn connection(&self, to: PortId) -> Option<ConnectionId> {
        self.links.inputs[to.node].iter().copied().find(|c| self.graph.connections[*c].to == to)
    }

    fn fire_library(&self, node: NodeId, library: &Library, block: BlockId) -> TokenStream {
        let signature = &self.generator.catalog.signatures[library.signature];
        let index = self.generator.index(node);
        let params = self.set_params(node, signature, block);
        // Tokens at its parameters are all that a node without `process` takes.
        let Some(args) = &signature.process else { return params };
        let told = handles_absence(self.graph, self.generator.catalog, node);
        let args: Vec<TokenStream> =
            args.iter().map(|arg| self.argument(node, library, signature, *arg, block, told)).collect();
        let call = if signature.is_function {
            let function = path(&signature.path);
            quote!(#function(#(#args),*))
        } else {
            let place = self.generator.node_place(self.graph, node);
            quote!(#place.process(#(#args),*))
        };
        let processed = self.generator.trigger(self.graph, node, Standard::Processed);
        let call = if processed.is_empty() { call } else { quote!({ #processed #call }) };
        let call = self.with_checked_params(node, library, signature, call, block);
        let call = if told { self.told(node, signature, call, block) } else { call };
        let results = self.results(node, library, signature, call, told);
        let copies = self.copies(node);
        let results = self.recorded(node, block, quote! { #results #copies }, processed);
        let outputs = self.param_outputs(node, library, signature, block);
        let late = self.generator.check_late(self.graph, node);
        let code = quote! { observer.fired(#index); #params #results #outputs #late observer.finished(#index); };
        if self.graph.nodes[node].can_be_disabled() {
            let is_enabled = self.generator.is_set(Flag::Enabled(node));
            let clears = self.buffers(node).into_iter().map(|name| quote! { state.#name.clear(); });
            quote! { if #is_enabled { #code } else { #(#clears)* } }
        } else {
            code
        }
    }

    fn argument(
        &self,
        node: NodeId,
        library: &Library,
        signature: &Signature,
        arg: ArgSig,
        block: BlockId,
        told: bool,
    ) -> TokenStream {
        match arg {
            ArgSig::Ctx => self.generator.context(self.view, node),
            ArgSig::Port(port) => {
                let (end, p) = (PortId { node, port }, &signature.ports[port]);
                match p.kind {
                    PortKind::Output => {
                        let name = self.generator.name(end);
                        quote!(state.#name.begin())
                    }
                    PortKind::Input if p.any_number => {
                        let elements = self.graph.nodes[node].elements(port);
                        let tokens = elements.map(|port| self.input(PortId { node, port }, p.optional, block, told));
                        quote!([#(#tokens),*])
                    }
                    PortKind::Input => self.input(end, p.optional, block, told),
                    PortKind::Event | PortKind::Slot => self.generator.event(self.view, end),
                }
            }
            ArgSig::Param(param) => match self.param_source(node, param) {
                Some(_) if signature.params[param].range.is_some() => {
                    let name = format_ident!("param_{param}");
                    quote!(#name)
                }
                Some(to) => self.clone_of_arrived(to, block),
                None => self.generator.argument(self.graph, node, library, param),
            },
        }
    }

    /// The token at an input, as the node takes it.
    fn input(&self, end: PortId, optional: bool, block: BlockId, told: bool) -> TokenStream {
        match optional {
            true => match self.arriving(end, block) {
                Some(token) => self.judged(end, token, true),
                None => quote!(None),
            },
            false => match self.arrived(end, block) {
                Some(_) if told => self.tested(end).into_token_stream(),
                Some(token) => self.judged(end, token, false),
                None => quote!(),
            },
        }
    }

    /// Lets rustc judge a connection whose types the scan could not compare.
    fn judged(&self, to: PortId, token: TokenStream, optional: bool) -> TokenStream {
        let Some(connection) = self.connection(to) else { return token };
        let Some(link) = self.generator.link(self.graph, connection) else { return token };
        let NodeKind::Library(library) = &self.graph.nodes[to.node].kind else { return token };
        let node = self.generator.node_type(self.graph, library);
        let declared = self.graph.nodes[to.node].declared(to.port);
        let index = self.generator.catalog.signatures[library.signature].ports[declared].index;
        let span = (self.generator.place)(self.graph.connections[connection].span);
        let wanted = quote!(<#node as ::apex_rt::Input<#index>>::Token);
        if optional {
            quote_spanned!(span=> #token.map(|token| #link::<#wanted>::pass(token)))
        } else {
            quote_spanned!(span=> #link::<#wanted>::pass(#token))
        }
    }

    /// The input of a parameter, if a token arrives at it.
    pub fn param_source(&self, node: NodeId, param: usize) -> Option<PortId> {
        let ports = &self.graph.nodes[node].ports;
        let port = ports.iter().position(|p| p.parameter == Some(param) && p.kind == PortKind::Input)?;
        let to = PortId { node, port };
        self.incoming(to).map(|_| to)
    }

    /// A copy of the token that has arrived at an input, as `T`.
    pub fn clone_of_arrived(&self, to: PortId, block: BlockId) -> TokenStream {
        match self.incoming(to).zip(self.arrived(to, block)) {
            Some((from, token)) => self.generator.clone(self.graph, from, &token),
            None => self.generator.bug(self.graph.nodes[to.node].span, "a parameter that waits for a token has none"),
        }
    }

    /// Tokens at parameter ports of a struct node are put into its fields first.
    fn set_params(&self, node: NodeId, signature: &Signature, block: BlockId) -> TokenStream {
        if signature.is_function {
            return quote!();
        }
        let (index, place) = (self.generator.index(node), self.generator.node_place(self.graph, node));
        let sets = (0..signature.params.len()).filter_map(|param| {
            let (token, name) = (self.arriving(self.param_source(node, param)?, block)?, &signature.params[param].name);
            Some(quote! { if let Some(value) = #token { ::apex_rt::set_param::<#param, _, _>(&mut #place, value, #index, #name, observer); } })
        });
        sets.collect()
    }

    /// A function is not called with a parameter that is out of range.
    fn with_checked_params(
        &self,
        node: NodeId,
        library: &Library,
        signature: &Signature,
        call: TokenStream,
        block: BlockId,
    ) -> TokenStream {
        if !signature.is_function {
            return call;
        }
        let index = self.generator.index(node);
        let checked: Vec<usize> = (0..signature.params.len())
            .filter(|p| signature.params[*p].range.is_some() && self.param_source(node, *p).is_some())
            .collect();
        checked.iter().rev().enumerate().fold(call, |call, (depth, param)| {
            let arrived = self.param_source(node, *param).and_then(|to| self.arrived(to, block));
            let Some(token) = arrived else { return call };
            let (name, node_type) = (&signature.params[*param].name, self.generator.node_type(self.graph, library));
            let local = format_ident!("param_{param}");
            let check = quote!(::apex_rt::checked_param::<#param, #node_type, _>(#token, #index, #name, observer));
            let flat = depth > 0 || signature.returns.maybe || signature.returns.fallible;
            if flat { quote!(#check.and_then(|#local| #call)) } else { quote!(#check.map(|#local| #call)) }
        })
    }

    /// A node that wants to be told of ⊥ is called in one way or the other.
    fn told(&self, node: NodeId, signature: &Signature, call: TokenStream, block: BlockId) -> TokenStream {
        let (names, tokens): (Vec<Ident>, Vec<TokenStream>) = signature
            .ports
            .iter()
            .enumerate()
            .filter(|(_, p)| p.kind == PortKind::Input && !p.optional)
            .flat_map(|(port, _)| self.graph.nodes[node].elements(port))
            .map(|port| PortId { node, port })
            .filter_map(|to| Some((self.tested(to), self.arriving(to, block)?)))
            .unzip();
        let place = self.generator.node_place(self.graph, node);
        let method = ident(signature.no_message.as_deref().unwrap_or_default());
        let clears = self.buffers(node).into_iter().map(|name| quote! { state.#name.clear(); });
        let value = if signature.returns.maybe || signature.returns.fallible || !signature.returns.value {
            call
        } else {
            quote!(Some(#call))
        };
        let missing = match (signature.returns.value, signature.returns.fallible) {
            (true, true) => quote!(Ok(None)),
            (true, false) => quote!(None),
            (false, true) => quote!(Ok(())),
            (false, false) => quote!(()),
        };
        let value = if signature.returns.fallible && signature.returns.value && !signature.returns.maybe {
            quote!(#value.map(Some))
        } else {
            value
        };
        quote! {
            match (#(#tokens,)*) {
                (#(Some(#names),)*) => #value,
                #[allow(unreachable_patterns)]
                _ => { #place.#method(); #(#clears)* #missing }
            }
        }
    }
}
