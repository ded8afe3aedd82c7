//! Changes that mend what is wrong.

use super::{Ready, diagnostics::diagnostic};
use lsp_types::{CodeAction, CodeActionKind, CodeActionOrCommand, Range, TextEdit, WorkspaceEdit};
use std::collections::HashMap;

/// The changes that would mend something in `range`.
pub fn actions(ready: &Ready<'_>, range: Range) -> Vec<CodeActionOrCommand> {
    let mut actions = vec![];
    for found in &ready.analysis.diagnostics {
        let shown = diagnostic(ready, found);
        if shown.range.end < range.start || range.end < shown.range.start {
            continue;
        }
        for fix in &found.fixes {
            let Some(location) = ready.analysis.location(fix.span) else { continue };
            let edit = TextEdit::new(location.range, fix.replacement.clone());
            actions.push(CodeActionOrCommand::CodeAction(CodeAction {
                title: fix.title.clone(),
                kind: Some(CodeActionKind::QUICKFIX),
                diagnostics: Some(vec![shown.clone()]),
                edit: Some(WorkspaceEdit::new(HashMap::from([(location.uri, vec![edit])]))),
                is_preferred: Some(fix.certain),
                ..CodeAction::default()
            }));
        }
    }
    actions
}
