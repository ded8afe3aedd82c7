//! Resolution: turns syntax trees and signatures into flat graphs. Resolves names, imports, arguments, default ports
//! and nested graphs.

mod args;
mod budget;
mod builder;
mod by_name;
mod claims;
mod condition;
mod connect;
mod declared;
mod ends;
mod flatten;
mod generics;
mod given;
mod instance;
mod link;
mod lists;
mod load;
mod machine;
pub mod mismatch;
mod names;
mod nodes;
mod origins;
mod record;
mod scope;
mod standard;
mod structs;
mod study;
mod suggest;
mod table;
mod testing;
mod threads;
mod time;
mod types;
mod unknown;
mod value;
mod variants;
mod wanted;
mod wrap;
mod writer;

use crate::{
    catalog::{Catalog, PRIMITIVES},
    graph::Graph,
    report::{Diagnostic, Diagnostics},
    script::Script,
    source::{FileId, Sources, World},
    syntax::tree::{File, GraphItem, Ident, NodeBody},
};
use std::collections::{BTreeMap, BTreeSet};

use budget::Budget;

pub use link::{Link, Side};
pub use lists::{check_origins, token_type};
pub use names::{Constructor, GraphId, Resolution, SourceSet};
pub use standard::is_own_event;

/// Result of the resolution of a source file.
pub struct Resolved {
    /// The source file and those that it imports.
    pub texts: SourceSet,
    /// Graphs of the first source file that are not used in another one of it: programs, and graphs that would be
    /// programs if all their parameters had a value.
    pub graphs: Vec<Graph>,
    /// Graphs of the first source file that are used in another one of it, each on its own.
    pub nested: Vec<Graph>,
    /// Connections of the graphs of the first source file, as written.
    pub links: Vec<Link>,
    /// Tests of the first source file: each graph under test, and the scripts that run it.
    pub tests: Vec<(Graph, Vec<Script>)>,
}

/// Resolves the source file `root` and everything that it imports.
pub fn resolve(
    root: FileId,
    catalog: &mut Catalog,
    sources: &mut Sources,
    world: &mut dyn World,
    diagnostics: &mut Diagnostics,
) -> Resolved {
    let texts = SourceSet::load(root, catalog, sources, world, diagnostics);
    let broken = texts.are_broken();
    types::check(&texts, catalog, diagnostics);
    let used = used(&texts.files[0].1);
    let (mut graphs, mut nested, mut links) = (vec![], vec![], vec![]);
    let mut budget = Budget::new();
    for id in texts.graph_ids(0) {
        let is_nested = is_nested(texts.graph(id), &used);
        if budget.exceeded {
            break;
        }
        let resolved = instance::graph(&texts, catalog, id, &mut budget, &mut links, diagnostics);
        let group = if is_nested { &mut nested } else { &mut graphs };
        group.extend(resolved);
    }
    generated_names(&texts, &used, catalog, diagnostics);
    let mut tests = vec![];
    test_names(&texts.files[0].1, diagnostics);
    for items in testing::by_program(&texts.files[0].1.tests, sources) {
        if budget.exceeded || broken {
            break;
        }
        // A port without a certain name can be neither fed nor expected.
        let graph = texts.graph_ids(0).map(|id| texts.graph(id)).find(|graph| items[0].graph.text() == graph.name.text);
        let mut ports = graph.into_iter().flat_map(|graph| &graph.ports);
        if ports.any(|port| diagnostics.has_errors_in(port.name.span)) {
            continue;
        }
        let resolved = testing::tests(&texts, catalog, &items, sources, &mut budget, diagnostics);
        if let Some((mut graph, scripts)) = resolved {
            testing::name_apart(&mut graph, &tests);
            tests.push((graph, scripts));
        }
    }
    if !broken && texts.files[0].1.is_empty() && !diagnostics.has_errors() {
        let span = crate::source::Span::new(root, 0, 0);
        diagnostics.push(
            Diagnostic::error("no-graph", span, "this source file has no `graph`")
                .note("the smallest graph is `graph Name { }`"),
        );
    }
    Resolved { texts, graphs, nested, links, tests }
}

/// Reports tests with the same name.
fn test_names(file: &File, diagnostics: &mut Diagnostics) {
    let mut known: BTreeMap<&str, &Ident> = BTreeMap::new();
    for name in file.tests.iter().map(|test| &test.name) {
        if let Some(first) = known.get(name.text.as_str()) {
            let message = format!("there is another test `{}`", name.text);
            let error = Diagnostic::error("duplicate-name", name.span, message);
            diagnostics.push(error.also(first.span, "first defined here"));
        } else {
            known.insert(&name.text, name);
        }
    }
}

