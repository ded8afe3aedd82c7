//! The parameters of a program: a table, and a way to each.

use super::{distinct::Distinct, generator::Generator, names::constant_name, tokens::ident};
use crate::{
    analyse::Analysis,
    catalog::Limits,
    graph::{Graph, Library, NodeId, NodeKind, snake},
};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use syn::Ident;

/// The parameters of a program.
#[derive(Default)]
pub struct ParamRows {
    /// Rows of the table.
    table: Vec<TokenStream>,
    /// The node types with parameters.
    types: Distinct,
    /// Constants with what each of them declares.
    declared: Vec<Ident>,
    /// For each node with parameters, a visit of them: the node beside which it is kept, and the visit.
    visits: Vec<(NodeId, TokenStream)>,
}

impl ParamRows {
    /// The implementation of `Parameters` for the program `name`. `place` returns where a node is kept with those
    /// beside it.
    pub fn implementation(&self, name: &Ident, place: &dyn Fn(NodeId) -> TokenStream) -> TokenStream {
        let (table, declared, types) = (&self.table, &self.declared, self.types.rows());
        let visit = self.visit(&|node| Some(place(node)));
        quote! {
            #(const #declared: &'static [::apex_rt::params::Declared] = <#types as ::apex_rt::Params>::DECLARED;)*
            const PARAMS: &'static [::apex_rt::params::ParamInfo] = &[#(#table),*];
            impl ::apex_rt::params::Parameters for #name {
                const PARAMS: &'static [::apex_rt::params::ParamInfo] = PARAMS;
                #visit
            }
        }
    }

    /// The constant with what a node type declares: `PATH_FOLLOWER`, or `PATH_FOLLOWER_7` where another type has that
    /// name.
    fn declared(&mut self, name: &str, ty: TokenStream) -> Ident {
        let number = self.types.number(ty);
        if number == self.declared.len() {
            let plain = ident(&constant_name(&snake(name)));
            let is_taken = self.declared.contains(&plain);
            self.declared.push(if is_taken { format_ident!("{plain}_{number}") } else { plain });
        }
        self.declared[number].clone()
    }

    /// The function that visits the parameters of those nodes that have a `place`.
    pub fn visit(&self, place: &dyn Fn(NodeId) -> Option<TokenStream>) -> TokenStream {
        let mut before = String::new();
        let places = self.visits.iter().filter_map(|(node, visit)| Some((place(*node)?, visit)));
        let visits = places.map(|(place, visit)| {
            let changes = std::mem::replace(&mut before, place.to_string()) != before;
            let nodes = changes.then(|| quote! { let nodes = &mut #place; });
            quote! { #nodes #visit }
        });
        let visits: TokenStream = visits.collect();
        quote! {
            fn visit_params(&mut self, visitor: &mut dyn ::apex_rt::params::ParamVisitor) {
                use ::apex_rt::params::{Known as _, Opaque as _};
                #visits
            }
        }
    }
}

/// A range that holds beside that of the declaration.
fn within((min, max, inclusive): Limits) -> TokenStream {
    let [min, max] =
        [min, max].map(|bound| match bound.map(|bound| (bound < 0.0, Literal::f64_unsuffixed(bound.abs()))) {
            None => quote!(::core::option::Option::None),
            Some((true, size)) => quote!(::core::option::Option::Some(-#size)),
            Some((false, size)) => quote!(::core::option::Option::Some(#size)),
        });
    quote!(.within(::apex_rt::params::ParamRange::new(#min, #max, #inclusive)))
}

impl Generator<'_> {
    /// The parameters of a program.
    pub fn parameters(&self, graph: &Graph, analysis: &Analysis) -> ParamRows {
        let mut rows = ParamRows::default();
        self.param_rows(graph, analysis, None, &mut rows);
        rows
    }

    /// Adds the parameters of a graph. In the body of an `each`, `outer` is the node of the program that it belongs to.
    fn param_rows(&self, graph: &Graph, analysis: &Analysis, outer: Option<NodeId>, rows: &mut ParamRows) {
        for (id, node) in graph.nodes.iter_enumerated() {
            let owner = outer.unwrap_or(id);
            match &node.kind {
                NodeKind::Library(library) => self.params_of_node(graph, id, library, owner, rows),
                NodeKind::Each(each) => {
                    if let Some(body) = analysis.bodies.get(&id) {
                        self.inside(graph, id).param_rows(&each.body, body, Some(owner), rows);
                    }
                }
                _ => {}
            }
        }
    }

    /// Adds the parameters of a struct node; those of a function are part of the code.
    fn params_of_node(&self, graph: &Graph, node: NodeId, library: &Library, owner: NodeId, rows: &mut ParamRows) {
        let signature = &self.catalog.signatures[library.signature];
        if signature.is_function || signature.params.is_empty() {
            return;
        }
        let (path, place) = (self.node_path(graph, node).join("."), self.node_place(graph, node));
        let declared = rows.declared(&signature.name, self.node_type(graph, library));
        let first = Literal::usize_unsuffixed(rows.table.len());
        let numbers = || (0..signature.params.len()).map(Literal::usize_unsuffixed);
        for (param, number) in numbers().enumerate() {
            let name = format!("{path}.{}", signature.params[param].name);
            let ty = self.param_type(library, param).to_string();
            let within = library.ranges[param].iter().map(|range| within(*range));
            rows.table.push(quote!(#declared[#number] #(#within)* .of(#name, #ty)));
        }
        let numbers = numbers();
        let visit = quote! { ::apex_rt::visit_params!(visitor, PARAMS, #first, #place, #(#numbers)*); };
        rows.visits.push((owner, visit));
    }
}
