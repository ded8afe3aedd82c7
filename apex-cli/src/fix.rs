//! `apex check --fix`: applies unambiguous fixes.

use crate::{project::Checker, replace::replace};
use apex_dsl::{report::Fix, source::Sources};
use apex_ide::fix::{applied, certain, mends};
use std::{path::Path, sync::Arc};

/// Maximum number of changes: beyond it, fixes cause new errors without end.
const MAX_CHANGES: usize = 1000;

/// Fixes `file` and returns the changes. A fix that does not remove its error, or adds errors, is undone.
pub fn file(file: &Path) -> Result<Vec<String>, String> {
    let mut checker = Checker::new(file)?;
    let before = checker.read(file)?;
    let mut text = before.clone();
    let mut changes = vec![];
    // Fixes that were undone.
    let mut useless: Vec<(String, Fix)> = vec![];
    while changes.len() < MAX_CHANGES {
        let (sources, diagnostics, _) = checker.check(file, text.clone());
        let left = diagnostics.sorted().into_iter().filter_map(|d| Some((d.message.clone(), certain(d)?.clone())));
        let Some((message, fix)) = left.into_iter().find(|candidate| !useless.contains(candidate)) else { break };
        let mended: Arc<str> = applied(&text, &fix).into();
        let (_, after, _) = checker.check(file, mended.clone());
        if mends(&diagnostics, &after, &message) {
            changes.push(said(&sources, &message, &fix));
            text = mended;
            // The positions of the other errors have changed.
            useless.clear();
        } else {
            useless.push((message, fix));
        }
    }
    if text != before {
        replace(file, &text).map_err(|e| format!("cannot write `{}`: {e}", file.display()))?;
    }
    Ok(changes)
}

/// Message about a fix: place, error and change.
fn said(sources: &Sources, message: &str, fix: &Fix) -> String {
    let (line, column) = sources.line_column(fix.span.file, fix.span.start);
    format!("fixed {}:{line}:{column}: {message}: {}", sources.get(fix.span.file).path.display(), fix.title)
}