/// Names that every Rust module knows, and names of `apex_rt::prelude` that occur in signatures of nodes. An item with
/// such a name would hide them from the Rust code beside it.
#[rustfmt::skip]
const OF_RUST: [&str; 38] = [
    "AsMut", "AsRef", "Box", "Clone", "Copy", "Debug", "Default", "Drop", "Eq", "Err", "Extend",
    "Fn", "FnMut", "FnOnce", "From", "Hash", "Into", "IntoIterator", "Iterator", "None", "Ok", "Option",
    "Ord", "PartialEq", "PartialOrd", "Result", "Send", "Sized", "Some", "String", "Sync", "ToOwned", "ToString",
    "Vec",
    "Ctx", "Event", "Out", "Outputs",
];

/// Reports graphs and machines whose names are taken in Rust: by Rust itself, or by a type that belongs to another
/// item.
fn generated_names(texts: &SourceSet, used: &BTreeSet<&str>, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    let file = &texts.files[0].1;
    let graphs = || texts.graph_ids(0).map(|id| texts.graph(id)).filter(|graph| !is_nested(graph, used));
    let made = || graphs().map(|g| &g.name).chain(file.machines.iter().map(|m| &m.name));
    for name in made().filter(|name| OF_RUST.contains(&name.text.as_str()) || PRIMITIVES.contains(&name.text.as_str()))
    {
        let message = format!("`{}` is a name that the generated Rust code uses", name.text);
        diagnostics.push(Diagnostic::error("duplicate-name", name.span, message).note("choose another name"));
    }
    for name in made().filter(|name| catalog.is_extern(&name.text)) {
        let message = format!("`{}` is the name of a crate, which would be hidden in Rust", name.text);
        diagnostics.push(Diagnostic::error("duplicate-name", name.span, message).note("choose another name"));
    }
    let parts = graphs().filter(has_parts).map(|graph| (format!("{}Parts", graph.name.text), &graph.name));
    let states = file.machines.iter().map(|machine| (format!("{}State", machine.name.text), &machine.name));
    let beside: BTreeMap<String, &Ident> = parts.chain(states).collect();
    for name in made() {
        if let Some(owner) = beside.get(&name.text) {
            let message = format!("`{}` is the name of a Rust type that is generated for `{}`", name.text, owner.text);
            let error = Diagnostic::error("duplicate-name", name.span, message).also(owner.span, "this one");
            diagnostics.push(error.note("give one of the two another name"));
        }
    }
    let own = made().map(|name| (name.text.clone(), name));
    taken_names(own.chain(beside), catalog, diagnostics);
}

/// Reports generated Rust types, each with the name of its graph or machine, that have the name of a type of the module
/// that calls `graph!`.
fn taken_names<'a>(types: impl Iterator<Item = (String, &'a Ident)>, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    for (generated, name) in types {
        let Some((file, line)) = catalog.type_at_site(&generated) else { continue };
        let message = format!("`{generated}` is already a type where the Rust code is generated");
        let note = format!("declared or imported at {}:{line}", file.display());
        let why = match generated == name.text {
            true => "choose another name, or call `graph!` in a module of its own".to_owned(),
            false => format!("`{}` has a Rust type of this name beside it; choose another name", name.text),
        };
        diagnostics.push(Diagnostic::error("duplicate-name", name.span, message).note(note).note(why));
    }
}

/// Returns `true` if a graph has nodes that are made in Rust.
fn has_parts(graph: &&GraphItem) -> bool {
    graph.nodes.iter().any(|node| matches!(node.body, NodeBody::HandedIn(..)))
}

/// Returns `true` if a graph is only a part of others, and not a program of its own. `used` are the names of parts.
fn is_nested(graph: &GraphItem, used: &BTreeSet<&str>) -> bool {
    !graph.is_public && used.contains(graph.name.text.as_str())
}

/// The names of all graphs and nodes of which the graphs in a source file contain instances.
fn used(file: &File) -> BTreeSet<&str> {
    let paths = file.graphs.iter().flat_map(|g| g.instances()).map(|i| i.path.segments.as_slice());
    paths.filter_map(|path| if let [name] = path { Some(name.text.as_str()) } else { None }).collect()
}
