//! Construction of one flat graph: its body is resolved, and nested graphs are expanded in place.

use super::{
    Budget, MAX_NESTING, MAX_NODES,
    args::{self, Origins},
    connect::named_ports,
    flatten, generics,
    link::Link,
    names::{Constructor, GraphId, SourceSet},
    nodes::require_function_params,
    table::{Symbol, Table},
    value::{RustNames, Scope as Names},
};
use crate::{
    catalog::{Catalog, Type},
    graph::{self, Claim, Graph, Node, NodeKind, Pin, Port, PortId, Scope, ScopeId, Value, Wire, WireEnd},
    index::IdVec,
    report::{Diagnostic, Diagnostics},
    source::Span,
    syntax::tree::{Expr, GraphItem, Ident, Instance, Modifier, ModifierKind, NodeBody, PathExpr, PortKind, TypeExpr},
};
use std::collections::{BTreeMap, BTreeSet};

/// State of the construction of one flat graph.
pub struct Builder<'a> {
    pub texts: &'a SourceSet,
    pub catalog: &'a Catalog,
    pub diagnostics: &'a mut Diagnostics,
    pub nodes: IdVec<graph::NodeId, Node>,
    pub scopes: IdVec<ScopeId, Scope>,
    pub pins: Vec<Pin>,
    pub wires: Vec<Wire>,
    /// Inputs whose connection could not be made, which has been reported.
    pub suppressed: BTreeSet<WireEnd>,
    /// Declared ports for any number of inputs that have a connection.
    pub arrays: BTreeSet<WireEnd>,
    /// Unknown names of nodes or ports in each graph, which have been reported.
    pub unknown: BTreeSet<(GraphId, String)>,
    /// Constructors of the instances at each place of a text, which a graph that is used many times names many times.
    made: BTreeMap<Span, Result<Constructor, Option<Box<Diagnostic>>>>,
    /// The initial tokens of delays, as written.
    pub delays: Vec<(graph::NodeId, Expr)>,
    pub claims: Vec<Claim>,
    /// The graphs that are being expanded, outermost first.
    pub open: Vec<GraphId>,
    /// Instances with which a test replaces nodes, by path.
    pub replaced: BTreeMap<String, &'a Instance>,
    /// Remaining budget.
    pub budget: &'a mut Budget,
    /// List that receives the connections of the outermost graph, if they are wanted.
    pub links: Option<&'a mut Vec<Link>>,
}

/// Purpose for which a graph is expanded, with the arguments for its parameters.
pub enum Purpose {
    /// A program of its own. The parameters have their defaults.
    Program,
    /// The body of an `each`.
    Body(BTreeMap<String, Value>),
    /// A graph under test.
    Test(BTreeMap<String, Value>),
}

/// A graph body and the context in which it is expanded.
pub struct Body<'a> {
    pub id: GraphId,
    pub scope: ScopeId,
    pub values: BTreeMap<String, Value>,
    /// Origins of the values.
    pub origins: Origins,
    pub item: &'a GraphItem,
    /// All `node.port` to which a chain of the body leads.
    pub fed: BTreeSet<(&'a str, &'a str)>,
}

