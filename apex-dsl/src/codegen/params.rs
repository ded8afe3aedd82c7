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

/// Description of the parameters of a program, one entry each.
#[derive(Default)]
struct Rows {
    table: Vec<TokenStream>,
    visits: Vec<TokenStream>,
}

impl Generator<'_> {
    /// The implementation of `Parameters` for a program; `nodes` says where the nodes are kept that stand beside a
    /// node.
    pub fn parameters(&self, graph: &Graph, analysis: &Analysis, nodes: &dyn Fn(NodeId) -> TokenStream) -> TokenStream {
        let name = super::types::ident(&graph.name);
        let mut rows = Rows::default();
        self.param_rows(graph, analysis, &nodes, &mut rows);
        let Rows { table, visits } = rows;
        quote! {
            impl ::apex_rt::params::Parameters for #name {
                const PARAMS: &'static [::apex_rt::params::ParamInfo] = &[#(#table),*];
                fn visit_params<V: ::apex_rt::params::ParamVisitor>(&mut self, visitor: &mut V) {
                    use ::apex_rt::params::{Known as _, Opaque as _};
                    #(#visits)*
                }
            }
        }
    }

    fn param_rows(&self, graph: &Graph, analysis: &Analysis, nodes: &dyn Fn(NodeId) -> TokenStream, rows: &mut Rows) {
        for (id, node) in graph.nodes.iter().enumerate() {
            match &node.kind {
                NodeKind::Library(library) if !self.catalog.signatures[library.signature].is_function => {
                    let (path, place) = (self.node_path(graph, id).join("."), self.node_place(graph, id));
                    let nodes = nodes(id);
                    for (param, declared) in self.catalog.signatures[library.signature].params.iter().enumerate() {
                        let row = rows.table.len();
                        rows.table.push(self.param_row(library, param, declared, &path));
                        rows.visits.push(quote! {
                            let nodes = &mut #nodes;
                            ::apex_rt::params::Probe::<_, #param>::new(&mut #place).visit(&Self::PARAMS[#row], visitor);
                        });
                    }
                }
                NodeKind::Each(each) => {
                    if let Some(body) = analysis.bodies.get(&id) {
                        let around = nodes(id);
                        self.inside(graph, id).param_rows(&each.body, body, &|_| around.clone(), rows);
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
        let unit = option((!dimension.is_none()).then(|| dimension.to_string()).map(|unit| quote!(#unit)));
        let (min, max, inclusive) = declared.range.unwrap_or((None, None, false));
        let (min, max) = (option(min.and_then(float)), option(max.and_then(float)));
        quote! {
            ::apex_rt::params::ParamInfo::new(#name, #spelled, #unit, ::apex_rt::params::ParamRange::new(#min, #max, #inclusive))
        }
    }
}

pub fn option(value: Option<TokenStream>) -> TokenStream {
    value.map_or(quote!(None), |value| quote!(Some(#value)))
}

/// A number as an expression; `None` if there is no literal for it.
fn float(value: f64) -> Option<TokenStream> {
    let literal = value.is_finite().then(|| Literal::f64_unsuffixed(value.abs()))?;
    Some(if value < 0.0 { quote!(-#literal) } else { quote!(#literal) })
}
