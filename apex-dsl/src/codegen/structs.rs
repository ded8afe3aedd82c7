//! The structs that a program consists of.

use super::{names::unused, tokens::ident};
use crate::graph::camel;
use proc_macro2::TokenStream;
use quote::quote;
use std::collections::{BTreeMap, BTreeSet};
use syn::Ident;

/// One of the structs that a program consists of: `Nodes`, `State`, `Inputs`, `Outputs`, `Events`. Without fields it
/// is `()`.
pub struct Struct {
    /// Declaration, with that of the structs below it.
    pub item: TokenStream,
    /// Its type.
    pub ty: TokenStream,
    /// Expression with the initial value.
    pub make: TokenStream,
}

impl Struct {
    /// A struct of these fields: declarations, and expressions with the initial values.
    pub fn new(name: &Ident, docs: &str, fields: &[(TokenStream, TokenStream)]) -> Self {
        let (declared, made): (Vec<&TokenStream>, Vec<&TokenStream>) = fields.iter().map(|(d, m)| (d, m)).unzip();
        if fields.is_empty() {
            return Self { item: quote!(), ty: quote!(()), make: quote!(()) };
        }
        let docs = format!(" {docs}");
        Self {
            item: quote! { #[doc = #docs] pub struct #name { #(#declared,)* } },
            ty: quote!(#name),
            make: quote!(#name { #(#made,)* }),
        }
    }

    /// Method that gives access to it where it is kept at `place`; none if it has no fields.
    pub fn accessor(&self, docs: &str, name: &str, place: &TokenStream) -> TokenStream {
        if self.item.is_empty() {
            return quote!();
        }
        let (ty, mutable) = (&self.ty, ["inputs", "events"].contains(&name).then(|| quote!(mut)));
        let (name, docs) = (ident(name), format!(" {docs}"));
        quote! {
            #[doc = #docs]
            pub fn #name(&#mutable self) -> &#mutable #ty { &#mutable #place.#name }
        }
    }
}

/// Methods that give access to the ports of a program: [`Generator::port_structs`], which are kept at `place`.
pub fn port_accessors([inputs, outputs, events]: &[Struct; 3], place: &TokenStream) -> TokenStream {
    let inputs = inputs.accessor("The graph-level inputs and slots.", "inputs", place);
    let outputs = outputs.accessor("The graph-level outputs.", "outputs", place);
    let events = events.accessor("The graph-level events.", "events", place);
    quote! { #inputs #outputs #events }
}

/// A field of the struct of nodes: a node, or the nodes of a nested graph.
pub enum Field {
    Node { ty: TokenStream, make: TokenStream },
    Nested(BTreeMap<String, Field>),
}

/// Puts a field where its path leads.
pub fn insert(fields: &mut BTreeMap<String, Field>, path: &[String], field: Field) {
    match path {
        [name] => {
            fields.insert(name.clone(), field);
        }
        [first, rest @ ..] => {
            if let Field::Nested(inner) = fields.entry(first.clone()).or_insert_with(|| Field::Nested(BTreeMap::new()))
            {
                insert(inner, rest, field);
            }
        }
        [] => {}
    }
}

/// The visibility of what belongs to a program alone: where the call of `graph!` stands, it can be looked at. A program
/// has a module of its own ([`super::text`]) in the one of its text.
pub fn around_text() -> TokenStream {
    quote!(pub(in super::super))
}

/// The struct of a level of nodes with all below it. No struct of it is called like the program.
///
/// If `borrowed`, it has references to nodes that are kept elsewhere.
pub fn node_structs(name: &Ident, program: &Ident, fields: &BTreeMap<String, Field>, borrowed: bool) -> Struct {
    let mut used = BTreeSet::from([name.to_string(), program.to_string()]);
    node_struct(name, fields, borrowed, &mut used)
}

fn node_struct(name: &Ident, fields: &BTreeMap<String, Field>, borrowed: bool, used: &mut BTreeSet<String>) -> Struct {
    let life = borrowed.then(|| quote!(<'a>));
    let (mut below, mut own) = (quote!(), vec![]);
    for (field, content) in fields {
        let field_name = ident(field);
        own.push(match content {
            Field::Node { ty, make } => (quote!(pub #field_name: #ty), quote!(#field_name: #make)),
            Field::Nested(inner) => {
                // `a` with `b` inside and `a_b` would have the same name.
                let inner_name = ident(&unused(format!("{name}{}", camel(field)), used));
                let Struct { item, make, .. } = node_struct(&inner_name, inner, borrowed, used);
                below.extend(item);
                (quote!(pub #field_name: #inner_name #life), quote!(#field_name: #make))
            }
        });
    }
    let docs = " Nodes, by instance name.";
    let mut made = Struct::new(name, docs.trim_start(), &own);
    if borrowed && !own.is_empty() {
        let declared = own.iter().map(|(declared, _)| declared);
        made.item = quote! { #[doc = #docs] pub struct #name<'a> { #(#declared,)* } };
        made.ty = quote!(#name<'_>);
    }
    made.item.extend(below);
    made
}
