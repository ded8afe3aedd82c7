//! Renaming.

use super::{
    Ready,
    references::{Target, uses},
};
use crate::places::is_own;
use lsp_types::{Position, PrepareRenameResponse, TextEdit};

/// Range and text of the name at a position. Fails if the name cannot be changed.
pub fn prepare(ready: &Ready<'_>, position: Position) -> Result<PrepareRenameResponse, String> {
    let found = ready.occurrence(position).ok_or("there is no name here")?;
    let view = ready.view();
    let name = apex_ide::may_rename(&view, found.definition)?.text.clone();
    if view.sources.text(found.span) != name {
        return Err(format!(
            "this is another name for `{name}` from an import; rename `{name}` itself, or change the import"
        ));
    }
    Ok(PrepareRenameResponse::RangeWithPlaceholder {
        range: ready.analysis.names.places.range(found.span),
        placeholder: name,
    })
}

/// Edits of one source file that rename the target.
pub fn edits(ready: &Ready<'_>, wanted: &Target, name: &str) -> Result<Vec<TextEdit>, String> {
    let Some(definition) = uses(ready, wanted).first().map(|o| o.definition) else { return Ok(vec![]) };
    let spans = apex_ide::rename(&ready.view(), &ready.analysis.names.occurrences, definition, name)?;
    let own = spans.into_iter().filter(|span| is_own(*span));
    Ok(own.map(|span| TextEdit::new(ready.analysis.names.places.range(span), name.to_owned())).collect())
}
