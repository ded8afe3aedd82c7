//! Construction of one flat graph: its body is resolved, and nested graphs are expanded in place.

use super::{
    args,
    budget::{Budget, MAX_NESTING},
    builder::{Body, Builder},
    flatten, generics, given,
    link::Link,
    lists,
    names::{Constructor, GraphId, SourceSet},
    nodes::require_function_params,
    origins::{self, Origins},
    record::record,
    scope::RustNames,
    table::{Symbol, Table},
    wrap,
};
use crate::{
    catalog::{Catalog, Type},
    graph::{self, Graph, NodeKind, Pin, Port, PortId, Scope, ScopeId, Value, WireEnd},
    report::{Diagnostic, Diagnostics},
    source::Span,
    syntax::tree::{GraphItem, Ident, Instance, Modifier, ModifierKind, NodeBody, NodeItem, PortKind},
};
use std::collections::{BTreeMap, BTreeSet};

/// Purpose for which a graph is expanded, with the arguments for its parameters.
pub enum Purpose {
    /// A program of its own. The parameters have their defaults.
    Program,
    /// The body of an `each`.
    Body(BTreeMap<String, Value>),
    /// A graph under test.
    Test(BTreeMap<String, Value>),
}

/// Resolves graph `id` as a program of its own.
pub fn graph(
    texts: &SourceSet,
    catalog: &Catalog,
    id: GraphId,
    budget: &mut Budget,
    links: &mut Vec<Link>,
    diagnostics: &mut Diagnostics,
) -> Option<Graph> {
    let mut builder = Builder::new(texts, catalog, diagnostics, vec![], budget);
    builder.links = Some(links);
    builder.top(id, Purpose::Program)
}

impl<'a> Builder<'a> {
    /// Builds the whole graph, with boundary nodes for its ports.
    pub fn top(mut self, id: GraphId, purpose: Purpose) -> Option<Graph> {
        let item = self.texts.graph(id);
        let is_program = matches!(purpose, Purpose::Program);
        let (given, is_body) = match purpose {
            Purpose::Program => (None, false),
            Purpose::Body(values) => (Some(values), true),
            Purpose::Test(values) => (Some(values), false),
        };
        let needs_more = item.params.iter().any(|p| p.default.is_none()) || !item.generics.is_empty();
        let is_open = given.is_none() && needs_more;
        self.check_complete(item);
        let values = given.unwrap_or_else(|| {
            let params = self.param_types(id);
            let rust = RustNames { texts: self.texts, catalog: self.catalog };
            args::of_graph(&item.name, &params, None, rust, item.name.span, self.diagnostics)
        });
        self.scopes.push(Scope::top(&item.name.text, item.name.span));
        let mut table = Table::new();
        for port in &item.ports {
            let ty = port.ty.as_ref().map_or_else(Type::unit, |t| self.ty(id, t));
            // Seen from inside, an input of the graph sends.
            let kind = port.kind.seen_from_inside();
            let (docs, frame) = (port.docs.clone(), port.frame.clone());
            let inner = Port { docs, frame, ..Port::new(&port.name.text, kind, ty) };
            let node = self.node(&port.name, ScopeId::TOP, NodeKind::Boundary(port.kind), vec![inner], &port.docs)?;
            table.insert(
                &port.name,
                Symbol::port(
                    WireEnd::Port(PortId { node, port: 0 }),
                    kind,
                    &self.nodes[node].ports[0].ty,
                    &port.name.text,
                ),
                self.diagnostics,
            );
        }
        let origins = origins::origins(&item.params, &[], &Origins::new(), &self.names(&values));
        self.body(&Body::new(id, ScopeId::TOP, (values.clone(), origins), item), table);
        let (name, docs, robot, span) = (item.name.text.clone(), item.docs.clone(), item.robot, item.name.span);
        if robot && let Some(port) = item.ports.first() {
            let message = "a `robot` cannot have ports: there is nothing outside that they could be connected to";
            self.diagnostics.push(
                Diagnostic::error("robot-port", port.name.span, message)
                    .note("replace it by a node that is a driver, or write `graph` instead of `robot`"),
            );
        }
        let threads = self.threads(&values, item);
        if self.budget.exceeded {
            return None;
        }
        wrap::let_activity_into_delays(&self.nodes, &mut self.wires);
        let (connections, open_pins) = flatten::wires(&mut self);
        let mut graph = Graph {
            name,
            docs,
            robot,
            is_open,
            is_body,
            span,
            nodes: self.nodes,
            connections,
            scopes: self.scopes,
            pins: self.pins,
            wires: self.wires,
            claims: self.claims,
            threads,
            open_pins,
            suppressed: ports(&self.suppressed),
            paced: BTreeMap::new(),
            record: None,
        };
        generics::infer(&mut graph, self.catalog, self.diagnostics);
        given::fit(&mut graph, self.diagnostics);
        lists::resolve(&mut graph, self.diagnostics);
        wrap::fit_delays(&mut graph, &self.delays, self.diagnostics);
        // After a syntax error, the nodes that are to be recorded may be missing.
        if is_program && !self.texts.are_broken() {
            graph.record = record(&graph, item, self.diagnostics);
        }
        require_function_params(&mut graph, self.catalog);
        Some(graph)
    }

