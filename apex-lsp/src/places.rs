//! Places in texts, as the protocol wants them.

use crate::{
    position::{Encoding, Lines},
    uri,
};
use apex_dsl::source::{FileId, Sources, Span};
use lsp_types::{Location, Range};
use std::{cell::OnceCell, path::Path};

/// The texts of one check with their lines. A span has a meaning only in the texts in which it was found: whatever
/// comes out of a check stands beside its places.
pub struct Places {
    sources: Sources,
    lines: Vec<OnceCell<Lines>>,
    encoding: Encoding,
}

impl Places {
    /// The places of `sources`, the first of which is `root` as the editor has it. What was checked in its place may
    /// differ from it (see `syntax::repaired`), but every place in the one is the same place in the other.
    pub fn new(sources: Sources, root: &str, encoding: Encoding) -> Self {
        let mut lines = vec![OnceCell::from(Lines::new(root, encoding))];
        lines.resize_with(sources.iter().count(), OnceCell::new);
        Self { sources, lines, encoding }
    }

    /// The texts.
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// Whether the text at `path` is one of them.
    pub fn reads(&self, path: &Path) -> bool {
        self.sources.find(path).is_some()
    }

    /// The file that a span lies in.
    pub fn path(&self, span: Span) -> &Path {
        &self.sources.get(span.file).path
    }

    /// The lines and columns of a span.
    pub fn range(&self, span: Span) -> Range {
        self.lines(span.file).range(span.start as usize, span.end as usize)
    }

    /// A span as the protocol wants it.
    pub fn location(&self, span: Span) -> Option<Location> {
        Some(Location::new(uri::from_path(self.path(span))?, self.range(span)))
    }

    fn lines(&self, file: FileId) -> &Lines {
        self.lines[file.0 as usize].get_or_init(|| Lines::new(&self.sources.get(file).text, self.encoding))
    }
}

/// Whether a span lies in the text itself, not in one that it imports.
pub fn is_own(span: Span) -> bool {
    span.file == FileId(0)
}
