//! Places of declarations.

use super::Ready;
use apex_dsl::syntax::MAX_BYTES;
use apex_host::read_text;
use apex_ide::Origin;
use lsp_types::{Location, Position};

/// Declaration of the name at a position, in a source file or in Rust.
pub fn definition(ready: &Ready<'_>, position: Position) -> Option<Location> {
    let found = ready.occurrence(position)?;
    match ready.view().origin(found.definition)? {
        Origin::Text(span) => ready.analysis.names.places.location(span),
        Origin::Rust(file, line, part) => {
            let path = ready.project.root.join(file);
            let text = read_text(&path, MAX_BYTES).unwrap_or_default();
            let range = apex_ide::place_in_rust(&text, line, &part);
            let lines = ready.analysis.lines_of(&text);
            Some(Location::new(crate::uri::from_path(&path)?, lines.range(range.start, range.end)))
        }
    }
}
