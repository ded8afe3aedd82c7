//! Changes that mend what is wrong.

use super::{Ready, diagnostics::diagnostic};
use apex_dsl::{fix, report::Fix};
use lsp_types::{CodeAction, CodeActionKind, Range, TextEdit, WorkspaceEdit};
use std::collections::HashMap;

/// A change that is offered.
pub struct Offered {
    /// The change as the protocol wants it, not preferred.
    pub action: CodeAction,
    /// If its diagnostic is certain of it: what a trial has to show.
    pub certain: Option<Certain>,
}

/// A change that is said to mend an error without doubt.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Certain {
    /// The change.
    pub fix: Fix,
    /// The error.
    pub message: String,
}

/// The changes that would mend something in `range`.
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
