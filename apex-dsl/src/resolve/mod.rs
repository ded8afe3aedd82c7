//! Trees and signatures → one flat graph: names, imports, arguments, default ports, nested graphs.

mod args;
mod connect;
mod flatten;
mod generics;
mod instance;
mod names;
mod value;

use crate::{
    catalog::Catalog,
    graph::Graph,
    report::{Diagnostic, Diagnostics},
    source::{FileId, Sources, World},
};

pub use names::{GraphId, Texts};

/// Most nodes, nested graphs and connections that one program may have, each.
pub const MAX_NODES: usize = 50_000;
/// How deep graphs nest in each other.
pub const MAX_NESTING: usize = 64;

/// What the texts of a program resolve to.
pub struct Resolved {
    /// The texts.
    pub texts: Texts,
    /// The graphs that are not used inside another one of the first text: the programs in it.
    pub graphs: Vec<Graph>,
}

/// Resolves the text `root` with everything that it imports.
pub fn resolve(
    root: FileId,
    catalog: &Catalog,
    sources: &mut Sources,
    world: &mut dyn World,
    diagnostics: &mut Diagnostics,
) -> Resolved {
    let texts = Texts::load(root, catalog, sources, world, diagnostics);
    let broken = texts.files.iter().any(|(_, file)| file.broken);
    let mut graphs = vec![];
    let mut budget = MAX_NODES;
    for graph in 0..texts.files[0].1.graphs.len() {
        let id = GraphId { file: 0, graph };
        let nested = is_nested(&texts, id);
        // Without values for its parameters it can only be checked where it is used.
        if nested && texts.graph(id).params.iter().any(|p| p.default.is_none()) {
            continue;
        }
        let resolved = instance::graph(&texts, catalog, id, &mut budget, diagnostics);
        if !nested {
            graphs.extend(resolved);
        }
    }
    if broken {
        // What a broken statement declares is not known, so that these would be false alarms.
        diagnostics.retain(|d| {
            !["unknown-node", "unknown-port", "open-input", "open-output", "unknown-import", "unknown-name"]
                .contains(&d.code)
        });
    } else if texts.files[0].1.graphs.is_empty() && !diagnostics.has_errors() {
        let span = crate::source::Span::new(root, 0, 0);
        diagnostics.push(
            Diagnostic::error("no-graph", span, "this text has no `graph`")
                .note("a smallest graph is `graph Name { }`"),
        );
    }
    Resolved { texts, graphs }
}

/// Whether another graph of the same text has an instance of `id`.
fn is_nested(texts: &Texts, id: GraphId) -> bool {
    use crate::syntax::tree::{Endpoint, Instance, NodeBody};
    fn in_end<'a>(end: &'a Endpoint, found: &mut Vec<&'a Instance>) {
        match end {
            Endpoint::Instance(instance) => found.push(instance),
            Endpoint::List(ends, _) => ends.iter().for_each(|e| in_end(e, found)),
            Endpoint::Port(_) => {}
        }
    }
    let name = &texts.graph(id).name.text;
    texts.files[id.file].1.graphs.iter().any(|graph| {
        let mut instances: Vec<&Instance> = graph
            .nodes
            .iter()
            .filter_map(|n| match &n.body {
                NodeBody::Instance(instance) => Some(instance),
                NodeBody::HandedIn(..) => None,
            })
            .collect();
        graph.chains.iter().flat_map(|c| &c.ends).for_each(|end| in_end(end, &mut instances));
        instances.iter().any(|i| i.path.segments.len() == 1 && i.path.segments[0].text == *name)
    })
}