impl<'a> Body<'a> {
    fn new(
        id: GraphId,
        scope: ScopeId,
        (values, origins): (BTreeMap<String, Value>, Origins),
        item: &'a GraphItem,
    ) -> Self {
        let mut fed = BTreeSet::new();
        item.chains.iter().flat_map(|c| &c.ends[1..]).for_each(|end| named_ports(end, &mut fed));
        Self { id, scope, values, origins, item, fed }
    }
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
    /// An empty builder, to be used while the graphs `open` are being expanded.
    pub fn new(
        texts: &'a SourceSet,
        catalog: &'a Catalog,
        diagnostics: &'a mut Diagnostics,
        open: Vec<GraphId>,
        budget: &'a mut Budget,
    ) -> Self {
        Self {
            texts,
            catalog,
            diagnostics,
            nodes: IdVec::default(),
            scopes: IdVec::default(),
            pins: vec![],
            wires: vec![],
            suppressed: BTreeSet::new(),
            arrays: BTreeSet::new(),
            unknown: BTreeSet::new(),
            made: BTreeMap::new(),
            delays: vec![],
            claims: vec![],
            open,
            replaced: BTreeMap::new(),
            budget,
            links: None,
        }
    }

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
        let origins = args::origins(&item.params, &[], &Origins::new());
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
        super::wrap::let_activity_into_delays(&self.nodes, &mut self.wires);
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
            record: None,
        };
        generics::infer(&mut graph, self.catalog, self.diagnostics);
        super::given::fit(&mut graph, self.diagnostics);
        super::lists::resolve(&mut graph, self.diagnostics);
        super::wrap::fit_delays(&mut graph, &self.delays, self.diagnostics);
        // After a syntax error, the nodes that are to be recorded may be missing.
        if is_program && !self.texts.are_broken() {
            graph.record = super::record::record(&graph, item, self.diagnostics);
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

    /// Adds a node; `None` if there are too many.
    pub fn node(
        &mut self,
        name: &Ident,
        scope: ScopeId,
        kind: NodeKind,
        ports: Vec<Port>,
        docs: &str,
    ) -> Option<graph::NodeId> {
        self.spend(name.span)?;
        let node = Node {
            name: name.text.clone(),
            scope,
            kind,
            ports,
            modifiers: Default::default(),
            span: name.span,
            docs: docs.to_owned(),
            starts_active: false,
        };
        Some(self.nodes.push(node))
    }

    pub fn spend(&mut self, span: Span) -> Option<()> {
        if self.budget.nodes == 0 {
            self.too_large(span, format!("this program has more than {MAX_NODES} nodes"));
            return None;
        }
        self.budget.nodes -= 1;
        Some(())
    }

    /// Charges the budget for a visit to `count` ports or ends of connections.
    pub fn look(&mut self, count: usize, span: Span) -> Option<()> {
        if self.budget.looks < count {
            self.too_large(span, "this program has too many ports and connections".to_owned());
            return None;
        }
        self.budget.looks -= count;
        Some(())
    }

    fn too_large(&mut self, span: Span, message: String) {
        self.budget.exceeded = true;
        let outermost = self.open.first().map_or(span, |id| self.texts.graph(*id).name.span);
        self.diagnostics
            .push(Diagnostic::error("too-large", outermost, message).note("a nested graph counts once for each use"));
    }

    /// Returns `true` if there is no point in continuing.
    pub fn is_exhausted(&self) -> bool {
        self.budget.exceeded || self.diagnostics.is_full()
    }

    /// Meaning of the names in the expressions of a graph whose parameters have these values.
    pub fn names<'s>(&self, values: &'s BTreeMap<String, Value>) -> Names<'s>
    where
        'a: 's,
    {
        Names { params: values, rust: RustNames { texts: self.texts, catalog: self.catalog } }
    }

    fn param_types(&self, id: GraphId) -> Vec<(&'a crate::syntax::tree::ParamItem, Type)> {
        self.texts.graph(id).params.iter().map(|p| (p, self.ty(id, &p.ty))).collect()
    }

    /// A type as written in the source file of graph `id`.
    pub fn ty(&self, id: GraphId, ty: &TypeExpr) -> Type {
        let generics: Vec<String> = self.texts.graph(id).generics.iter().map(|g| g.text.clone()).collect();
        self.catalog.type_in_text(&self.texts.ty(ty), &generics)
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
    fn replace(&mut self, body: &Body<'_>, node: &crate::syntax::tree::NodeItem) -> Option<Symbol> {
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

    /// The constructor that a path names.
    pub fn constructor(&mut self, path: &PathExpr) -> Result<Constructor, Option<Box<Diagnostic>>> {
        let (texts, catalog) = (self.texts, self.catalog);
        self.made.entry(path.span).or_insert_with(|| texts.made(path, catalog)).clone()
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
        let origins = args::origins(&item.params, &instance.args, &body.origins);
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

    pub fn inner(&mut self, build: impl FnOnce(Builder<'_>) -> Option<Graph>) -> Option<Graph> {
        build(Builder::new(self.texts, self.catalog, self.diagnostics, self.open.clone(), self.budget))
    }
}

fn ports(places: &BTreeSet<WireEnd>) -> BTreeSet<PortId> {
    places.iter().filter_map(|p| if let WireEnd::Port(end) = p { Some(*end) } else { None }).collect()
}
