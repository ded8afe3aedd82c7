//! One cluster as straight-line code: blocks, firings, and how tokens get from one to the next.

use super::{
    call::Calling,
    emitter::{Emitter, Writer},
    tokens::ident,
};
use crate::{
    graph::{NodeId, NodeKind, PortId},
    program::{BlockId, Fire, Op, Storage},
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote, quote_spanned};
use syn::Ident;

impl<'a> Emitter<'a> {
    /// Operations in a block.
    fn ops_in(&self, ops: &[Op], block: BlockId) -> TokenStream {
        Writer { generator: self.generator, view: self.view, inside: Some((self, block)) }.ops(ops)
    }

    /// Code of the cluster.
    pub fn code(&self) -> TokenStream {
        self.ops_in(&self.view.program.clusters[self.cluster], BlockId::OUTERMOST)
    }

    /// An operation that belongs to a cluster.
    pub fn op(&self, op: &Op, block: BlockId) -> TokenStream {
        match op {
            Op::Take(end) => self.take(*end),
            Op::TakeDelayed(node) => self.take_delayed(*node),
            Op::Declare(end) => self.declare(*end),
            Op::Block { block, tokens, body } => {
                let (test, body) = (self.test(tokens), self.ops_in(body, *block));
                quote! { if let #test { #body } }
            }
            Op::Iteration { runs, firings } => {
                let firings = firings.iter().map(|(node, ops)| (*node, self.ops_in(ops, block))).collect();
                self.iteration(runs, &firings)
            }
            Op::IfArrived { inputs, body } => {
                let names = inputs.iter().map(|to| self.tested(*to));
                let (tokens, body) = (inputs.iter().map(|to| self.arriving(*to, block)), self.ops_in(body, block));
                quote! { if let (#(Some(#names),)*) = (#(#tokens,)*) { #body } }
            }
            Op::Fire { node, fire } => self.fire(*node, fire, block),
            Op::IfSent { tokens, then } => {
                let sent = tokens.iter().map(|end| match self.graph.port(*end).kind {
                    PortKind::Output => {
                        let token = self.option(*end, block);
                        quote!(#token.is_some())
                    }
                    _ => self.generator.waits(self.graph, *end),
                });
                let then = self.ops_in(then, block);
                quote! { if false #(|| #sent)* { #then } }
            }
            Op::Observe(end) => self.observed(*end, block),
            Op::Store(end) => self.store(*end),
            Op::HoldIteration(node) => self.hold_iteration(*node),
            _ => self.generator.bug(self.graph.span, "an operation has no code"),
        }
    }

    /// Takes the token that waits in a delay or at an input of the program.
    fn take(&self, end: PortId) -> TokenStream {
        let (name, node) = (self.generator.name(end), end.node);
        match self.graph.nodes[node].kind {
            NodeKind::Delay(_) => {
                let held = self.generator.held(node);
                quote! { let #name = state.#held.take(); }
            }
            _ => {
                let port = ident(&self.graph.nodes[node].name);
                match self.plan.is_multirate {
                    true => quote! { #name[i] = inputs.#port.take(); },
                    false => quote! { let #name = inputs.#port.take(); },
                }
            }
        }
    }

    /// Declares a token before the blocks that use it.
    fn declare(&self, end: PortId) -> TokenStream {
        let name = self.generator.name(end);
        match self.plan.storage(end) {
            Storage::Buffer => quote! { state.#name.clear(); },
            Storage::Array => self.array(end),
            _ => quote! { let mut #name = None; },
        }
    }

    /// Leaves a token in the program for other clusters.
    fn store(&self, end: PortId) -> TokenStream {
        let name = self.generator.name(end);
        let token = match self.plan.storage(end) {
            // The only one of an iteration.
            Storage::Array => quote!(#name[0].as_ref()),
            _ => self.option(end, BlockId::OUTERMOST),
        };
        self.generator.store(self.graph, end, &quote!(state.#name), &token)
    }

    /// `Some(a) = &a`, or the same of several tokens.
    fn test(&self, tests: &[PortId]) -> TokenStream {
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

    fn fire(&self, node: NodeId, fire: &Fire, block: BlockId) -> TokenStream {
        let input = PortId { node, port: 0 };
        match (fire, &self.graph.nodes[node].kind) {
            (Fire::Call(call), NodeKind::Library(library)) => Calling::new(self, node, library, call, block).code(),
            (Fire::Each(deadline), NodeKind::Each(each)) => {
                let (fire, late) = (self.fire_each(node, each, block), self.generator.late(self.view, node, *deadline));
                let copies = self.copies(node);
                quote! { #fire #copies #late }
            }
            (Fire::Hold, _) => {
                let held = self.generator.held(node);
                let token = self.copied(input, block).unwrap_or_else(|| quote!(None));
                quote! { state.#held.put(#token); }
            }
            (Fire::Output, _) => {
                let port = ident(&self.graph.nodes[node].name);
                match self.arrival(input, block) {
                    Some((from, token)) => self.generator.store(self.graph, from, &quote!(outputs.#port), &token),
                    None => quote!(),
                }
            }
            (Fire::Relay, _) => {
                let token = self.copied(input, block);
                let out = PortId { node, port: 1 };
                // Nothing may ever come, which then says nothing of the type.
                let token = token.unwrap_or_else(|| {
                    let ty = self.generator.token_type(self.graph, out);
                    quote!(::core::option::Option::<#ty>::None)
                });
                self.bind(out, token, true)
            }
            (Fire::See, _) => match self.arrival(input, block) {
                Some((from, token)) => self.generator.see(self.graph, node, from, &token),
                None => quote!(),
            },
            (Fire::Nothing, _) => quote!(),
            (Fire::Call(_) | Fire::Each(_), _) => {
                self.generator.bug(self.graph.nodes[node].span, "a node fires as one of another kind")
            }
        }
    }

    /// Origin of the tokens of an input.
    pub fn incoming(&self, to: PortId) -> Option<PortId> {
        self.view.program.lower.incoming(to)
    }

    /// Lets rustc judge a connection whose types the scan could not compare.
    pub fn judged(&self, to: PortId, token: TokenStream, optional: bool) -> TokenStream {
        let Some(connection) = self.view.program.lower.connection(to) else { return token };
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

    /// A copy of the token that has arrived at an input, as `T`.
    pub fn clone_of_arrived(&self, to: PortId, block: BlockId) -> TokenStream {
        match self.incoming(to).zip(self.arrived(to, block)) {
            Some((from, token)) => self.generator.clone(self.graph, from, &token),
            None => self.generator.bug(self.graph.nodes[to.node].span, "a parameter that waits for a token has none"),
        }
    }
}
