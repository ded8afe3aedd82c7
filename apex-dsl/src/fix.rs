//! Changes that mend errors: which of them may be made unasked. The command and the editor decide alike.

use crate::{
    report::{Diagnostic, Diagnostics, Fix, Severity},
    source::FileId,
};

/// The change of the first text that its diagnostic is certain of. Whether it is right is known when the changed text
/// was checked ([`mends`]).
pub fn certain(diagnostic: &Diagnostic) -> Option<&Fix> {
    match diagnostic.fixes.as_slice() {
        [only] if only.certain && only.span.file == FileId(0) => Some(only),
        _ => None,
    }
}

/// The text with a change.
pub fn applied(text: &str, fix: &Fix) -> String {
    format!("{}{}{}", &text[..fix.span.start as usize], fix.replacement, &text[fix.span.end as usize..])
}

/// Whether a change made for the error `message` has mended something: there are less errors, or as many of which less
/// are this one, which had hidden another.
pub fn mends(before: &Diagnostics, after: &Diagnostics, message: &str) -> bool {
    let said = |diagnostics: &Diagnostics| diagnostics.sorted().iter().filter(|d| d.message == message).count();
    errors(after) < errors(before) || (errors(after) == errors(before) && said(after) < said(before))
}

/// The number of errors, those included that were too many to be kept.
fn errors(diagnostics: &Diagnostics) -> usize {
    diagnostics.sorted().iter().filter(|d| d.severity == Severity::Error).count() + diagnostics.left_out()
}
