//! Names that are declared in a source file and not used in it. A name counts as used wherever it is written again, so
//! that nothing that is used is reported.

use crate::{
    report::{Diagnostic, Diagnostics},
    source::{FileId, Sources, Span},
    syntax::{
        tokens::{TokenKind, tokens},
        tree::{Chain, File, GraphItem, Ident, PortKind, Use},
    },
};
use std::collections::{BTreeMap, BTreeSet};

/// The words of a source file with their places.
struct Words<'t>(BTreeMap<&'t str, Vec<u32>>);

impl<'t> Words<'t> {
    fn of(text: &'t str) -> Self {
        let mut words: BTreeMap<&str, Vec<u32>> = BTreeMap::new();
        for token in tokens(text).filter(|token| token.kind == TokenKind::Word) {
            words.entry(token.text).or_default().push(token.start as u32);
        }
        Self(words)
    }

    /// Returns `true` if a declared name is written again within `extent`.
    fn is_used(&self, name: &Ident, extent: Span) -> bool {
        let mut places = self.0.get(name.text.as_str()).into_iter().flatten();
        places.any(|at| *at != name.span.start && (extent.start..extent.end).contains(at))
    }
}

/// Warns of imports, graphs, parameters and ports that nothing uses.
pub fn check_unused(id: FileId, file: &File, sources: &Sources, diagnostics: &mut Diagnostics) {
    if file.broken || file.broken_items {
        return;
    }
    let text = &sources.get(id).text;
    let words = Words::of(text);
    check_imports(file, &words, diagnostics);
    check_graphs(file, &words, diagnostics);
    // A variant may connect what its base leaves open.
    let bases = file.graphs.iter().filter_map(|graph| Some(graph.base.as_ref()?.segments.last()?.text.as_str()));
    let bases: BTreeSet<&str> = bases.collect();
    for graph in file.graphs.iter().filter(|graph| !bases.contains(graph.name.text.as_str())) {
        // A parameter of a variant replaces a default of its base.
        if graph.base.is_none() {
            check_params(graph, &words, diagnostics);
        }
        // A wildcard connects ports without their names.
        let has_wildcard = |chain: &Chain| text[chain.span().start as usize..chain.span().end as usize].contains('*');
        if !graph.chains.iter().any(has_wildcard) {
            check_ports(graph, &words, diagnostics);
        }
    }
}

/// Warns of names that are imported, and not used: once for those of an item `use`.
fn check_imports(file: &File, words: &Words<'_>, diagnostics: &mut Diagnostics) {
    let is_unused = |import: &&Use| {
        // Each part of its path is a word of the import.
        let own: Vec<u32> = import.path.iter().chain([&import.name]).map(|word| word.span.start).collect();
        let mut places = words.0.get(import.name.text.as_str()).into_iter().flatten();
        places.all(|at| own.contains(at))
    };
    let unused: Vec<&Use> = file.uses.iter().filter(is_unused).collect();
    let item = |import: &Use| import.path.first().unwrap_or(&import.name).span;
    for unused in unused.chunk_by(|a, b| item(a) == item(b)) {
        let names = unused.iter().map(|import| format!("`{}`", import.name.text));
        let (verb, them) = if unused.len() == 1 { ("is", "it") } else { ("are", "them") };
        let message = format!("{} {verb} imported, and not used", names.collect::<Vec<_>>().join(", "));
        let mut places = unused.iter().map(|import| import.name.span);
        let Some(first) = places.next() else { continue };
        let warning = Diagnostic::warning("not-used", first, message).note(format!("remove {them} from the import"));
        diagnostics.push(places.fold(warning, |warning, place| warning.also(place, "not used")));
    }
}

/// Beside a robot, a graph or state machine is there for others, and is not run by itself.
fn check_graphs(file: &File, words: &Words<'_>, diagnostics: &mut Diagnostics) {
    if !file.graphs.iter().any(|graph| graph.robot) {
        return;
    }
    let graphs = file.graphs.iter().filter(|graph| !graph.robot && !graph.is_public);
    let graphs = graphs.map(|graph| ("graph", &graph.name, "write `pub graph` if Rust uses it"));
    let machines = file.machines.iter().map(|machine| ("state machine", &machine.name, "use it as a node"));
    let everywhere = |name: &Ident| Span { start: 0, end: u32::MAX, ..name.span };
    for (kind, name, how) in graphs.chain(machines).filter(|(_, name, _)| !words.is_used(name, everywhere(name))) {
        let message = format!("nothing uses the {kind} `{}`", name.text);
        let note = format!("{how}, or remove it");
        diagnostics.push(Diagnostic::warning("not-used", name.span, message).note(note));
    }
}

fn check_params(graph: &GraphItem, words: &Words<'_>, diagnostics: &mut Diagnostics) {
    for param in graph.params.iter().filter(|param| !words.is_used(&param.name, graph.extent)) {
        let message = format!("nothing uses the parameter `{}`", param.name.text);
        let warning = Diagnostic::warning("not-used", param.name.span, message);
        diagnostics.push(warning.note("write its name where a value is given, or remove it"));
    }
}

fn check_ports(graph: &GraphItem, words: &Words<'_>, diagnostics: &mut Diagnostics) {
    for port in graph.ports.iter().filter(|port| !words.is_used(&port.name, graph.extent)) {
        let name = &port.name.text;
        let (message, note) = match port.kind {
            PortKind::Input => (format!("nothing reads the input `{name}`"), format!("connect it: `{name} -> …;`")),
            PortKind::Slot => (format!("the slot `{name}` leads nowhere"), format!("connect it: `{name} -> …;`")),
            PortKind::Event => (format!("nothing triggers the event `{name}`"), format!("connect it: `… -> {name};`")),
            // An output without a connection is an error.
            PortKind::Output => continue,
        };
        diagnostics.push(Diagnostic::warning("not-used", port.name.span, message).note(note));
    }
}
