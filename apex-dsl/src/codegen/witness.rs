//! Questions that only rustc can answer, asked so that its message names the node, the port and the line of the text.
//!
//! Each question is a trait of its own with a message, and an `impl` for all types that have what is asked.
//! `do_not_recommend` keeps rustc from looking behind that `impl` for another message.

use super::generator::Generator;
use crate::{
    catalog::{Match, Signature, Trait, Type},
    check::compare_types,
    graph::{ConnectionId, Graph, Library, NodeId, NodeKind, PortId, TypeArg, Value},
    source::Span,
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::collections::BTreeMap;
use syn::Ident;

/// The message of rustc if the answer is no.
struct Message {
    text: String,
    /// Span in the source file.
    place: Span,
    note: Option<String>,
}

impl Generator<'_> {
    /// Returns `true` if rustc compares the types of a connection: the scan could not, and both ends can be named.
    fn is_compared_by_rustc(&self, graph: &Graph, connection: ConnectionId) -> bool {
        let c = &graph.connections[connection];
        let NodeKind::Library(library) = &graph.nodes[c.to.node].kind else { return false };
        library.types.is_empty() && graph.port(c.to).parameter.is_none() && compare_types(graph, c) == Match::Unknown
    }

    /// The trait that compares the types of a connection, if rustc has to.
    pub fn link(&self, graph: &Graph, connection: ConnectionId) -> Option<Ident> {
        let number = self.names.number;
        self.is_compared_by_rustc(graph, connection).then(|| format_ident!("Link{}Of{number}", connection.index()))
    }

    /// A token as `Option<&T>` becomes `Option<T>`.
    pub fn cloned(&self, graph: &Graph, end: PortId, token: &TokenStream) -> TokenStream {
        match self.copying(graph, end) {
            Some(name) => quote!(#token.map(#name::copied)),
            None => quote!(#token.cloned()),
        }
    }

    /// A token as `&T` becomes `T`.
    pub fn clone(&self, graph: &Graph, end: PortId, token: &TokenStream) -> TokenStream {
        let copy = self.copier(graph, end);
        quote!(#copy(#token))
    }

    /// The function that makes a `T` of a `&T` for the tokens of a port.
    pub fn copier(&self, graph: &Graph, end: PortId) -> TokenStream {
        match self.copying(graph, end) {
            Some(name) => quote!(#name::copied),
            None => quote!(::core::clone::Clone::clone),
        }
    }

    /// Keeps a copy of a token, which is an `Option<&T>`, in a place that is an `Option<T>`.
    pub fn store(&self, graph: &Graph, end: PortId, place: &TokenStream, token: &TokenStream) -> TokenStream {
        match self.copying(graph, end) {
            Some(name) => quote! { #name::store(&mut #place, #token); },
            None => quote! { ::apex_rt::store(&mut #place, #token); },
        }
    }

    /// The trait that copies tokens of a port, unless their type certainly has `Clone`.
    fn copying(&self, graph: &Graph, end: PortId) -> Option<Ident> {
        let end = graph.origin(end);
        let (number, node, port) = (self.names.number, end.node.index(), end.port);
        (!self.catalog.has_trait(&graph.port(end).ty, Trait::Clone))
            .then(|| format_ident!("Copy{node}Port{port}Of{number}"))
    }

    /// Makes a node from the values of its parameters.
    pub fn construct(&self, graph: &Graph, node: NodeId, library: &Library, params: &[TokenStream]) -> TokenStream {
        let ty = self.node_type(graph, library);
        match self.making(node, library) {
            Some(name) => quote!(<#ty as #name<_>>::made((#(#params,)*))),
            None if params.is_empty() => quote!(::apex_rt::construct(())),
            // With the type in sight, a list becomes what the parameter is declared as.
            None => quote!(<#ty as ::apex_rt::Construct<_>>::construct((#(#params,)*))),
        }
    }

    /// The trait that makes a node, unless all of its state certainly has a value to start with.
    fn making(&self, node: NodeId, library: &Library) -> Option<Ident> {
        let signature = &self.catalog.signatures[library.signature];
        let is_certain = signature.state.iter().all(|ty| self.catalog.has_trait(ty, Trait::Default));
        (!is_certain && !library.handed_in).then(|| format_ident!("Make{}Of{}", node.index(), self.names.number))
    }

    /// The token that a delay without a value holds at first.
    pub fn first_token(&self, graph: &Graph, delay: NodeId) -> TokenStream {
        match self.starting(graph, delay) {
            Some(name) => quote!(#name::first()),
            None => quote!(::core::default::Default::default()),
        }
    }

    /// The trait that makes the first token of a delay, unless its type certainly has `Default`.
    fn starting(&self, graph: &Graph, delay: NodeId) -> Option<Ident> {
        let from = graph.incoming(PortId { node: delay, port: 0 })?.from;
        (!self.catalog.has_trait(&graph.port(from).ty, Trait::Default))
            .then(|| format_ident!("First{}Of{}", delay.index(), self.names.number))
    }

    /// The value of a parameter. Its type is asked for where the compiler has not seen that it fits.
    pub fn argument(&self, graph: &Graph, node: NodeId, library: &Library, param: usize) -> TokenStream {
        let value = self.param_value(graph, library, param);
        let Some(name) = self.fitting(node, library, param) else { return value };
        let ty = self.node_type(graph, library);
        quote!(#name::<<#ty as ::apex_rt::Param<#param>>::Value>::fitting(#value))
    }

    /// The trait that compares the value of a parameter with its type, where the scan could not.
    fn fitting(&self, node: NodeId, library: &Library, param: usize) -> Option<Ident> {
        let is_open = matches!(library.params[param], Value::Path(..))
            || matches!(
                self.param_type(library, param),
                Type::Named(..) | Type::Def(..) | Type::Alias(..) | Type::Unknown(_)
            );
        let is_known = matches!(library.params[param], Value::RustDefault | Value::Text(_) | Value::Duration(_));
        (is_open && !is_known).then(|| format_ident!("Argument{}Param{param}Of{}", node.index(), self.names.number))
    }

    /// The traits of a graph, and a function that asks what no other code of the program does.
    pub fn witnesses(&self, graph: &Graph) -> TokenStream {
        let mut items = quote!();
        for connection in graph.connections.ids() {
            items.extend(self.link(graph, connection).map(|name| self.link_item(graph, connection, &name)));
        }
        let mut asked = quote!();
        for (node, n) in graph.nodes.iter_enumerated() {
            items.extend(self.copy_items(graph, node));
            match &n.kind {
                NodeKind::Library(library) => {
                    items.extend(self.library_items(graph, node, library));
                    asked.extend(self.asked_of(graph, node, library, &mut items));
                }
                NodeKind::Delay(initial) if initial.iter().any(Option::is_none) => {
                    items.extend(self.starting(graph, node).map(|name| self.first_item(graph, node, &name)));
                }
                NodeKind::Each(each) => items.extend(self.inside(graph, node).witnesses(&each.body)),
                _ => {}
            }
        }
        let function = format_ident!("asked_of_{}", self.names.number);
        let function = (!asked.is_empty()).then(|| quote! { fn #function() { #asked } });
        quote! { #items #function }
    }

    fn link_item(&self, graph: &Graph, connection: ConnectionId, name: &Ident) -> TokenStream {
        let c = &graph.connections[connection];
        let text =
            format!("`{}` sends `{{Self}}`, but `{}` takes `{{T}}`", graph.end_name(c.from), graph.end_name(c.to));
        self.witness(&quote!(passes), name, &Message { text, place: c.span, note: None })
    }

    fn first_item(&self, graph: &Graph, delay: NodeId, name: &Ident) -> TokenStream {
        let from = graph.incoming(PortId { node: delay, port: 0 }).map_or_else(String::new, |c| graph.end_name(c.from));
        let message = Message {
            text: format!("the delay of `{from}` needs a first token, and `{{Self}}` is not `Default`"),
            place: graph.nodes[delay].span,
            note: Some("derive `Default` for it, or give the delay a value: `delay crate::FIRST`".to_owned()),
        };
        self.witness(&quote!(starts), name, &message)
    }

    /// The traits that copy the tokens of a node.
    fn copy_items(&self, graph: &Graph, node: NodeId) -> TokenStream {
        let ports = (0..graph.nodes[node].ports.len()).map(|port| PortId { node, port });
        let copies = ports.filter(|end| graph.origin(*end) == *end).filter_map(|end| {
            let name = self.copying(graph, end)?;
            let connection = graph.connections.iter().find(|c| c.from == end)?;
            let message = Message {
                text: format!("the tokens of `{}` are copied, and `{{Self}}` is not `Clone`", graph.end_name(end)),
                place: connection.span,
                note: Some(
                    "a token is copied where it is kept: for a `delay`, an event, a slot, an output of the graph, a test or another thread"
                        .to_owned(),
                ),
            };
            Some(self.witness(&quote!(copies), &name, &message))
        });
        quote! { #(#copies)* }
    }

    /// The traits through which the parameters of a node go, and the one by which it is made.
    fn library_items(&self, graph: &Graph, node: NodeId, library: &Library) -> TokenStream {
        let (n, signature) = (&graph.nodes[node], &self.catalog.signatures[library.signature]);
        let make = self.making(node, library).map(|name| {
            let message = Message {
                text: format!(
                    "`{}` cannot be made by the graph: state of `{{Self}}` is not `Default`",
                    graph.path(node)
                ),
                place: n.span,
                note: Some(format!(
                    "derive `Default` for it, or make the node in Rust: `node {}: {};`",
                    n.name, signature.name
                )),
            };
            self.witness(&quote!(makes), &name, &message)
        });
        let arguments = (0..library.params.len()).filter_map(|param| {
            let (name, declared) = (self.fitting(node, library, param)?, &signature.params[param].name);
            let text = format!("`{declared}` of `{}` takes `{{T}}`, not `{{Self}}`", graph.path(node));
            Some(self.witness(&quote!(fits), &name, &Message { text, place: n.span, note: None }))
        });
        quote! { #make #(#arguments)* }
    }

    /// Bounds of a generic node, and what goes with a node or its tokens to another thread.
    fn asked_of(&self, graph: &Graph, node: NodeId, library: &Library, items: &mut TokenStream) -> TokenStream {
        let (n, signature) = (&graph.nodes[node], &self.catalog.signatures[library.signature]);
        let (number, path, ty) = (self.names.number, graph.path(node), self.node_type(graph, library));
        let mut asked = quote!();
        let is_open = is_whole(library) && !self.bounds_hold(library, signature);
        if let Some(bound) = port_trait(signature).filter(|_| is_open) {
            let name = format_ident!("Bounds{}Of{number}", node.index());
            let text = format!("`{path}` is `{{Self}}`, which does not have what `{}` asks for", signature.name);
            let note = format!("`{}` needs {}", signature.name, list(&signature.bounds));
            items.extend(self.question(&name, &bound, &Message { text, place: n.span, note: Some(note) }));
            asked.extend(ask(&name, &ty));
        }
        if !self.parts.is_empty() && self.outer.is_none() {
            let send = quote!(::core::marker::Send);
            if !signature.is_function && !signature.state.iter().all(|ty| self.catalog.has_trait(ty, Trait::Send)) {
                let name = format_ident!("Move{}Of{number}", node.index());
                let text = format!("`{path}` runs on a thread, and `{{Self}}` is not `Send`");
                items.extend(self.question(&name, &send, &Message { text, place: n.span, note: None }));
                asked.extend(ask(&name, &ty));
            }
        }
        asked
    }

    /// Returns `true` if the type arguments of a node certainly have what its bounds ask for.
    fn bounds_hold(&self, library: &Library, signature: &Signature) -> bool {
        signature.bounds().all(|(param, mut traits)| {
            let place = signature.generics.iter().position(|name| name == param);
            let Some(TypeArg::Known(ty) | TypeArg::Verbatim(ty, _)) = place.and_then(|place| library.types.get(place))
            else {
                return false;
            };
            traits.all(|name| Trait::named(name).is_some_and(|wanted| self.catalog.has_trait(ty, wanted)))
        })
    }

    /// Asks whether the tokens between thread groups can be moved from one thread to another.
    pub fn moved_tokens(&self, graph: &Graph) -> TokenStream {
        let (mut items, mut asked) = (quote!(), quote!());
        for (number, from) in self.cells.iter().map(|cell| cell.from).enumerate() {
            if self.catalog.has_trait(&graph.port(from).ty, Trait::Send) {
                continue;
            }
            let Some(connection) = graph.connections.iter().find(|c| c.from == from) else { continue };
            let name = format_ident!("MoveOfCell{number}");
            let text = format!("`{}` goes to another thread, and `{{Self}}` is not `Send`", graph.end_name(from));
            let send = quote!(::core::marker::Send);
            items.extend(self.question(&name, &send, &Message { text, place: connection.span, note: None }));
            asked.extend(ask(&name, &self.token_type(graph, from)));
        }
        let function = (!asked.is_empty()).then(|| quote! { fn asked_of_cells() { #asked } });
        quote! { #items #function }
    }

    /// Asks whether the tokens that the `record` statement of the program names can be recorded.
    pub fn recorded_tokens(&self, graph: &Graph) -> TokenStream {
        let (Some(_), Some(record)) = (self.channels, &graph.record) else { return quote!() };
        let ends = record.ports.iter().copied().filter(|end| !matches!(graph.port(*end).ty, Type::Primitive(_)));
        let mut of_types: BTreeMap<String, (TokenStream, &Type, Vec<String>)> = BTreeMap::new();
        for end in ends {
            let ty = self.token_type(graph, end);
            let (.., names) = of_types.entry(ty.to_string()).or_insert_with(|| (ty, &graph.port(end).ty, vec![]));
            names.push(graph.end_name(end));
        }
        let (mut items, mut asked) = (quote!(), quote!());
        for (number, (ty, written, names)) in of_types.values().enumerate() {
            let name = format_ident!("Recorded{number}");
            let message = self.message(&Message {
                text: format!("{} cannot be recorded: `{written}` is neither read and written by serde nor a message", list(names)),
                place: record.span,
                note: Some(
                    "derive `serde::Serialize` and `serde::Deserialize` for it, or implement `apex_rt::record::Message`"
                        .to_owned(),
                ),
            });
            items.extend(quote! { #message trait #name {} impl #name for ::apex_rt::record::Recordable {} });
            asked.extend(quote! {{ fn is<T: #name>(_: T) {} is(::apex_rt::__kind!(#ty, is_recordable)); }});
        }
        let function = (!asked.is_empty()).then(|| quote! { fn asked_of_recording() { #asked } });
        quote! { #items #function }
    }

    /// A trait without methods for all types that have `bound`.
    fn question(&self, name: &Ident, bound: &TokenStream, message: &Message) -> TokenStream {
        self.witness(&quote!(has #bound,), name, message)
    }

    /// A trait of some kind.
    fn witness(&self, kind: &TokenStream, name: &Ident, message: &Message) -> TokenStream {
        let (message, silent) = (self.message(message), self.silent());
        quote! { ::apex_rt::witness! { #kind #message #name #silent } }
    }

    fn message(&self, Message { text, place, note }: &Message) -> TokenStream {
        if self.catalog.lacks_prelude() {
            return quote!();
        }
        let label = format!("--> {}", self.position(*place));
        let note = note.iter();
        quote! { #[diagnostic::on_unimplemented(message = #text, label = #label #(, note = #note)*)] }
    }

    /// Keeps rustc from looking behind an `impl` for another message.
    fn silent(&self) -> Option<TokenStream> {
        (!self.catalog.lacks_prelude()).then(|| quote!(#[diagnostic::do_not_recommend]))
    }

    /// Name of the source file and line of a place in it: `mission.afg:17`.
    pub fn line(&self, span: Span) -> String {
        let (line, _) = self.sources.line_column(span.file, span.start);
        let path = &self.sources.get(span.file).path;
        format!("{}:{line}", path.file_name().unwrap_or(path.as_os_str()).to_string_lossy())
    }

    /// Position of a piece of text: `robots/mission.afg:17:10`.
    pub fn position(&self, span: Span) -> String {
        let (line, column) = self.sources.line_column(span.file, span.start);
        format!("{}:{line}:{column}", self.sources.get(span.file).path.display())
    }
}

/// Code that asks for a trait of a type.
fn ask(name: &Ident, ty: &TokenStream) -> TokenStream {
    quote! {{ fn has<T: #name>() {} has::<#ty>(); }}
}

/// A trait that a node type has as soon as its bounds hold.
fn port_trait(signature: &Signature) -> Option<TokenStream> {
    let port = signature.ports.iter().find(|port| port.field.is_none())?;
    let index = port.index;
    Some(match port.kind {
        PortKind::Input => quote!(::apex_rt::Input<#index>),
        PortKind::Output => quote!(::apex_rt::Output<#index>),
        PortKind::Slot => quote!(::apex_rt::Slot<#index>),
        PortKind::Event => quote!(::apex_rt::Trigger<#index>),
    })
}

/// Returns `true` if all type arguments are known.
fn is_whole(library: &Library) -> bool {
    !library.types.iter().any(|ty| matches!(ty, TypeArg::Open))
}

/// `` `T: Add`, `U: Copy` ``
fn list(names: &[String]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
