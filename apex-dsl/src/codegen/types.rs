//! Types and values in generated code.

use super::{
    generator::Generator,
    tokens::{constant, path, to_rust},
};
use crate::{
    catalog::Type,
    graph::{Graph, Library, NodeId, NodeKind, PortId, TypeArg, Value},
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

impl Generator<'_> {
    /// The type of a node of the catalog.
    pub fn node_type(&self, graph: &Graph, library: &Library) -> TokenStream {
        if let Some((view, _)) = self.part {
            return self.of_all().node_type(view, library);
        }
        let signature = &self.catalog.signatures[library.signature];
        let head = path(&signature.path);
        if library.types.is_empty() {
            return head;
        }
        let args = library.types.iter().map(|arg| match arg {
            TypeArg::Known(ty) => to_rust(ty, self.catalog).unwrap_or_else(|| quote!(_)),
            TypeArg::Verbatim(ty, text) => to_rust(ty, self.catalog).unwrap_or_else(|| self.parsed(graph, text)),
            TypeArg::TokenOf(end, _) => self.token_type(graph, *end),
            TypeArg::ItemOf(end, _) => {
                let list = self.token_type(graph, *end);
                quote!(<#list as ::apex_rt::List>::Item)
            }
            TypeArg::Open => quote!(_),
        });
        quote!(#head<#(#args),*>)
    }

    /// The type of the tokens that leave a port.
    pub fn token_type(&self, graph: &Graph, end: PortId) -> TokenStream {
        if let Some((view, part)) = self.part {
            return self.of_all().token_type(view, part.origin(end));
        }
        let port = graph.port(end);
        match &graph.nodes[end.node].kind {
            NodeKind::Each(_) => self.each_type(graph, end),
            NodeKind::Delay(_) | NodeKind::Relay => match graph.incoming(PortId { node: end.node, port: 0 }) {
                Some(connection) => self.token_type(graph, connection.from),
                // Nothing ever comes: the text says what would.
                None => to_rust(&port.ty, self.catalog).unwrap_or_else(|| quote!(())),
            },
            NodeKind::Probe => match graph.connections.iter().find(|c| c.to.node == end.node && c.given.is_none()) {
                Some(connection) => self.token_type(graph, connection.from),
                None => to_rust(&port.ty, self.catalog).unwrap_or_else(|| quote!(())),
            },
            NodeKind::Boundary(_) if graph.is_body => self.body_input_type(graph, end.node),
            NodeKind::Library(library) => match to_rust(&port.ty, self.catalog) {
                Some(ty) => ty,
                None => self.projection(graph, library, end),
            },
            _ => to_rust(&port.ty, self.catalog)
                .unwrap_or_else(|| self.parsed(graph, &port.ty.without_unit().to_string())),
        }
    }

    /// A type as it is written.
    fn parsed(&self, graph: &Graph, text: &str) -> TokenStream {
        text.parse().unwrap_or_else(|_| self.bug(graph.span, &format!("`{text}` is not a type of Rust")))
    }

    /// A type that only rustc can spell, by way of the node's ports.
    fn projection(&self, graph: &Graph, library: &Library, end: PortId) -> TokenStream {
        let node = self.node_type(graph, library);
        let signature = &self.catalog.signatures[library.signature];
        if let Some(param) = graph.port(end).parameter {
            return quote!(<#node as ::apex_rt::Param<#param>>::Value);
        }
        let port = &signature.ports[end.port];
        let index = port.index;
        if port.kind == PortKind::Event {
            return quote!(<#node as ::apex_rt::Trigger<#index>>::Token);
        }
        let view = quote!(<#node as ::apex_rt::Output<#index>>::Token);
        match &port.field {
            Some((field, _)) => quote!(<#view as ::apex_rt::Field<#field>>::Token),
            None => view,
        }
    }

    /// The list of results of an `each`: the same kind of list as the one that it iterates over.
    fn each_type(&self, graph: &Graph, end: PortId) -> TokenStream {
        let NodeKind::Each(each) = &graph.nodes[end.node].kind else { return quote!(()) };
        let name = &graph.port(end).name;
        let body = &each.body;
        let inside = body.nodes.position(|n| matches!(n.kind, NodeKind::Boundary(PortKind::Output)) && n.name == *name);
        let item = inside.and_then(|node| body.incoming(PortId { node, port: 0 })).map(|c| {
            let outer = self.inside(graph, end.node);
            outer.token_type(body, c.from)
        });
        let list = each.list.and_then(|port| graph.incoming(PortId { node: end.node, port }));
        let list = list.map(|c| self.token_type(graph, c.from));
        match (list, item) {
            (Some(list), Some(item)) => quote!(<#list as ::apex_rt::List>::Of<#item>),
            _ => quote!(()),
        }
    }

    /// The type of an input of an `each` body, from the graph around it.
    fn body_input_type(&self, body: &Graph, node: NodeId) -> TokenStream {
        let port = &body.nodes[node].ports[0];
        let spelled = to_rust(&port.ty, self.catalog);
        let Some((graph, each_node, outer)) = self.outer else { return spelled.unwrap_or_default() };
        if let Some(ty) = spelled {
            return ty;
        }
        let NodeKind::Each(each) = &graph.nodes[each_node].kind else { return quote!(()) };
        let name = &body.nodes[node].name;
        let ports = &graph.nodes[each_node].ports;
        let arriving = ports.iter().position(|p| p.kind == PortKind::Input && p.name == *name);
        let arriving = arriving.and_then(|port| graph.incoming(PortId { node: each_node, port }));
        let is_list = each.list.is_some_and(|list| ports[list].name == *name);
        match arriving.map(|c| outer.token_type(graph, c.from)) {
            Some(list) if is_list => quote!(<#list as ::apex_rt::List>::Item),
            Some(ty) => ty,
            None => quote!(()),
        }
    }

    /// The value of a parameter as an expression.
    pub fn param_value(&self, graph: &Graph, library: &Library, param: usize) -> TokenStream {
        let signature = &self.catalog.signatures[library.signature];
        let declared = &signature.params[param];
        match &library.params[param] {
            Value::RustDefault => {
                let node = self.node_type(graph, library);
                let default = format_ident!("apex_default_{}", declared.name);
                quote!(<#node>::#default())
            }
            value => constant(value, &self.param_type(library, param)),
        }
    }

    /// The type of a parameter, with type parameters of the node replaced as far as they are known.
    pub fn param_type(&self, library: &Library, param: usize) -> Type {
        let signature = &self.catalog.signatures[library.signature];
        let known = |name: &str| {
            let index = signature.generics.iter().position(|g| g == name)?;
            match library.types.get(index)? {
                TypeArg::Known(ty) | TypeArg::Verbatim(ty, _) => Some(ty.clone()),
                TypeArg::Open | TypeArg::TokenOf(..) | TypeArg::ItemOf(..) => None,
            }
        };
        signature.params[param].ty.substitute(&known)
    }
}