    /// Reports what keeps a `robot` or `pub graph` from being a program of its own.
    fn check_complete(&mut self, item: &GraphItem) {
        if !item.robot && !item.is_public {
            return;
        }
        let word = item.word();
        for param in item.params.iter().filter(|p| p.default.is_none()) {
            let message = format!(
                "`{}` needs a value for `{}`: every parameter of a `{word}` needs a default",
                item.name.text, param.name.text
            );
            let error = Diagnostic::error("missing-argument", param.name.span, message);
            self.diagnostics.push(error.note("write a default: `name: type = value`"));
        }
        if let Some(generic) = item.generics.first() {
            let message = format!(
                "`{}` has the type parameter `{}`, but the types of a `{word}` are known",
                item.name.text, generic.text
            );
            let error = Diagnostic::error("type-arguments", generic.span, message);
            self.diagnostics.push(error.note("write a graph around it, with ports that have types"));
        }
    }

    /// Expands a graph body: first its nodes, then its connections.
    fn body(&mut self, body: &Body<'_>, mut table: Table) {
        self.open.push(body.id);
        let first = (self.nodes.len(), self.scopes.len());
        for node in &body.item.nodes {
            let made = match &node.body {
                _ if self.replaced.contains_key(&graph::path(&self.scopes, body.scope, Some(&node.name.text))) => {
                    self.replace(body, node)
                }
                NodeBody::Instance(instance) => self.instance(body, &node.name, instance, &node.docs),
                NodeBody::HandedIn(ty, modifiers) => self.handed_in(body, &node.name, ty, modifiers, &node.docs),
            };
            // A node that cannot be made keeps its name, so that its uses are not reported as well.
            table.insert(&node.name, made.unwrap_or(Symbol::Broken), self.diagnostics);
            if self.is_exhausted() {
                break;
            }
        }
        if !self.is_exhausted() {
            self.chains(body, &table);
        }
        if !self.is_exhausted() {
            self.resolve_claims(body, &table, first);
        }
        self.open.pop();
    }

    /// The instance with which a test replaces a node. Names in it belong to the first source file.
    fn replace(&mut self, body: &Body<'_>, node: &NodeItem) -> Option<Symbol> {
        let path = graph::path(&self.scopes, body.scope, Some(&node.name.text));
        let instance = *self.replaced.get(&path)?;
        let fed = body.fed.clone();
        let inside = Body { values: BTreeMap::new(), origins: Origins::new(), fed, ..*body };
        self.instance(&inside, &node.name, instance, &node.docs)
    }

    /// An instance of a node or graph.
    pub fn instance(&mut self, body: &Body<'_>, name: &Ident, instance: &Instance, docs: &str) -> Option<Symbol> {
        let made = match self.constructor(&instance.path) {
            Ok(made) => made,
            Err(error) => {
                error.into_iter().for_each(|error| self.diagnostics.push(*error));
                return None;
            }
        };
        let each = instance.modifiers.iter().find_map(|m| match &m.kind {
            ModifierKind::Each { parallel, port } => Some((*parallel, port.as_ref(), m.span)),
            _ => None,
        });
        let symbol = match (made, each) {
            (Constructor::Node(signature), None) => self.library(body, name, signature, instance, docs)?,
            (Constructor::Graph(id), None) => self.nested(body, name, id, instance, docs)?,
            (Constructor::Node(signature), Some(each)) => {
                let inner = self.each_of_node(body, name, signature, instance)?;
                self.each(body, name, inner, each, instance, docs)?
            }
            (Constructor::Graph(id), Some(each)) => {
                let values = self.graph_args(body, id, instance);
                self.diagnostics.enter(&name.text);
                let inner = self.nested_program(id, instance.span, |builder| builder.top(id, Purpose::Body(values)));
                self.diagnostics.leave();
                let inner = inner?;
                self.each(body, name, inner, each, instance, docs)?
            }
        };
        self.delayed(body, name, symbol, &instance.modifiers)
    }

    fn graph_args(&mut self, body: &Body<'_>, id: GraphId, instance: &Instance) -> BTreeMap<String, Value> {
        let params = self.param_types(id);
        let scope = self.names(&body.values);
        let item = self.texts.graph(id);
        let is_port = |name: &str| item.ports.iter().any(|port| port.name.text == name && !port.kind.sends());
        args::of_graph_inside(
            (&item.name, &is_port),
            &params,
            Some((&instance.args, &scope)),
            scope.rust,
            &body.origins,
            instance.span,
            self.diagnostics,
        )
    }

