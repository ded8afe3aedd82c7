//! Where something is declared.

use super::Ready;
use apex_dsl::ide::Origin;
use lsp_types::{Location, Position, Range};
use std::fs;

/// Where the name at a position is declared: in a text, or in Rust.
pub fn definition(ready: &Ready<'_>, position: Position) -> Option<Location> {
    let found = ready.occurrence(position)?;
    let view = ready.view();
    match view.origin(found.definition)? {
        Origin::Text(span) => ready.analysis.location(span),
        Origin::Rust(file, line) => {
            let path = ready.project.root.join(file);
            let line = line.saturating_sub(1);
            let column = column(&path, line, view.sources.text(found.span));
            let at = Position::new(line as u32, column as u32);
            Some(Location::new(crate::uri::from_path(&path)?, Range::new(at, at)))
        }
    }
}

/// Where `name` stands in a line of a file; at its beginning if it does not.
fn column(path: &std::path::Path, line: usize, name: &str) -> usize {
    let text = fs::read_to_string(path).unwrap_or_default();
    // Rust before a name is ASCII, as good as always: no matter how columns are counted.
    text.lines().nth(line).and_then(|line| line.find(name)).unwrap_or(0)
}
