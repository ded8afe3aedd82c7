//! Places in source files, in the form of the protocol.

use crate::{
    position::{Encoding, Lines},
    uri,
};
use apex_dsl::source::{FileId, Sources, Span};
use lsp_types::{Location, Range};
use std::{cell::OnceCell, path::Path};

/// Source files of one check with their lines. A span is valid only in the source files in which it was found.
/// Therefore all results of a check are stored together with its places.
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

    /// Source files.
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// `true` if the source file at `path` is one of them.
    pub fn reads(&self, path: &Path) -> bool {
        self.sources.find(path).is_some()
    }

    /// Path of the file that contains a span.
    pub fn path(&self, span: Span) -> &Path {
        &self.sources.get(span.file).path
    }

    /// Range of a span in lines and columns.
    pub fn range(&self, span: Span) -> Range {
        self.lines(span.file).range(span.start as usize, span.end as usize)
    }

    /// Location of a span in the form of the protocol.
    pub fn location(&self, span: Span) -> Option<Location> {
        Some(Location::new(uri::from_path(self.path(span))?, self.range(span)))
    }

    fn lines(&self, file: FileId) -> &Lines {
        self.lines[file.0 as usize].get_or_init(|| Lines::new(&self.sources.get(file).text, self.encoding))
    }
}

/// `true` if a span is in the source file itself, not in an import.
pub fn is_own(span: Span) -> bool {
    span.file == FileId(0)
}
