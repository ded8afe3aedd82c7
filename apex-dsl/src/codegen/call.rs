//! The call of a node of the catalog, with its arguments and its results.

use super::{
    emitter::Emitter,
    tokens::{ident, path, to_rust},
};
use crate::{
    catalog::Signature,
    graph::{Library, NodeId, PortId},
    program::{Arg, BlockId, Call, CallResult, Failing, Flag, Op, ParamOutput, Storage},
};
use proc_macro2::TokenStream;
use quote::{ToTokens as _, format_ident, quote};
use syn::Ident;

/// The call of a node in a cluster.
pub struct Calling<'a> {
    emitter: &'a Emitter<'a>,
    node: NodeId,
    library: &'a Library,
    signature: &'a Signature,
    call: &'a Call,
    block: BlockId,
}

impl<'a> Calling<'a> {
    /// The call of `node`.
    pub fn new(emitter: &'a Emitter<'a>, node: NodeId, library: &'a Library, call: &'a Call, block: BlockId) -> Self {
        let signature = &emitter.generator.catalog.signatures[library.signature];
        Self { emitter, node, library, signature, call, block }
    }

    /// The code of a firing.
    pub fn code(&self) -> TokenStream {
        let (generator, view) = (self.emitter.generator, self.emitter.view);
        let params = self.set_params();
        // Tokens at its parameters are all that a node without `process` takes.
        let Some(args) = &self.call.args else { return params };
        let index = generator.index(self.node);
        let args = args.iter().map(|arg| self.argument(arg));
        let call = if self.signature.is_function {
            let function = path(&self.signature.path);
            quote!(#function(#(#args),*))
        } else {
            let place = self.place();
            quote!(#place.process(#(#args),*))
        };
        let processed: Vec<Op> = self.call.processed.into_iter().map(Op::Trigger).collect();
        let processed = generator.ops(view, &processed);
        let call = if processed.is_empty() { call } else { quote!({ #processed #call }) };
        let call = self.with_checked_params(call);
        let call = if self.call.mandatory.is_some() { self.with_absence_handler(call) } else { call };
        let results = self.results(call);
        let copies = self.emitter.copies(self.node);
        let results = self.emitter.recorded(self.node, self.block, quote! { #results #copies }, processed);
        let outputs = self.param_outputs();
        let late = generator.late(view, self.node, self.call.deadline);
        let code = quote! { observer.fired(#index); #params #results #outputs #late observer.finished(#index); };
        if !self.call.is_gated {
            return code;
        }
        let (is_enabled, clears) = (generator.is_set(Flag::Enabled(self.node)), self.clear_buffers());
        quote! { if #is_enabled { #code } else { #clears } }
    }

    /// Place of the node.
    fn place(&self) -> TokenStream {
        self.emitter.generator.node_place(self.emitter.graph, self.node)
    }

    /// The outputs that the node writes in place are ⊥.
    fn clear_buffers(&self) -> TokenStream {
        let names = self.call.buffers.iter().map(|end| self.emitter.generator.name(*end));
        quote! { #(state.#names.clear();)* }
    }

    fn argument(&self, arg: &Arg) -> TokenStream {
        let (emitter, generator) = (self.emitter, self.emitter.generator);
        match arg {
            Arg::Context => generator.context(emitter.view, self.node),
            Arg::Buffer(end) => {
                let name = generator.name(*end);
                quote!(state.#name.begin())
            }
            Arg::Token { input, optional } => self.input(*input, *optional),
            Arg::Tokens { inputs, optional } => {
                let tokens = inputs.iter().map(|input| self.input(*input, *optional));
                quote!([#(#tokens),*])
            }
            Arg::Event { event, sent } => generator.event(*event, *sent),
            Arg::Param(param) => generator.argument(emitter.graph, self.node, self.library, *param),
            Arg::Arrived { input, .. } => emitter.clone_of_arrived(*input, self.block),
            Arg::Checked(param) => format_ident!("param_{param}").into_token_stream(),
            Arg::OfSlot => generator.bug(emitter.graph.nodes[self.node].span, "a firing has no token of a slot"),
        }
    }

    /// The token at an input, as the node takes it.
    fn input(&self, end: PortId, optional: bool) -> TokenStream {
        let emitter = self.emitter;
        match optional {
            true => match emitter.arriving(end, self.block) {
                Some(token) => emitter.judged(end, token, true),
                None => quote!(None),
            },
            false => match emitter.arrived(end, self.block) {
                Some(_) if self.call.mandatory.is_some() => emitter.tested(end).into_token_stream(),
                Some(token) => emitter.judged(end, token, false),
                None => quote!(),
            },
        }
    }

    /// Tokens at parameter ports of a struct node are put into its fields first.
    fn set_params(&self) -> TokenStream {
        let (index, place) = (self.emitter.generator.index(self.node), self.place());
        let sets = self.call.sets.iter().filter_map(|(param, input)| {
            let (token, name) = (self.emitter.arriving(*input, self.block)?, &self.signature.params[*param].name);
            Some(quote! { if let Some(value) = #token { ::apex_rt::set_param::<#param, _, _>(&mut #place, value, #index, #name, observer); } })
        });
        sets.collect()
    }

    /// A function is not called with a parameter that is out of range.
    fn with_checked_params(&self, call: TokenStream) -> TokenStream {
        let (generator, returns) = (self.emitter.generator, self.signature.returns);
        let index = generator.index(self.node);
        self.call.checks.iter().rev().enumerate().fold(call, |call, (depth, (param, input))| {
            let Some(token) = self.emitter.arrived(*input, self.block) else { return call };
            let name = &self.signature.params[*param].name;
            let node_type = generator.node_type(self.emitter.graph, self.library);
            let local = format_ident!("param_{param}");
            let check = quote!(::apex_rt::checked_param::<#param, #node_type, _>(#token, #index, #name, observer));
            let flat = depth > 0 || returns.maybe || returns.fallible;
            if flat { quote!(#check.and_then(|#local| #call)) } else { quote!(#check.map(|#local| #call)) }
        })
    }

    /// Calls `process`, or the method for ⊥ if a mandatory token is missing.
    fn with_absence_handler(&self, call: TokenStream) -> TokenStream {
        let (emitter, returns) = (self.emitter, self.signature.returns);
        let inputs = self.call.mandatory.iter().flatten();
        let (names, tokens): (Vec<Ident>, Vec<TokenStream>) =
            inputs.filter_map(|to| Some((emitter.tested(*to), emitter.arriving(*to, self.block)?))).unzip();
        let (place, clears) = (self.place(), self.clear_buffers());
        let Some(method) = &self.signature.no_message else {
            return emitter.generator.bug(emitter.graph.nodes[self.node].span, "a node has no method for ⊥");
        };
        let method = ident(method);
        let value = if returns.maybe || returns.fallible || !returns.value { call } else { quote!(Some(#call)) };
        let missing = match (returns.value, returns.fallible) {
            (true, true) => quote!(Ok(None)),
            (true, false) => quote!(None),
            (false, true) => quote!(Ok(())),
            (false, false) => quote!(()),
        };
        let value = if returns.fallible && returns.value && !returns.maybe { quote!(#value.map(Some)) } else { value };
        quote! {
            match (#(#tokens,)*) {
                (#(Some(#names),)*) => #value,
                #[allow(unreachable_patterns)]
                _ => { #place.#method(); #clears #missing }
            }
        }
    }

    /// The call as a statement that gives names to what it returns.
    fn results(&self, call: TokenStream) -> TokenStream {
        let returns = self.signature.returns;
        let failing = !matches!(self.call.failing, Failing::Never);
        let nested = returns.maybe || self.call.mandatory.is_some() || !self.call.checks.is_empty();
        let (mut value, mut before) = (call, quote!());
        if failing {
            value = self.emitter.generator.contained(self.emitter.view, self.node, self.call.failing, value);
            let clears = self.clear_buffers();
            if !clears.is_empty() {
                before = quote! { let sent = #value; if sent.is_none() { #clears } };
                value = quote!(sent);
            }
            if returns.value && nested {
                value = quote!(#value.flatten());
            }
        }
        let optional = nested || failing;
        let results = match self.call.results.as_slice() {
            // A call that returns nothing needs no name for it.
            [] if !returns.value && !failing && self.call.mandatory.is_none() => quote! { #value; },
            [] if before.is_empty() => quote! { let _ = #value; },
            [] => quote!(),
            [first, ..] if !returns.several => self.emitter.bind(first.output, value, optional),
            several => self.bind_fields(several, value, optional),
        };
        quote! { #before #results }
    }

    fn bind_fields(&self, results: &[CallResult], value: TokenStream, optional: bool) -> TokenStream {
        let fields = results.iter().map(|CallResult { output, field, is_optional }| {
            let (field, is_option) = match field {
                Some((name, is_option)) => (ident(name), *is_option),
                None => (self.emitter.generator.nameless("the field of an output"), false),
            };
            let value = match (optional, is_option) {
                (false, _) => quote!(results.#field),
                // `Option<Struct>`: taken apart by reference to its place, so that every field can be moved out.
                (true, true) => quote!(results.as_mut().and_then(|results| results.#field.take())),
                (true, false) => quote!(results.as_ref().map(|results| ::core::clone::Clone::clone(&results.#field))),
            };
            self.emitter.bind(*output, value, optional || *is_optional)
        });
        let fields: TokenStream = fields.collect();
        let mutable = if optional { quote!(mut) } else { quote!() };
        quote! { #[allow(unused_mut)] let #mutable results = #value; #fields }
    }

    /// Connected outputs of parameters: the value of this firing.
    fn param_outputs(&self) -> TokenStream {
        let emitter = self.emitter;
        let binds = self.call.param_outputs.iter().map(|ParamOutput { param, arrived, output }| {
            let value = self.param(*param, *arrived);
            let maybe = emitter.plan.storage(*output) == Storage::Maybe;
            let value = if maybe { quote!(Some(#value)) } else { value };
            emitter.bind(*output, value, maybe)
        });
        binds.collect()
    }

    /// The value of a parameter in this firing.
    fn param(&self, param: usize, arrived: Option<PortId>) -> TokenStream {
        let (emitter, generator) = (self.emitter, self.emitter.generator);
        if !self.signature.is_function {
            let place = self.place();
            return quote!(::core::clone::Clone::clone(::apex_rt::ParamField::<#param>::field(&mut #place)));
        }
        match arrived {
            Some(to) => emitter.clone_of_arrived(to, self.block),
            None => {
                let ty = to_rust(&self.signature.params[param].ty, generator.catalog);
                let constant = generator.param_value(emitter.graph, self.library, param);
                ty.map_or(quote!(#constant), |ty| quote!({ let value: #ty = #constant; value }))
            }
        }
    }
}
