//! Variants: `robot Simulated = Real { … }` has the statements of `Real`, with some nodes exchanged, and its own.

use super::{
    budget::MAX_NESTING,
    names::{Constructor, GraphId, SourceSet, Variant},
};
use crate::{
    catalog::Catalog,
    report::{Diagnostic, Diagnostics},
    source::Span,
    syntax::tree::{GraphItem, Ident, PathExpr},
};
use std::collections::BTreeMap;

/// Largest number of statements of all variants together.
const MAX_STATEMENTS: usize = 500_000;

/// All variants in the source files.
pub fn variants(texts: &SourceSet, catalog: &Catalog, diagnostics: &mut Diagnostics) -> BTreeMap<GraphId, Variant> {
    let mut finder = Finder { texts, catalog, diagnostics, found: BTreeMap::new(), statements: 0, is_full: false };
    for id in (0..texts.files.len()).flat_map(|file| texts.graph_ids(file)) {
        finder.find(id, &mut vec![]);
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

    /// The variant `own` of `base`. What its base has exchanged is exchanged in it, too.
    fn merged(&self, base: GraphId, own: &GraphItem) -> Variant {
        let mut variant = merged(base, self.item(base), own);
        for (name, span) in self.found.get(&base).iter().flat_map(|base| &base.exchanged) {
            variant.exchanged.entry(name.clone()).or_insert(*span);
        }
        variant
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
        let bases = std::iter::successors(Some(base), |id| self.found.get(id)?.base);
        let is_it = bases.count() > MAX_NESTING;
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
    Variant { base: None, item, exchanged: BTreeMap::new() }
}

/// A variant with the statements of its base and its own ones.
fn merged(id: GraphId, base: &GraphItem, own: &GraphItem) -> Variant {
    let (nodes, exchanged) = exchange(&base.nodes, &own.nodes, |node| &node.name);
    let (params, _) = exchange(&base.params, &own.params, |param| &param.name);
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
    Variant { base: Some(id), item, exchanged }
}

/// The declarations of a base, of which those that a variant declares again are exchanged, then the other ones of the
/// variant. Also returns the names that are exchanged. A second declaration of such a name is another one.
fn exchange<T: Clone>(base: &[T], own: &[T], name: fn(&T) -> &Ident) -> (Vec<T>, BTreeMap<String, Span>) {
    let (mut all, mut exchanged) = (base.to_vec(), BTreeMap::new());
    let mut places: BTreeMap<&str, usize> =
        base.iter().enumerate().rev().map(|(place, declared)| (name(declared).text.as_str(), place)).collect();
    for declared in own {
        let Ident { text, span } = name(declared);
        match places.remove(text.as_str()) {
            Some(place) => {
                all[place] = declared.clone();
                exchanged.insert(text.clone(), *span);
            }
            None => all.push(declared.clone()),
        }
    }
    (all, exchanged)
}
