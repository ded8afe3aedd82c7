//! Texts, positions in them, and the one way in which the compiler reaches the outside.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

/// A text that was read, by number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileId(pub u32);

/// A range of bytes in a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// The text.
    pub file: FileId,
    /// First byte.
    pub start: u32,
    /// Byte after the last.
    pub end: u32,
}

impl Span {
    /// The span of `start..end` in `file`.
    pub fn new(file: FileId, start: usize, end: usize) -> Self {
        // Texts are limited to a few megabytes (`syntax::MAX_BYTES`), so that the numbers always fit.
        Self { file, start: start as u32, end: end as u32 }
    }

    /// From the start of `self` to the end of `other`.
    pub fn to(self, other: Self) -> Self {
        Self { end: other.end.max(self.end), ..self }
    }

    /// The empty span behind `self`.
    pub fn after(self) -> Self {
        Self { start: self.end, ..self }
    }
}

/// One text.
#[derive(Debug, Clone)]
pub struct Source {
    /// Where it came from, as messages show it.
    pub path: PathBuf,
    /// What it says.
    pub text: Arc<str>,
    /// Line and column (from 0) at which the text starts in its file: not zero for text inside a macro.
    pub origin: (usize, usize),
    /// Where its lines begin.
    lines: Vec<u32>,
}

/// The bytes at which the lines of `text` begin.
fn lines(text: &str) -> Vec<u32> {
    std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at as u32 + 1)).collect()
}

/// All texts of a compilation.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    files: Vec<Source>,
}

impl Sources {
    /// Adds a text.
    pub fn add(&mut self, path: impl Into<PathBuf>, text: impl Into<Arc<str>>) -> FileId {
        self.add_at(path, text, (0, 0))
    }

    /// Adds a text that starts at the given line and column (from 0) of its file.
    pub fn add_at(&mut self, path: impl Into<PathBuf>, text: impl Into<Arc<str>>, origin: (usize, usize)) -> FileId {
        let text: Arc<str> = text.into();
        self.files.push(Source { path: path.into(), lines: lines(&text), text, origin });
        FileId(self.files.len() as u32 - 1)
    }

    /// The text with this number.
    pub fn get(&self, file: FileId) -> &Source {
        &self.files[file.0 as usize]
    }

    /// The number of the text with this path, if it was read.
    pub fn find(&self, path: &Path) -> Option<FileId> {
        self.files.iter().position(|s| s.path == path).map(|i| FileId(i as u32))
    }

    /// All texts.
    pub fn iter(&self) -> impl Iterator<Item = &Source> {
        self.files.iter()
    }

    /// The text at `span`.
    pub fn text(&self, span: Span) -> &str {
        &self.get(span.file).text[span.start as usize..span.end as usize]
    }

    /// Line and column of a position, both from 1, the column in characters.
    pub fn line_column(&self, file: FileId, offset: u32) -> (usize, usize) {
        let source = self.get(file);
        let line = source.lines.partition_point(|start| *start <= offset) - 1;
        // A mark of byte order is no column: editors do not show it.
        let before = &source.text[source.lines[line] as usize..offset as usize];
        let column = before.trim_start_matches('\u{feff}').chars().count();
        let shift = if line == 0 { source.origin.1 } else { 0 };
        (source.origin.0 + line + 1, column + shift + 1)
    }
}

/// Everything the compiler needs from outside. It does nothing else that could differ between two runs.
pub trait World {
    /// The text of a file.
    ///
    /// # Errors
    /// Says why it cannot be read, without the path.
    fn read(&mut self, path: &Path) -> Result<Arc<str>, String>;

    /// Whether there is such a file.
    fn exists(&mut self, path: &Path) -> bool;
}
