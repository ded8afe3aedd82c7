//! Trees and signatures → one flat graph: names, imports, arguments, default ports, nested graphs.

mod args;
mod claims;
mod connect;
mod flatten;
mod generics;
mod instance;
mod link;
mod names;
mod record;
mod testing;
mod threads;
pub mod value;
mod wrap;

use crate::{
    catalog::Catalog,
    graph::Graph,
    report::{Diagnostic, Diagnostics},
    script::Script,
    source::{FileId, Sources, World},
    syntax::tree::{Endpoint, File, Instance, NodeBody},
};
use std::collections::BTreeSet;

pub use link::{Link, Side};
pub use names::{GraphId, Made, Meaning, Texts, suggest};

/// Most nodes, nested graphs and connections that one program may have, each.
pub const MAX_NODES: usize = 50_000;
/// Most ports and ends of connections that are looked at, nested graphs as often as they are used: bounds the time.
const MAX_LOOKS: usize = 1_000_000;
/// What may be wrong only because a broken statement is not known.
const UNCERTAIN: [&str; 10] = [
    "unknown-port",
    "open-input",
    "open-output",
    "unknown-name",
    "no-state",
    "unknown-state",
    "never-entered",
    "never-activated",
    "never-leaves",
    "never-fires",
];
/// What may be wrong only because a broken item is not known.
const UNCERTAIN_OUTSIDE: [&str; 2] = ["unknown-node", "unknown-import"];
/// Most claims of one program.
const MAX_CLAIMS: usize = 256;
/// How deep graphs nest in each other.
pub const MAX_NESTING: usize = 64;

/// What may still be added to the programs of a text.
pub struct Budget {
    /// Nodes and nested graphs.
    pub nodes: usize,
    /// Looks at a port or at an end of a connection.
    pub looks: usize,
    /// More was wanted, which has been reported.
    pub exceeded: bool,
}

/// What the texts of a program resolve to.
pub struct Resolved {
    /// The texts.
    pub texts: Texts,
    /// The graphs that are not used inside another one of the first text: the programs in it, and those that would
    /// be programs if all their parameters had a value.
    pub graphs: Vec<Graph>,
    /// The graphs that are used inside another one of the first text, by themselves.
    pub nested: Vec<Graph>,
    /// The connections of the graphs of the first text, as written.
    pub links: Vec<Link>,
    /// Whether a text has statements or items that could not be read.
    pub broken: bool,
    /// The tests of the first text: the graph that is tested, and what is done with it.
    pub tests: Vec<(Graph, Script)>,
}

/// Resolves the text `root` with everything that it imports.
pub fn resolve(
    root: FileId,
    catalog: &mut Catalog,
    sources: &mut Sources,
    world: &mut dyn World,
    diagnostics: &mut Diagnostics,
) -> Resolved {
    let texts = Texts::load(root, catalog, sources, world, diagnostics);
    let broken = texts.are_broken();
    let used = used(&texts.files[0].1);
    let (mut graphs, mut nested, mut links) = (vec![], vec![], vec![]);
    let mut budget = Budget { nodes: MAX_NODES, looks: MAX_LOOKS, exceeded: false };
    for graph in 0..texts.files[0].1.graphs.len() {
        let id = GraphId { file: 0, graph };
        let is_nested = used.contains(texts.graph(id).name.text.as_str());
        if budget.exceeded {
            break;
        }
        let resolved = instance::graph(&texts, catalog, id, &mut budget, &mut links, diagnostics);
        let group = if is_nested { &mut nested } else { &mut graphs };
        group.extend(resolved);
    }
    generated_names(&texts.files[0].1, &used, diagnostics);
    let mut tests = vec![];
    for test in &texts.files[0].1.tests {
        if budget.exceeded || broken {
            break;
        }
        tests.extend(testing::test(&texts, catalog, test, sources, &mut budget, diagnostics));
    }
    if !broken && texts.files[0].1.is_empty() && !diagnostics.has_errors() {
        let span = crate::source::Span::new(root, 0, 0);
        diagnostics.push(
            Diagnostic::error("no-graph", span, "this text has no `graph`")
                .note("a smallest graph is `graph Name { }`"),
        );
    }
    Resolved { texts, graphs, nested, broken, links, tests }
}

/// What the types are called that belong to the program of a graph, behind its name.
const GENERATED: [&str; 6] = ["Nodes", "State", "Inputs", "Outputs", "Parts", "Events"];

/// Reports graphs and machines that have the name of a type that belongs to another one's program.
fn generated_names(file: &File, used: &BTreeSet<&str>, diagnostics: &mut Diagnostics) {
    let programs = || file.graphs.iter().map(|g| &g.name).filter(|name| !used.contains(name.text.as_str()));
    let made = || programs().chain(file.machines.iter().map(|m| &m.name));
    for owner in programs() {
        let is_type = |name: &str| name.strip_prefix(&owner.text).is_some_and(|suffix| GENERATED.contains(&suffix));
        for name in made().filter(|name| is_type(&name.text)) {
            let message = format!("`{}` is the name of a type that belongs to `{}` in Rust", name.text, owner.text);
            let error = Diagnostic::error("duplicate-name", name.span, message).also(owner.span, "this graph");
            diagnostics.push(error.note("give one of the two another name"));
        }
    }
}

impl Resolved {
    /// Takes back what may be a false alarm because something that could not be read is not known.
    pub fn retain_certain(texts: &Texts, diagnostics: &mut Diagnostics) {
        let items = texts.files.iter().any(|(_, file)| file.broken_items);
        let uncertain = |code| UNCERTAIN.contains(&code) || (items && UNCERTAIN_OUTSIDE.contains(&code));
        diagnostics.retain(|d| !uncertain(d.code));
    }
}

/// The names of all graphs and nodes that the graphs of a text have instances of.
fn used(file: &File) -> BTreeSet<&str> {
    fn in_end<'a>(end: &'a Endpoint, found: &mut Vec<&'a Instance>) {
        match end {
            Endpoint::Instance(instance) => found.push(instance),
            Endpoint::List(ends, _) => ends.iter().for_each(|e| in_end(e, found)),
            Endpoint::Port(_) => {}
        }
    }
    let mut instances = vec![];
    for graph in &file.graphs {
        instances.extend(graph.nodes.iter().filter_map(|n| match &n.body {
            NodeBody::Instance(instance) => Some(instance),
            NodeBody::HandedIn(..) => None,
        }));
        graph.chains.iter().flat_map(|c| &c.ends).for_each(|end| in_end(end, &mut instances));
    }
    let names = instances.iter().filter_map(|i| match i.path.segments.as_slice() {
        [name] => Some(name.text.as_str()),
        _ => None,
    });
    names.collect()
}
