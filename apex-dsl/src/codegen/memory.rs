//! Memory of a program, in pieces. Only rustc knows their sizes.

use super::{
    cells::cell_name, field::Kind, generator::Generator, programs::each_part, structs::Field, threads::part_name,
    tokens::ident, view::ProgramView,
};
use crate::{catalog::Catalog, checked::CheckedProgram, source::Sources, syntax::tree::PortKind};
use std::collections::BTreeMap;

/// A piece of the memory of a program.
#[derive(Debug, PartialEq, Eq)]
pub struct Piece {
    /// Kind of the piece: `nodes`, `tokens`, …
    pub what: &'static str,
    /// Node or port of the source file that it belongs to.
    pub of: String,
    /// Expression of the piece in Rust, from the program: `nodes.fast.planner`.
    pub place: String,
}

/// Pieces of `program`, which must not be a test, ordered by kind. Together they are the whole program without padding.
pub fn memory(program: &CheckedProgram, catalog: &Catalog, sources: &Sources) -> Vec<Piece> {
    let graph = &program.graph;
    let mut pieces = vec![];
    each_part(program, catalog, sources, &mut |generator, view, part| {
        let place = part.map(|part| format!("{}.", part_name(part))).unwrap_or_default();
        let own = generator.pieces(view).into_iter();
        pieces.extend(own.map(|piece| Piece { place: format!("{place}{}", piece.place), ..piece }));
    });
    let cells = program.split.iter().flat_map(|split| split.cells.iter().map(move |cell| (split, cell)));
    pieces.extend(cells.enumerate().map(|(cell, (split, c))| Piece {
        what: "cells",
        of: format!("{} to {}", graph.end_name(c.from), split.parts[c.receiver].group),
        place: format!("cells.{}", cell_name(cell)),
    }));
    let order = |piece: &Piece| KINDS.iter().position(|kind| *kind == piece.what);
    pieces.sort_by_key(order);
    pieces
}

/// The kinds of pieces in their order.
const KINDS: [&str; 9] = ["nodes", "ports", "tokens", "timers", "activity", "stamps", "claims", "dispatcher", "cells"];

impl Generator<'_> {
    /// The pieces of a program on one thread, or of what runs on one of several.
    fn pieces(&self, view: ProgramView<'_>) -> Vec<Piece> {
        let ProgramView { graph, analysis, .. } = view;
        let mut fields = BTreeMap::new();
        self.node_fields(graph, analysis, &mut fields, &mut vec![]);
        let mut pieces = vec![];
        nodes(&fields, "", "nodes", &mut pieces);
        for (kind, place) in [
            (PortKind::Input, "inputs"),
            (PortKind::Slot, "inputs"),
            (PortKind::Output, "outputs"),
            (PortKind::Event, "events"),
        ] {
            pieces.extend(graph.boundaries(|k| k == kind).into_iter().map(|node| {
                let name = &graph.nodes[node].name;
                Piece { what: "ports", of: name.clone(), place: format!("{place}.{}", ident(name)) }
            }));
        }
        let mut state = self.state(view);
        state.sort_by_key(|kept| kept.kind);
        for kept in &state {
            pieces.extend(kept.places().map(|(place, of)| Piece { what: word(kept.kind), of: of.to_owned(), place }));
        }
        pieces
    }
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
