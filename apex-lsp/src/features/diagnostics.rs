//! Diagnostics.

use super::Ready;
use crate::places::is_own;
use apex_dsl::report::{Diagnostic as Found, Severity};
use lsp_types::{Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, NumberOrString, Range};

/// Diagnostics of a source file. A diagnostic of an imported source file is shown at the import.
pub fn diagnostics(ready: &Ready<'_>) -> Vec<Diagnostic> {
    let failed = ready.project.failure.as_ref();
    let package = failed.into_iter().map(|reason| failure(&format!("cannot read the nodes of the package: {reason}")));
    package.chain(ready.analysis.report.diagnostics.sorted().into_iter().map(|d| diagnostic(ready, d))).collect()
}

/// An error without a place in the source file.
pub fn failure(message: &str) -> Diagnostic {
    Diagnostic {
        severity: Some(DiagnosticSeverity::ERROR),
        source: Some("apex".to_owned()),
        message: message.to_owned(),
        ..Diagnostic::default()
    }
}

/// A diagnostic in the form of the protocol.
pub fn diagnostic(ready: &Ready<'_>, found: &Found) -> Diagnostic {
    let label = |span, text: &str| {
        let location = ready.analysis.report.places.location(span)?;
        Some(DiagnosticRelatedInformation { location, message: text.to_owned() })
    };
    let mut related: Vec<_> = found.secondary.iter().filter_map(|l| label(l.span, &l.text)).collect();
    let mut message = found.message.clone();
    if !is_own(found.primary.span) {
        related.extend(label(found.primary.span, "here"));
        message = format!("{}: {message}", ready.analysis.report.places.path(found.primary.span).display());
    }
    let label = (!found.primary.text.is_empty()).then_some(&found.primary.text);
    for line in label.into_iter().chain(&found.notes) {
        message.push('\n');
        message.push_str(line);
    }
    Diagnostic {
        range: range(ready, found),
        severity: Some(match found.severity {
            Severity::Error => DiagnosticSeverity::ERROR,
            Severity::Warning => DiagnosticSeverity::WARNING,
        }),
        code: Some(NumberOrString::String(found.code.to_owned())),
        source: Some("apex".to_owned()),
        message,
        related_information: (!related.is_empty()).then_some(related),
        ..Diagnostic::default()
    }
}

/// Range of a diagnostic.
fn range(ready: &Ready<'_>, found: &Found) -> Range {
    let span = found.primary.span;
    if is_own(span) {
        return ready.analysis.report.places.range(span);
    }
    let path = ready.analysis.report.places.path(span);
    let stem = path.file_stem().and_then(|s| s.to_str()).unwrap_or_default();
    let uses = &ready.view().texts.files[0].1.uses;
    let import = uses.iter().filter_map(|u| u.path.first()).find(|first| first.text == stem);
    import.map_or_else(Range::default, |first| ready.analysis.report.places.range(first.span))
}
