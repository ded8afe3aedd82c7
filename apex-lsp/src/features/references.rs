//! Where else something is used.

use super::Ready;
use crate::places::is_own;
use apex_dsl::ide::{Definition, Occurrence, Origin};
use lsp_types::{DocumentHighlight, Location, Position};
use std::path::PathBuf;

/// What is looked for: in another text the same thing has another number.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// It is declared in this text, at this byte.
    Text(PathBuf, u32),
    /// It is declared in Rust, or everywhere.
    Rust(Definition),
}

/// What the definition is in all texts.
pub fn target(ready: &Ready<'_>, definition: Definition) -> Target {
    match ready.view().origin(definition) {
        Some(Origin::Text(span)) => Target::Text(ready.analysis.names.places.path(span).to_owned(), span.start),
        _ => Target::Rust(definition),
    }
}

/// What the name at a position is in all texts.
pub fn target_at(ready: &Ready<'_>, position: Position) -> Option<Target> {
    ready.occurrence(position).map(|found| target(ready, found.definition))
}

/// The names of a text, and of no other that it imports, that mean the target.
pub fn uses<'a>(ready: &'a Ready<'_>, wanted: &Target) -> Vec<&'a Occurrence> {
    let own = ready.analysis.names.occurrences.iter().filter(|o| is_own(o.span));
    own.filter(|o| target(ready, o.definition) == *wanted).collect()
}

/// Where a text uses the target.
pub fn references(ready: &Ready<'_>, wanted: &Target, with_declaration: bool) -> Vec<Location> {
    let uses = uses(ready, wanted).into_iter().filter(|o| with_declaration || !o.declares);
    uses.filter_map(|o| ready.analysis.names.places.location(o.span)).collect()
}

/// Where the text uses what stands at a position.
pub fn highlights(ready: &Ready<'_>, position: Position) -> Vec<DocumentHighlight> {
    let Some(found) = ready.occurrence(position) else { return vec![] };
    let same = |o: &&Occurrence| o.definition == found.definition && is_own(o.span);
    let uses = ready.analysis.names.occurrences.iter().filter(same);
    uses.map(|o| DocumentHighlight { range: ready.analysis.names.places.range(o.span), kind: None }).collect()
}
