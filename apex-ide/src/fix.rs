//! Choice of the fixes that may be applied without asking: the same in the command and in the editor.

use apex_dsl::{
    report::{Diagnostic, Diagnostics, Fix, Severity},
    source::FileId,
};

/// The only fix of a diagnostic, if the diagnostic is certain of it and it changes the first source file. Only a check
/// of the changed text shows if the fix is right ([`mends`]).
pub fn certain(diagnostic: &Diagnostic) -> Option<&Fix> {
    match diagnostic.fixes.as_slice() {
        [only] if only.certain && only.span.file == FileId(0) => Some(only),
        _ => None,
    }
}

/// The text with a fix applied.
pub fn applied(text: &str, fix: &Fix) -> String {
    format!("{}{}{}", &text[..fix.span.start as usize], fix.replacement, &text[fix.span.end as usize..])
}

/// Returns `true` if a fix for the error `message` was an improvement: there are fewer errors than before, or as many
/// but fewer with this message. In the latter case the fixed error had hidden another one.
pub fn mends(before: &Diagnostics, after: &Diagnostics, message: &str) -> bool {
    let said = |diagnostics: &Diagnostics| diagnostics.sorted().iter().filter(|d| d.message == message).count();
    errors(after) < errors(before) || (errors(after) == errors(before) && said(after) < said(before))
}

/// The number of errors, including those that were dropped because there were too many.
fn errors(diagnostics: &Diagnostics) -> usize {
    diagnostics.sorted().iter().filter(|d| d.severity == Severity::Error).count() + diagnostics.left_out()
}
