//! The flat graph that is being built, and the body that is being expanded into it.

use super::{
    budget::{Budget, MAX_NODES},
    link::Link,
    names::{Constructor, GraphId, SourceSet},
    origins::Origins,
    scope::{RustNames, Scope as Names},
};
use crate::{
    catalog::{Catalog, Type},
    graph::{self, Claim, Graph, Node, NodeKind, Pin, Port, Scope, ScopeId, Value, Wire, WireEnd},
    index::IdVec,
    report::{Diagnostic, Diagnostics},
    source::Span,
    syntax::tree::{Endpoint, Expr, GraphItem, Ident, Instance, ParamItem, PathExpr, TypeExpr},
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

    /// Charges the budget for a node or a nested graph.
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

    /// Returns `true` if the budget is used up, or no more messages are kept: whatever follows would be lost.
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

    /// The parameters of graph `id`, with their types.
    pub fn param_types(&self, id: GraphId) -> Vec<(&'a ParamItem, Type)> {
        self.texts.graph(id).params.iter().map(|p| (p, self.ty(id, &p.ty))).collect()
    }

    /// A type as written in the source file of graph `id`.
    pub fn ty(&self, id: GraphId, ty: &TypeExpr) -> Type {
        let generics: Vec<String> = self.texts.graph(id).generics.iter().map(|g| g.text.clone()).collect();
        self.catalog.type_in_text(&self.texts.ty(ty), &generics)
    }

    /// The constructor that a path names.
    pub fn constructor(&mut self, path: &PathExpr) -> Result<Constructor, Option<Box<Diagnostic>>> {
        let (texts, catalog) = (self.texts, self.catalog);
        self.made.entry(path.span).or_insert_with(|| texts.made(path, catalog)).clone()
    }

    /// Builds a graph that remains a graph of its own.
    pub fn inner(&mut self, build: impl FnOnce(Builder<'_>) -> Option<Graph>) -> Option<Graph> {
        build(Builder::new(self.texts, self.catalog, self.diagnostics, self.open.clone(), self.budget))
    }
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
    /// A body whose parameters have these values.
    pub fn new(
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

/// Adds every `node.port` of an endpoint to `names`.
fn named_ports<'a>(end: &'a Endpoint, names: &mut BTreeSet<(&'a str, &'a str)>) {
    match end {
        Endpoint::Port(reference, _) => {
            if let [node, port] = reference.parts.as_slice() {
                names.insert((&node.text, &port.text));
            }
        }
        Endpoint::List(ends, _) => ends.iter().for_each(|e| named_ports(e, names)),
        Endpoint::All(_) | Endpoint::Instance(_) => {}
    }
}
