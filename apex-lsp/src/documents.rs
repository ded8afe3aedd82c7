//! Source files that are open in the editor.

use crate::position::{Encoding, Lines};
use lsp_types::{TextDocumentContentChangeEvent, Uri};
use std::sync::Arc;

/// An open source file.
pub struct Document {
    /// Address as the editor writes it.
    pub uri: Uri,
    /// Version, which increases with every change.
    pub version: i32,
    /// Current text.
    pub text: Arc<str>,
}

impl Document {
    /// Applies changes from the editor.
    pub fn change(&mut self, version: i32, changes: &[TextDocumentContentChangeEvent], encoding: Encoding) {
        let mut text = self.text.to_string();
        for change in changes {
            match change.range {
                None => text.clone_from(&change.text),
                Some(range) => {
                    let lines = Lines::new(&text, encoding);
                    let (start, end) =
                        (lines.offset(&text, encoding, range.start), lines.offset(&text, encoding, range.end));
                    text.replace_range(start..end.max(start), &change.text);
                }
            }
        }
        self.version = version;
        self.text = text.into();
    }
}
