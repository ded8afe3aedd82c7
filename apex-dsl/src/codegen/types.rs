//! Types and values in generated code.

use super::Generator;
use crate::{
    catalog::{Catalog, Type},
    graph::{Graph, Library, NodeId, NodeKind, Number, PortId, TypeArg, Value},
    syntax::tree::PortKind,
};
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::Ident;

/// A path from its segments; an empty first one stands for a leading `::`.
pub fn path(segments: &[String]) -> TokenStream {
    let segments = segments.iter().map(|segment| match segment.as_str() {
        "" => quote!(),
        "crate" => quote!(crate),
        "self" => quote!(self),
        "super" => quote!(super),
        name => ident(name).into_token_stream(),
    });
    quote!(#(#segments)::*)
}

/// An identifier, also where the word is a keyword of Rust. The few that cannot be raw are not names of the language
/// (`syntax::keywords`).
pub fn ident(name: &str) -> Ident {
    let span = proc_macro2::Span::call_site();
    // syn takes `gen` for a name: it is a word since the edition of 2024.
    let plain = syn::parse_str::<Ident>(name).ok().filter(|_| name != "gen");
    plain.unwrap_or_else(|| Ident::new_raw(name, span))
}

/// The type as Rust, if the scan has seen all of it, and generated code can name it.
pub fn to_rust(ty: &Type, catalog: &Catalog) -> Option<TokenStream> {
    let all = |types: &[Type]| types.iter().map(|t| to_rust(t, catalog)).collect::<Option<Vec<_>>>();
    let with = |head: TokenStream, args: &[Type]| {
        let args = all(args)?;
        Some(if args.is_empty() { head } else { quote!(#head<#(#args),*>) })
    };
    match ty {
        Type::Primitive(name) => format!("::core::primitive::{name}").parse().ok(),
        Type::Named(name, args) => match name.as_str() {
            "Vec" => with(quote!(::std::vec::Vec), args),
            "String" => Some(quote!(::std::string::String)),
            "Box" => with(quote!(::std::boxed::Box), args),
            "Option" => with(quote!(::core::option::Option), args),
            _ if catalog.can_name(ty) => with(format!("::{name}").parse().ok()?, args),
            _ => None,
        },
        Type::Measured(number, _) => to_rust(number, catalog),
        Type::Alias(def, ..) => Some(path(catalog.path(*def)?)),
        Type::Def(def, _, args) => with(path(catalog.path(*def)?), args),
        Type::Array(element, Some(len)) => {
            let (element, len): (_, TokenStream) = (to_rust(element, catalog)?, len.parse().ok()?);
            Some(quote!([#element; #len]))
        }
        Type::Tuple(parts) => all(parts).map(|parts| quote!((#(#parts,)*))),
        Type::Unknown(text) if text.parse::<u64>().is_ok() => text.parse().ok(),
        Type::Array(_, None) | Type::Ref(_) | Type::Param(_) | Type::Unknown(_) => None,
    }
}

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

/// A constant as an expression of type `ty`.
pub fn constant(value: &Value, ty: &Type) -> TokenStream {
    match value {
        Value::Number(n) => match ty.measured_in() {
            Some(unit) => number(&n.in_unit(unit), ty),
            None => number(n, ty),
        },
        Value::Bool(b) => quote!(#b),
        Value::Unit => quote!(()),
        Value::Text(text) if matches!(ty, Type::Named(name, _) if name == "String") => {
            quote!(::std::string::String::from(#text))
        }
        Value::Text(text) => quote!(#text),
        Value::Duration(time) if ty.is_time() => {
            let nanos = nanos(*time);
            quote!(::apex_rt::Time::from_nanos(#nanos))
        }
        Value::Duration(time) => duration(*time),
        Value::Path(segments, _) => path(segments),
        Value::Struct(given) => {
            let (name, by_reference) = (path(&given.path), matches!(ty, Type::Ref(_)));
            let fields = given.fields.iter().map(|field| {
                let (name, value) = (ident(&field.name), constant(&field.value, &field.ty));
                quote!(#name: #value)
            });
            if by_reference { quote!(&#name { #(#fields),* }) } else { quote!(#name { #(#fields),* }) }
        }
        Value::List(items) => {
            let (element, by_reference) = match ty {
                Type::Ref(inner) => (inner.as_ref(), true),
                other => (other, false),
            };
            let unknown = Type::Unknown(String::new());
            let item_type = if let Type::Array(item, _) = element { item } else { &unknown };
            let items = items.iter().map(|item| constant(item, item_type));
            if by_reference { quote!(&[#(#items),*]) } else { quote!([#(#items),*]) }
        }
        Value::RustDefault => quote!(::core::default::Default::default()),
    }
}

fn number(n: &Number, ty: &Type) -> TokenStream {
    let is_integer = ty.is_integer() || !matches!(ty.name(), "f32" | "f64") && !n.is_float;
    let tokens = match n.integer() {
        Some(integer) if is_integer => Literal::i128_unsuffixed(integer.abs()),
        _ => Literal::f64_unsuffixed(n.value.abs()),
    };
    // A negative literal is an operator and a literal.
    if n.value < 0.0 { quote!(-#tokens) } else { quote!(#tokens) }
}

/// A duration as an expression.
pub fn duration(time: std::time::Duration) -> TokenStream {
    let nanos = Literal::u64_unsuffixed(u64::try_from(time.as_nanos()).unwrap_or(u64::MAX));
    quote!(::core::time::Duration::from_nanos(#nanos))
}

/// A time in nanoseconds, of which the runtime's clock counts as many as an `i64` has; what is longer never comes.
pub fn nanos(time: std::time::Duration) -> Literal {
    Literal::i64_unsuffixed(i64::try_from(time.as_nanos()).unwrap_or(i64::MAX))
}

/// `Some` of a value, or `None`.
pub fn option(value: Option<TokenStream>) -> TokenStream {
    value.map_or(quote!(None), |value| quote!(Some(#value)))
}
