//! Code actions: fixes of errors, and connections by name written out.

use super::{Ready, diagnostics::diagnostic};
use crate::analysis::Certain;
use apex_ide::fix;
use lsp_types::{CodeAction, CodeActionKind, Range, TextEdit, WorkspaceEdit};
use std::collections::HashMap;

/// A code action to be offered.
pub struct Offered {
    /// The action in the form of the protocol, not yet preferred.
    pub action: CodeAction,
    /// For an unambiguous fix: the expected effect of a trial.
    pub certain: Option<Certain>,
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
    actions.extend(written_out(ready, range));
    actions
}

/// Actions that replace `.*` by the names of the ports.
fn written_out(ready: &Ready<'_>, range: Range) -> Vec<Offered> {
    let (start, end) = (ready.offset(range.start) as u32, ready.offset(range.end) as u32);
    let offer = |written: apex_ide::WrittenOut| {
        let location = ready.analysis.report.places.location(written.chain)?;
        let edit = TextEdit::new(location.range, written.text);
        let action = CodeAction {
            title: "write out the connections by name".to_owned(),
            kind: Some(CodeActionKind::REFACTOR_REWRITE),
            edit: Some(WorkspaceEdit::new(HashMap::from([(location.uri, vec![edit])]))),
            ..CodeAction::default()
        };
        Some(Offered { action, certain: None })
    };
    apex_ide::written_out(&ready.view(), start, end).into_iter().filter_map(offer).collect()
}