    fn nested(
        &mut self,
        body: &Body<'_>,
        name: &Ident,
        id: GraphId,
        instance: &Instance,
        docs: &str,
    ) -> Option<Symbol> {
        self.may_open(id, instance.span)?;
        self.spend(name.span)?;
        for modifier in &instance.modifiers {
            let word = match modifier.kind {
                ModifierKind::Every(_) => "every",
                ModifierKind::After(_) => "after",
                ModifierKind::Timeout(_) => "timeout",
                ModifierKind::Deadline(_) => "deadline",
                ModifierKind::Pipelined => "pipelined",
                ModifierKind::Skip => "skip",
                ModifierKind::Essential => "essential",
                ModifierKind::Restart => "restart",
                ModifierKind::Each { .. } | ModifierKind::Delay(_) | ModifierKind::On(_) => continue,
            };
            let message = format!("`{word}` applies to a single node, but `{}` is a graph", instance.path.text());
            self.diagnostics.push(
                Diagnostic::error("wrong-modifier", modifier.span, message).note(
                    "a nested graph accepts `each`, `delay` and `on`; write other modifiers after a node inside it",
                ),
            );
        }
        let values = self.graph_args(body, id, instance);
        let item = self.texts.graph(id);
        self.look(item.ports.len() + item.params.len() + item.claims.len(), name.span)?;
        let given: Vec<String> = instance.args.iter().filter_map(|a| Some(a.name.as_ref()?.text.clone())).collect();
        let scope = self.scopes.push(Scope {
            name: name.text.clone(),
            graph: item.name.text.clone(),
            parent: body.scope,
            group: instance.modifiers.iter().find_map(Modifier::group),
            args: given.iter().filter_map(|name| Some((name.clone(), values.get(name)?.clone()))).collect(),
            docs: if docs.is_empty() { item.docs.clone() } else { docs.to_owned() },
            span: name.span,
        });
        let mut inside = Table::new();
        let mut symbol: Vec<(String, PortKind, Type, WireEnd)> = vec![];
        for port in &item.ports {
            let ty = port.ty.as_ref().map_or_else(Type::unit, |t| self.ty(id, t));
            let (name, docs) = (port.name.text.clone(), port.docs.clone());
            let (kind, frame, span) = (port.kind, port.frame.clone(), port.name.span);
            self.pins.push(Pin { name, kind, ty: ty.clone(), frame, scope, span, docs, standard: false });
            let place = WireEnd::Pin(self.pins.len() - 1);
            // Seen from inside, a port that takes tokens outside sends them.
            let inner = port.kind.seen_from_inside();
            inside.insert(&port.name, Symbol::port(place, inner, &ty, &port.name.text), self.diagnostics);
            // A second declaration of a port has been reported.
            if symbol.iter().all(|(name, ..)| *name != port.name.text) {
                symbol.push((port.name.text.clone(), port.kind, ty, place));
            }
        }
        let origins = origins::origins(&item.params, &instance.args, &body.origins, &self.names(&values));
        self.diagnostics.enter(&name.text);
        self.body(&Body::new(id, scope, (values, origins), item), inside);
        self.diagnostics.leave();
        Some(Symbol::of_graph(scope, symbol))
    }

    fn may_open(&mut self, id: GraphId, span: Span) -> Option<()> {
        let name = &self.texts.graph(id).name;
        if let Some(at) = self.open.iter().position(|open| *open == id) {
            let path: Vec<String> =
                self.open[at..].iter().chain([&id]).map(|g| format!("`{}`", self.texts.graph(*g).name.text)).collect();
            let message = format!("`{}` contains itself: {}", name.text, path.join(" → "));
            let error = Diagnostic::error("recursion", span, message)
                .also(name.span, "this graph")
                .note("nested graphs are expanded in place, which would never end here; send a token back through a slot instead");
            self.diagnostics.push(error);
            return None;
        }
        if self.open.len() >= MAX_NESTING {
            let message = format!("graphs are nested more than {MAX_NESTING} levels deep");
            self.diagnostics.push(Diagnostic::error("too-deep", span, message));
            return None;
        }
        Some(())
    }

    /// Builds a graph that remains a graph of its own: the body of an `each`.
    fn nested_program(
        &mut self,
        id: GraphId,
        span: Span,
        build: impl FnOnce(Builder<'_>) -> Option<Graph>,
    ) -> Option<Graph> {
        self.may_open(id, span)?;
        self.inner(build)
    }
}

fn ports(places: &BTreeSet<WireEnd>) -> BTreeSet<PortId> {
    places.iter().filter_map(|p| if let WireEnd::Port(end) = p { Some(*end) } else { None }).collect()
}
