//! Results of a call: names for what a node returns, and the outputs of its parameters.

use super::{
    fire::Emitter,
    types::{ident, to_rust},
};
use crate::{
    catalog::{ArgSig, Signature},
    graph::{Library, NodeId, NodeKind, PortId},
    program::{BlockId, Storage, is_buffer},
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::quote;
use syn::Ident;

impl Emitter<'_> {
    /// Names of the outputs that a node writes in place.
    pub fn buffers(&self, node: NodeId) -> Vec<Ident> {
        let ports = 0..self.graph.nodes[node].ports.len();
        ports
            .map(|port| PortId { node, port })
            .filter(|end| is_buffer(self.graph, self.generator.catalog, *end))
            .map(|end| self.generator.name(end))
            .collect()
    }

    /// The call as a statement that gives names to what it returns.
    pub fn results(
        &self,
        node: NodeId,
        library: &Library,
        signature: &Signature,
        call: TokenStream,
        told: bool,
    ) -> TokenStream {
        let returns = signature.returns;
        let failing = returns.fallible || self.graph.nodes[node].is_contained();
        let mut optional = returns.maybe || told || self.returns_checked(node, signature);
        let mut value = call;
        let mut before = quote!();
        if failing {
            value = self.generator.contained(self.graph, node, library, value, returns.fallible);
            let clears: Vec<TokenStream> =
                self.buffers(node).into_iter().map(|name| quote! { state.#name.clear(); }).collect();
            let nested = returns.value && (returns.maybe || told || self.returns_checked(node, signature));
            if !clears.is_empty() {
                before = quote! { let sent = #value; if sent.is_none() { #(#clears)* } };
                value = quote!(sent);
            }
            if nested {
                value = quote!(#value.flatten());
            }
            optional = true;
        }
        let outputs: Vec<(PortId, Option<&str>, bool)> = signature
            .ports
            .iter()
            .enumerate()
            .filter(|(port, p)| {
                p.kind == PortKind::Output
                    && !signature.process.as_ref().is_some_and(|args| args.contains(&ArgSig::Port(*port)))
            })
            .map(|(port, p)| (PortId { node, port }, p.field.as_ref().map(|(_, name)| name.as_str()), p.optional))
            .filter(|(end, ..)| self.plan.is_used(*end))
            .collect();
        let results = match outputs.as_slice() {
            // A call that returns nothing needs no name for it.
            [] if !returns.value && !failing && !told => quote! { #value; },
            [] if before.is_empty() => quote! { let _ = #value; },
            [] => quote!(),
            _ if !returns.several => self.bind(outputs[0].0, value, optional),
            _ => self.bind_fields(&outputs, value, optional),
        };
        quote! { #before #results }
    }

    fn returns_checked(&self, node: NodeId, signature: &Signature) -> bool {
        signature.is_function
            && (0..signature.params.len())
                .any(|p| signature.params[p].range.is_some() && self.param_source(node, p).is_some())
    }

    /// `let name = value;`, or the assignment to a name declared further out. What is there for certain is used
    /// by reference in the rest of its own block; not what a node that may be disabled sends.
    pub fn bind(&self, end: PortId, value: TokenStream, optional: bool) -> TokenStream {
        let name = self.generator.name(end);
        if self.plan.storage(end) == Storage::Array {
            return self.put_in_array(end, value, optional);
        }
        match (self.plan.is_hoisted(end), optional) {
            (false, _) => quote! { let #name = #value; },
            (true, true) => quote! { #name = #value; },
            (true, false) if self.plan.storage(end) == Storage::Local => quote! { let #name = &*#name.insert(#value); },
            (true, false) => quote! { #name = Some(#value); },
        }
    }

    fn bind_fields(&self, outputs: &[(PortId, Option<&str>, bool)], value: TokenStream, optional: bool) -> TokenStream {
        let fields = outputs.iter().map(|(end, field, port_optional)| {
            let field = field.map_or_else(|| self.generator.nameless("the field of an output"), ident);
            let field_is_option = self.field_is_option(*end);
            let value = match (optional, field_is_option) {
                (false, _) => quote!(results.#field),
                // `Option<Struct>`: taken apart by reference to its place, so that every field can be moved out.
                (true, true) => quote!(results.as_mut().and_then(|results| results.#field.take())),
                (true, false) => quote!(results.as_ref().map(|results| ::core::clone::Clone::clone(&results.#field))),
            };
            self.bind(*end, value, optional || *port_optional)
        });
        let fields: TokenStream = fields.collect();
        let mutable = if optional { quote!(mut) } else { quote!() };
        quote! { #[allow(unused_mut)] let #mutable results = #value; #fields }
    }

    /// Returns `true` if the field itself is an `Option`. A port is also optional if the whole struct may be missing.
    fn field_is_option(&self, end: PortId) -> bool {
        let NodeKind::Library(library) = &self.graph.nodes[end.node].kind else { return false };
        let signature = &self.generator.catalog.signatures[library.signature];
        signature.ports[end.port].field_is_option
    }

    /// Connected outputs of parameters: the value of this firing.
    pub fn param_outputs(&self, node: NodeId, library: &Library, signature: &Signature, block: BlockId) -> TokenStream {
        let ends = self.graph.nodes[node].ports.iter().enumerate().filter_map(|(port, p)| {
            let end = PortId { node, port };
            (p.kind == PortKind::Output && self.plan.is_used(end)).then_some((end, p.parameter?))
        });
        let binds = ends.map(|(end, param)| {
            let value = if signature.is_function {
                match self.param_source(node, param) {
                    Some(to) => self.clone_of_arrived(to, block),
                    None => {
                        let (ty, constant) = (
                            to_rust(&signature.params[param].ty, self.generator.catalog),
                            self.generator.param_value(self.graph, library, param),
                        );
                        ty.map_or(quote!(#constant), |ty| quote!({ let value: #ty = #constant; value }))
                    }
                }
            } else {
                let place = self.generator.node_place(self.graph, node);
                quote!(::core::clone::Clone::clone(::apex_rt::ParamField::<#param>::field(&mut #place)))
            };
            let maybe = self.plan.storage(end) == Storage::Maybe;
            let value = if maybe { quote!(Some(#value)) } else { value };
            self.bind(end, value, maybe)
        });
        binds.collect()
    }
}
