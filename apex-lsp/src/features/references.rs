//! Uses of a declaration.

use super::Ready;
use crate::places::is_own;
use apex_ide::{Definition, Occurrence, Origin};
use lsp_types::{DocumentHighlight, Location, Position};
use std::path::PathBuf;

/// A declaration to search for, in a form that is valid in all source files; a `Definition` has different indices in
/// each.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// Declared in this source file, at this byte offset.
    Text(PathBuf, u32),
    /// Declared in Rust, or built in.
    Rust(Definition),
}

/// Converts a definition to a target.
pub fn target(ready: &Ready<'_>, definition: Definition) -> Target {
    match ready.view().origin(definition) {
        Some(Origin::Text(span)) => Target::Text(ready.analysis.names.places.path(span).to_owned(), span.start),
        _ => Target::Rust(definition),
    }
}

/// Target of the name at a position.
pub fn target_at(ready: &Ready<'_>, position: Position) -> Option<Target> {
    ready.occurrence(position).map(|found| target(ready, found.definition))
}

/// Names in a source file, without its imports, that refer to the target.
pub fn uses<'a>(ready: &'a Ready<'_>, wanted: &Target) -> Vec<&'a Occurrence> {
    let own = ready.analysis.names.occurrences.iter().filter(|o| is_own(o.span));
    own.filter(|o| target(ready, o.definition) == *wanted).collect()
}

/// Locations in a source file that use the target.
pub fn references(ready: &Ready<'_>, wanted: &Target, with_declaration: bool) -> Vec<Location> {
    let uses = uses(ready, wanted).into_iter().filter(|o| with_declaration || !o.declares);
    uses.filter_map(|o| ready.analysis.names.places.location(o.span)).collect()
}

/// Ranges in the source file that use the name at a position.
pub fn highlights(ready: &Ready<'_>, position: Position) -> Vec<DocumentHighlight> {
    let Some(found) = ready.occurrence(position) else { return vec![] };
    let same = |o: &&Occurrence| o.definition == found.definition && is_own(o.span);
    let uses = ready.analysis.names.occurrences.iter().filter(same);
    uses.map(|o| DocumentHighlight { range: ready.analysis.names.places.range(o.span), kind: None }).collect()
}
