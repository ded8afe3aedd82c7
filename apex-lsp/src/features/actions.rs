//! Code actions that fix errors.

use super::{Ready, diagnostics::diagnostic};
use apex_dsl::{fix, report::Fix};
use lsp_types::{CodeAction, CodeActionKind, Range, TextEdit, WorkspaceEdit};
use std::collections::HashMap;

/// A code action to be offered.
pub struct Offered {
    /// The action in the form of the protocol, not yet preferred.
    pub action: CodeAction,
    /// For an unambiguous fix: the expected effect of a trial.
    pub certain: Option<Certain>,
}

/// A fix that its diagnostic marks as unambiguous.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Certain {
    /// The fix.
    pub fix: Fix,
    /// Message of the error that it should remove.
    pub message: String,
}

/// Code actions for the diagnostics in `range`.
pub fn actions(ready: &Ready<'_>, range: Range) -> Vec<Offered> {
    let report = &ready.analysis.report;
    let mut actions = vec![];
    for found in report.diagnostics.sorted() {
        let shown = diagnostic(ready, found);
        if shown.range.end < range.start || range.end < shown.range.start {
            continue;
        }
        for fix in &found.fixes {
            let Some(location) = report.places.location(fix.span) else { continue };
            let edit = TextEdit::new(location.range, fix.replacement.clone());
            let action = CodeAction {
                title: fix.title.clone(),
                kind: Some(CodeActionKind::QUICKFIX),
                diagnostics: Some(vec![shown.clone()]),
                edit: Some(WorkspaceEdit::new(HashMap::from([(location.uri, vec![edit])]))),
                is_preferred: Some(false),
                ..CodeAction::default()
            };
            let certain = fix::certain(found).cloned().map(|fix| Certain { fix, message: found.message.clone() });
            actions.push(Offered { action, certain });
        }
    }
    actions
}
