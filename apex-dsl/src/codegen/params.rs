//! The parameters of a program: a table, and a way to each.

use super::Generator;
use crate::{
    analyse::Analysis,
    catalog::ParamSig,
    graph::{Graph, Library, NodeId, NodeKind},
    units,
};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use syn::Ident;

/// The parameters of a program.
#[derive(Default)]
pub struct ParamRows {
    /// Rows of the table.
    table: Vec<TokenStream>,
    /// For each node with parameters, a visit of them: the node beside which it is kept, and the visit.
    visits: Vec<(NodeId, TokenStream)>,
}

impl ParamRows {
    /// The implementation of `Parameters` for the program `name`. `place` returns where a node is kept with those
    /// beside it.
    pub fn implementation(&self, name: &Ident, place: &dyn Fn(NodeId) -> TokenStream) -> TokenStream {
        let table = &self.table;
        let visit = self.visit(&|node| Some(place(node)));
        quote! {
            impl ::apex_rt::params::Parameters for #name {
                const PARAMS: &'static [::apex_rt::params::ParamInfo] = { use ::apex_rt::params::ParamInfo; &[#(#table),*] };
                #visit
            }
        }
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
            fn visit_params<V: ::apex_rt::params::ParamVisitor>(&mut self, visitor: &mut V) {
                use ::apex_rt::params::{Known as _, Opaque as _};
                #visits
            }
        }
    }
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
                NodeKind::Library(library) if !self.catalog.signatures[library.signature].is_function => {
                    let (path, place) = (self.node_path(graph, id).join("."), self.node_place(graph, id));
                    let params = &self.catalog.signatures[library.signature].params;
                    let (first, numbers) = (rows.table.len(), (0..params.len()).map(Literal::usize_unsuffixed));
                    let rows_of = params.iter().enumerate();
                    rows.table.extend(rows_of.map(|(param, declared)| self.param_row(library, param, declared, &path)));
                    if !params.is_empty() {
                        let first = Literal::usize_unsuffixed(first);
                        let visit = quote! {
                            ::apex_rt::visit_params!(visitor, Self::PARAMS, #first, #place, #(#numbers)*);
                        };
                        rows.visits.push((owner, visit));
                    }
                }
                NodeKind::Each(each) => {
                    if let Some(body) = analysis.bodies.get(&id) {
                        self.inside(graph, id).param_rows(&each.body, body, Some(owner), rows);
                    }
                }
                _ => {}
            }
        }
    }

    fn param_row(&self, library: &Library, param: usize, declared: &ParamSig, path: &str) -> TokenStream {
        let ty = self.param_type(library, param);
        let (name, spelled) = (format!("{path}.{}", declared.name), ty.to_string());
        // Values are in SI, whatever the unit of the declaration is.
        let given = declared.unit.as_deref().and_then(|unit| units::parse(unit).ok());
        let dimension = if ty.name() == "Duration" {
            units::Dimension::TIME
        } else {
            given.map_or(units::Dimension::NONE, |u| u.dimension)
        };
        let unit = (!dimension.is_none()).then(|| dimension.to_string()).map(|unit| quote!(.unit(#unit)));
        let (min, max, inclusive) = declared.range.unwrap_or((None, None, false));
        let min = min.and_then(float).map(|min| quote!(.at_least(#min)));
        let max = max.and_then(float).map(|max| match inclusive {
            true => quote!(.at_most(#max)),
            false => quote!(.below(#max)),
        });
        quote!(ParamInfo::new(#name, #spelled) #unit #min #max)
    }
}

/// A number as an expression; `None` if there is no literal for it.
fn float(value: f64) -> Option<TokenStream> {
    let literal = value.is_finite().then(|| Literal::f64_unsuffixed(value.abs()))?;
    Some(if value < 0.0 { quote!(-#literal) } else { quote!(#literal) })
}
