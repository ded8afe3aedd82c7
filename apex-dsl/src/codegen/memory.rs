//! What a program consists of in memory, piece by piece. How large the pieces are is known to rustc alone.

use super::{
    Generator, Names,
    activity::Whole,
    bits::Bits,
    program::{Field, boundaries},
    state::Kind,
    types::ident,
};
use crate::{catalog::Catalog, passes::Program, source::Sources, syntax::tree::PortKind};
use std::collections::{BTreeMap, BTreeSet};

/// A piece of the memory of a program.
#[derive(Debug, PartialEq, Eq)]
pub struct Piece {
    /// What it is there for: `nodes`, `tokens`, …
    pub what: &'static str,
    /// To what of the text it belongs.
    pub of: String,
    /// Where it lies in the program, in Rust: `nodes.fast.planner`.
    pub place: String,
}

/// The pieces of `program`, which is no test, kind after kind. Together they are all of it, but for padding.
pub fn memory(program: &Program, catalog: &Catalog, sources: &Sources) -> Vec<Piece> {
    let (graph, analysis) = (&program.graph, &program.analysis);
    let names = Names::new(graph, &graph.name, "", &mut 0, &mut BTreeSet::new());
    let place = |_| proc_macro2::Span::call_site();
    let generator = Generator { catalog, sources, names: &names, place: &place, outer: None, channels: None };
    let mut fields = BTreeMap::new();
    generator.node_fields(graph, analysis, &mut fields, &mut vec![]);
    let mut pieces = vec![];
    nodes(&fields, "", "nodes", &mut pieces);
    for (kind, place) in [
        (PortKind::Input, "inputs"),
        (PortKind::Slot, "inputs"),
        (PortKind::Output, "outputs"),
        (PortKind::Event, "events"),
    ] {
        pieces.extend(boundaries(graph, |k| k == kind).into_iter().map(|node| {
            let name = &graph.nodes[node].name;
            Piece { what: "ports", of: name.clone(), place: format!("{place}.{}", ident(name)) }
        }));
    }
    let whole = Whole { graph, analysis, links: &analysis.links };
    let mut state = generator.state(whole, &Bits::new(graph, analysis));
    state.sort_by_key(|kept| kept.kind);
    pieces.extend(state.into_iter().map(|kept| Piece {
        what: word(kept.kind),
        of: kept.of,
        place: format!("state.{}", kept.name),
    }));
    pieces
}

fn word(kind: Kind) -> &'static str {
    match kind {
        Kind::Token => "tokens",
        Kind::Timer => "timers",
        Kind::Activity => "activity",
        Kind::Stamp => "stamps",
        Kind::Claim => "claims",
        Kind::Dispatcher => "dispatcher",
    }
}

fn nodes(fields: &BTreeMap<String, Field>, path: &str, place: &str, pieces: &mut Vec<Piece>) {
    for (name, field) in fields {
        let (of, place) = (format!("{path}{name}"), format!("{place}.{}", ident(name)));
        match field {
            Field::Node { .. } => pieces.push(Piece { what: "nodes", of, place }),
            Field::Nested(inner) => nodes(inner, &format!("{of}."), &place, pieces),
        }
    }
}
