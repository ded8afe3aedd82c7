//! Variants: `robot Simulated = Real { … }` has the statements of `Real`, with some nodes exchanged, and its own.

use super::{
    MAX_NESTING,
    names::{Constructor, GraphId, SourceSet},
};
use crate::{
    catalog::Catalog,
    report::{Diagnostic, Diagnostics},
    source::Span,
    syntax::tree::{GraphItem, PathExpr},
};
use std::collections::BTreeMap;

/// Largest number of statements of all variants together.
const MAX_STATEMENTS: usize = 500_000;

/// A variant of a graph.
#[derive(Debug)]
pub struct Variant {
    /// The graph that it is a variant of; `None` if there is none, which has been reported.
    pub base: Option<GraphId>,
    /// All of its statements: those of the base, then its own. Each keeps its place, which may be in another source
    /// file, where its names have their meaning.
    pub item: GraphItem,
    /// The nodes of the base that are exchanged, with the places of their names in the variant.
    pub exchanged: BTreeMap<String, Span>,
    /// Number of variants from the first base to this one.
    depth: usize,
}

/// All variants in the source files.
pub fn variants(texts: &SourceSet, catalog: &Catalog, diagnostics: &mut Diagnostics) -> BTreeMap<GraphId, Variant> {
    let mut finder = Finder { texts, catalog, diagnostics, found: BTreeMap::new(), statements: 0, is_full: false };
    for (file, (_, tree)) in texts.files.iter().enumerate() {
        for graph in 0..tree.graphs.len() {
            finder.find(GraphId { file, graph }, &mut vec![]);
        }
    }
    finder.found
}

struct Finder<'a> {
    texts: &'a SourceSet,
    catalog: &'a Catalog,
    diagnostics: &'a mut Diagnostics,
    found: BTreeMap<GraphId, Variant>,
    /// Number of statements in `found`.
    statements: usize,
    /// `true` if they are too many, which has been reported.
    is_full: bool,
}

impl Finder<'_> {
    /// Finds `id` if it is a variant. `open` are the variants that are being looked at, each a variant of the next.
    fn find(&mut self, id: GraphId, open: &mut Vec<GraphId>) {
        let own = self.texts.written(id);
        let Some(path) = own.base.as_ref().filter(|_| !self.found.contains_key(&id)) else { return };
        open.push(id);
        let base = self.base(path, open);
        if let Some(base) = base {
            self.find(base, open);
        }
        open.pop();
        let base = base.filter(|base| !self.is_too_deep(*base, path) && self.has_room(*base, own));
        let variant = match base {
            Some(base) => self.merged(base, own),
            None => alone(own),
        };
        self.statements += count(&variant.item);
        self.found.insert(id, variant);
    }

    fn item(&self, id: GraphId) -> &GraphItem {
        self.found.get(&id).map_or_else(|| self.texts.written(id), |variant| &variant.item)
    }

    fn merged(&self, base: GraphId, own: &GraphItem) -> Variant {
        let of = self.found.get(&base);
        let exchanged = of.map(|variant| variant.exchanged.clone()).unwrap_or_default();
        let depth = of.map_or(0, |variant| variant.depth) + 1;
        Variant { depth, ..merged(base, self.item(base), exchanged, own) }
    }

    fn base(&mut self, path: &PathExpr, open: &[GraphId]) -> Option<GraphId> {
        let error = |code, message| Diagnostic::error(code, path.span, message);
        let name = path.text();
        let problem = match self.texts.made(path, self.catalog) {
            Ok(Constructor::Graph(base)) if open.contains(&base) => {
                error("recursion", format!("`{name}` would be a variant of itself"))
            }
            Ok(Constructor::Graph(_)) if open.len() > MAX_NESTING => too_deep(path),
            Ok(Constructor::Graph(base)) => return Some(base),
            Ok(Constructor::Node(_)) => {
                error("unknown-graph", format!("`{name}` is a node, but only a graph can have variants"))
            }
            Err(problem) => *problem?,
        };
        self.diagnostics.push(problem);
        None
    }

    fn is_too_deep(&mut self, base: GraphId, path: &PathExpr) -> bool {
        let is_it = self.found.get(&base).is_some_and(|variant| variant.depth >= MAX_NESTING);
        if is_it {
            self.diagnostics.push(too_deep(path));
        }
        is_it
    }

    fn has_room(&mut self, base: GraphId, own: &GraphItem) -> bool {
        let fits = self.statements + count(self.item(base)) + count(own) <= MAX_STATEMENTS;
        if !fits && !std::mem::replace(&mut self.is_full, true) {
            let message = format!("the variants have more than {MAX_STATEMENTS} statements together");
            self.diagnostics.push(Diagnostic::error("too-large", own.name.span, message));
        }
        fits
    }
}

fn too_deep(path: &PathExpr) -> Diagnostic {
    let message = format!("`{}` is a variant of more than {MAX_NESTING} others", path.text());
    Diagnostic::error("too-deep", path.span, message)
}

fn count(item: &GraphItem) -> usize {
    item.params.len() + item.ports.len() + item.nodes.len() + item.chains.len() + item.claims.len()
}

/// A variant whose base is not known. Its connections may need nodes of the base.
fn alone(own: &GraphItem) -> Variant {
    let item = GraphItem { chains: vec![], claims: vec![], records: vec![], ..own.clone() };
    Variant { base: None, item, exchanged: BTreeMap::new(), depth: 0 }
}

fn merged(id: GraphId, base: &GraphItem, mut exchanged: BTreeMap<String, Span>, own: &GraphItem) -> Variant {
    let mut nodes = base.nodes.clone();
    for node in &own.nodes {
        match nodes[..base.nodes.len()].iter_mut().find(|other| other.name.text == node.name.text) {
            Some(other) => {
                exchanged.insert(node.name.text.clone(), node.name.span);
                *other = node.clone();
            }
            None => nodes.push(node.clone()),
        }
    }
    let mut params = base.params.clone();
    for param in &own.params {
        match params[..base.params.len()].iter_mut().find(|other| other.name.text == param.name.text) {
            Some(other) => *other = param.clone(),
            None => params.push(param.clone()),
        }
    }
    let item = GraphItem {
        docs: if own.docs.is_empty() { base.docs.clone() } else { own.docs.clone() },
        generics: [&*base.generics, &*own.generics].concat(),
        params,
        ports: [&*base.ports, &*own.ports].concat(),
        nodes,
        chains: [&*base.chains, &*own.chains].concat(),
        claims: [&*base.claims, &*own.claims].concat(),
        threads: [&*base.threads, &*own.threads].concat(),
        records: if own.records.is_empty() { base.records.clone() } else { own.records.clone() },
        ..own.clone()
    };
    Variant { base: Some(id), item, exchanged, depth: 1 }
}
