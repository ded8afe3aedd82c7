//! The adapter of a node of the catalog: `apex_interpret::Node` for its type, with the types of the tokens that come.

use super::types::{constant_type, token_type};
use crate::{
    catalog::{ArgSig, Signature, SlotSig},
    codegen::{
        generator::Generator,
        tokens::{ident, path},
    },
    graph::{Graph, NodeId, PortId},
    syntax::tree::PortKind,
};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::{BTreeMap, BTreeSet};
use syn::Ident;

/// The adapter of a node.
pub struct Adapter<'a, 'g> {
    generator: &'a Generator<'g>,
    graph: &'a Graph,
    node: NodeId,
    signature: &'a Signature,
    node_type: TokenStream,
    /// Parameters that a port reads or sets.
    with_ports: BTreeSet<usize>,
}

impl<'a, 'g> Adapter<'a, 'g> {
    pub fn new(
        generator: &'a Generator<'g>,
        graph: &'a Graph,
        node: NodeId,
        signature: &'a Signature,
        node_type: TokenStream,
    ) -> Self {
        let with_ports = graph.nodes[node].ports.iter().filter_map(|port| port.parameter).collect();
        Self { generator, graph, node, signature, node_type, with_ports }
    }

    /// The piece: a function that makes the node of the values of its parameters.
    pub fn piece(&self) -> Result<TokenStream, String> {
        let Self { node_type, signature, .. } = self;
        let (field, make) = if signature.is_function {
            (quote!(params: Vec<Value>), quote!(params))
        } else {
            let params = (0..signature.params.len()).map(|param| {
                let ty = self.param_type(param);
                quote!(owned::<#ty>(params)?)
            });
            let make = quote!(<#node_type as ::apex_rt::Construct<_>>::construct((#(#params,)*)));
            (quote!(node: #node_type), quote!(node: #make))
        };
        let buffers: Vec<(Ident, usize)> = self.in_place().map(|port| (buffer(port), port)).collect();
        let mut places = vec![];
        for (name, port) in &buffers {
            let ty = self.token_type(PortId { node: self.node, port: *port })?;
            let rate = signature.ports[*port].rate;
            let ty = if rate > 1 { quote!([#ty; #rate]) } else { ty };
            places.push(quote!(#name: ::apex_rt::Out<#ty>));
        }
        let names = buffers.iter().map(|(name, _)| name);
        let begin = (!signature.is_function).then(|| quote!(let params = &mut params.into_iter();));
        let (process, slots, hooks, params) = (self.process()?, self.slots()?, self.hooks(), self.params());
        Ok(quote!(Piece::Node(|params| {
            struct Boxed { #field, #(#places),* }
            impl Node for Boxed { #process #slots #hooks #params }
            #begin
            Some(Box::new(Boxed { #make, #(#names: ::apex_rt::Out::new()),* }))
        })))
    }

    fn param_type(&self, param: usize) -> TokenStream {
        let node_type = &self.node_type;
        quote!(<#node_type as ::apex_rt::Param<#param>>::Value)
    }

    fn token_type(&self, end: PortId) -> Result<TokenStream, String> {
        token_type(self.generator, self.graph, end)
    }

    /// The outputs that the node writes in place.
    fn in_place(&self) -> impl Iterator<Item = usize> {
        (0..self.signature.ports.len()).filter(|port| self.signature.writes_in_place(*port))
    }

    fn process(&self) -> Result<TokenStream, String> {
        let signature = self.signature;
        let Some(args) = &signature.process else {
            return Ok(quote! { fn process(&mut self, _: &Args) -> Outcome { Ok(vec![]) } });
        };
        let mut call = CallCode::default();
        for arg in args {
            let arg = match *arg {
                ArgSig::Ctx => quote!(&args.ctx),
                ArgSig::Param(param) => {
                    let ty = self.param_type(param);
                    quote!(param::<#ty>(&self.params, &args.params, #param)?)
                }
                ArgSig::Port(port) => match signature.ports[port].kind {
                    PortKind::Output => {
                        let buffer = buffer(port);
                        quote!(self.#buffer.begin())
                    }
                    PortKind::Input => self.input(port, &mut call)?,
                    PortKind::Event | PortKind::Slot => call.event(port),
                },
            };
            call.args.push(arg);
        }
        let CallCode { before, args, .. } = call;
        let called = if signature.is_function {
            let function = path(&signature.path);
            quote!(#function(#(#args),*))
        } else {
            quote!(self.node.process(#(#args),*))
        };
        let fails = signature
            .returns
            .fallible
            .then(|| quote!(let result = result.map_err(|error| ::apex_rt::Failure::new(&error))?;));
        let (returned, sent) = (self.returned()?, self.sent());
        let written = self.in_place().map(|port| {
            let (buffer, value) = (buffer(port), self.value(port, &quote!(token)));
            quote! { sent.push((#port, self.#buffer.get().cloned().map(|token| #value))); }
        });
        Ok(quote! {
            #[allow(unused_mut, unused_variables, clippy::let_unit_value)]
            fn process(&mut self, args: &Args) -> Outcome {
                #(#before)*
                let result #returned = #called;
                #fails
                let mut sent: Vec<(usize, Option<Value>)> = vec![];
                #sent
                #(#written)*
                Ok(sent)
            }
        })
    }

    /// The type of what `process` returns, as far as the ports say it. Nothing else tells rustc the types of a function
    /// that takes no tokens.
    fn returned(&self) -> Result<TokenStream, String> {
        let returns = self.signature.returns;
        let Some((port, p)) = self.signature.returned().next().filter(|_| !returns.several) else {
            return Ok(quote!());
        };
        let (mut ty, rate) = (self.token_type(PortId { node: self.node, port })?, p.rate);
        if rate > 1 {
            ty = quote!([#ty; #rate]);
        }
        if returns.maybe {
            ty = quote!(::core::option::Option<#ty>);
        }
        if returns.fallible {
            ty = quote!(::core::result::Result<#ty, _>);
        }
        Ok(quote!(: #ty))
    }

    /// The tokens of an input as an argument.
    fn input(&self, port: usize, call: &mut CallCode) -> Result<TokenStream, String> {
        let p = &self.signature.ports[port];
        let mut tokens = vec![];
        let elements: Vec<usize> = match p.any_number {
            true => self.graph.nodes[self.node].elements(port).collect(),
            false => vec![port],
        };
        for element in elements {
            let (name, at) = (format_ident!("token_{element}"), call.tokens);
            call.tokens += 1;
            let Some(connection) = self.graph.incoming(PortId { node: self.node, port: element }) else {
                tokens.push(quote!(None));
                continue;
            };
            let (ty, rate) = (self.token_type(connection.from)?, p.rate);
            let token = if rate > 1 {
                quote!(batch::<#ty, #rate>(&args.tokens[#at])?)
            } else {
                quote!(token::<#ty>(&args.tokens[#at])?)
            };
            let (input, node_type) = (p.index, &self.node_type);
            let wanted = quote!(<#node_type as ::apex_rt::Input<#input>>::Token);
            call.before.push(if p.optional {
                let wanted = if rate > 1 { quote!([#ty; #rate]) } else { wanted };
                let token = if rate > 1 { quote!(#token.as_ref()) } else { token };
                quote! { let #name = #token.map(|token| -> &#wanted { token }); }
            } else if rate > 1 {
                quote! { let #name = &#token.ok_or_else(missing)?; }
            } else {
                quote! { let #name = #token.ok_or_else(missing)?; }
            });
            tokens.push(quote!(#name));
        }
        Ok(if p.any_number { quote!([#(#tokens),*]) } else { quote!(#(#tokens)*) })
    }

    /// Code that puts what was returned into `sent`.
    fn sent(&self) -> TokenStream {
        let returns = self.signature.returns;
        let puts = self.signature.returned().map(|(port, p)| match &p.field {
            Some((_, field)) if returns.several => {
                let (field, value) = (ident(field), self.value(port, &quote!(token)));
                match p.field_is_option {
                    true => quote! { sent.push((#port, result.#field.map(|token| #value))); },
                    false => quote! { { let token = result.#field; sent.push((#port, Some(#value))); } },
                }
            }
            _ => {
                let value = self.value(port, &quote!(result));
                quote! { sent.push((#port, Some(#value))); }
            }
        });
        match (returns.value, returns.maybe) {
            (false, _) => quote!(),
            (true, true) => quote! { if let Some(result) = result { #(#puts)* } },
            (true, false) => quote! { #(#puts)* },
        }
    }

    /// The tokens of a firing at a port as a value.
    fn value(&self, port: usize, token: &TokenStream) -> TokenStream {
        if self.signature.ports[port].rate > 1 { quote!(batched(#token)) } else { quote!(value(#token)) }
    }

    fn slots(&self) -> Result<TokenStream, String> {
        let mut arms = vec![];
        for slot in &self.signature.slots {
            let (port, call) = (slot.port, self.slot_call(slot));
            let types = self.slot_types(port)?;
            let call = match slot.args.contains(&ArgSig::Port(port)) {
                true => types.iter().rev().fold(quote!(Err(missing())), |otherwise, ty| {
                    quote!(if let Ok(Some(token)) = token::<#ty>(&args.tokens[0]) { #call } else { #otherwise })
                }),
                false if types.is_empty() => quote!(Ok(())),
                false => call,
            };
            arms.push(quote! { #port => { #call } });
        }
        Ok(quote! {
            #[allow(unused_mut, unused_variables, clippy::let_unit_value)]
            fn slot(&mut self, port: usize, args: &Args) -> Result<(), ::apex_rt::Failure> {
                match port { #(#arms)* _ => Ok(()) }
            }
        })
    }

    /// The call of the method of a slot with `token`.
    fn slot_call(&self, slot: &SlotSig) -> TokenStream {
        let mut call = CallCode::default();
        for arg in &slot.args {
            let arg = match *arg {
                ArgSig::Port(own) if own == slot.port => quote!(token),
                ArgSig::Port(event) => call.event(event),
                ArgSig::Ctx | ArgSig::Param(_) => quote!(&args.ctx),
            };
            call.args.push(arg);
        }
        let CallCode { before, args, .. } = call;
        let method = ident(&slot.method);
        let ends = match slot.fallible {
            true => quote!(result.map(drop).map_err(|error| ::apex_rt::Failure::new(&error))),
            false => quote!(Ok(())),
        };
        quote! { #(#before)* let result = self.node.#method(#(#args),*); #ends }
    }

    /// The types of the tokens and constants that come to a slot, each once.
    fn slot_types(&self, port: usize) -> Result<Vec<TokenStream>, String> {
        let end = PortId { node: self.node, port };
        let connections = self.graph.connections.iter().filter(|connection| connection.to == end);
        let types = connections.map(|connection| match &connection.given {
            Some(given) => constant_type(&given.value, &self.graph.port(end).ty, self.generator.catalog),
            None => self.token_type(connection.from),
        });
        let types: Result<BTreeMap<String, TokenStream>, String> =
            types.map(|ty| ty.map(|ty| (ty.to_string(), ty))).collect();
        Ok(types?.into_values().collect())
    }

    /// The methods for ⊥ and for changes of activity.
    fn hooks(&self) -> TokenStream {
        let method = |name: &Option<String>| {
            name.as_ref().map_or_else(
                || quote!(),
                |name| {
                    let name = ident(name);
                    quote!(self.node.#name();)
                },
            )
        };
        let absent = method(&self.signature.no_message);
        let (on, off) = (method(&self.signature.on_activate), method(&self.signature.on_deactivate));
        quote! {
            fn absent(&mut self) { #absent }
            fn turned(&mut self, active: bool) { if active { #on } else { #off } }
        }
    }

    /// The methods for parameters.
    fn params(&self) -> TokenStream {
        let (node_type, is_function) = (&self.node_type, self.signature.is_function);
        let with_ports = self.with_ports.iter().copied();
        let rows: Vec<_> = with_ports
            .map(|param| (param, self.param_type(param), self.signature.params[param].name.as_str()))
            .collect();
        let gets = rows.iter().map(|(param, ..)| match is_function {
            true => quote! { #param => Some(self.params[#param].clone()), },
            false => quote! { #param => Some(value(::apex_rt::ParamField::<#param>::field(&mut self.node).clone())), },
        });
        let accepts = rows.iter().map(|(param, ty, name)| {
            quote! {
                #param => match token.downcast_ref::<#ty>() {
                    Some(value) if !<#node_type as ::apex_rt::Param<#param>>::accepts(value) => {
                        Err((#name, (&Shown(value)).shown()))
                    }
                    _ => Ok(()),
                },
            }
        });
        let sets = rows.iter().filter(|_| !is_function).map(|(param, ty, ..)| {
            quote! {
                #param => if let Some(value) = token.downcast_ref::<#ty>() {
                    ::apex_rt::ParamField::<#param>::field(&mut self.node).clone_from(value);
                },
            }
        });
        let silence = self.signature.silence().filter(|_| !is_function).map(|param| {
            let param = Literal::usize_unsuffixed(param);
            quote! { fn silence(&mut self) -> ::core::time::Duration { ::apex_rt::endured::<#param, _>(&mut self.node) } }
        });
        quote! {
            fn param(&mut self, param: usize) -> Option<Value> { match param { #(#gets)* _ => None } }
            fn accepts(&self, param: usize, token: &Value) -> Result<(), (&'static str, String)> {
                match param { #(#accepts)* _ => Ok(()) }
            }
            fn put_param(&mut self, param: usize, token: &Value) { match param { #(#sets)* _ => {} } }
            #silence
        }
    }
}

/// The field of an output that the node writes in place.
fn buffer(port: usize) -> Ident {
    format_ident!("out_{port}")
}

/// The code of a call, argument by argument.
#[derive(Default)]
struct CallCode {
    before: Vec<TokenStream>,
    args: Vec<TokenStream>,
    /// Number of tokens among the arguments until now.
    tokens: usize,
}

impl CallCode {
    /// An event as an argument.
    fn event(&mut self, port: usize) -> TokenStream {
        let name = format_ident!("event_{port}");
        self.before.push(quote! { let mut #name = Event::new(#port, args); });
        quote!(::apex_rt::event(&mut #name.token))
    }
}
