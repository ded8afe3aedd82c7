//! Source files, positions in them, and the only way in which the compiler reads from outside.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

/// Number of a source file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileId(pub u32);

/// A range of bytes in a source file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// The source file.
    pub file: FileId,
    /// First byte.
    pub start: u32,
    /// Byte after the last.
    pub end: u32,
}

impl Span {
    /// The span of `start..end` in `file`.
    pub fn new(file: FileId, start: usize, end: usize) -> Self {
        // The size of a source file is limited (`syntax::MAX_BYTES`), so that the offsets always fit.
        Self { file, start: start as u32, end: end as u32 }
    }

    /// From the start of `self` to the end of `other`.
    pub fn to(self, other: Self) -> Self {
        Self { end: other.end.max(self.end), ..self }
    }

    /// Returns `true` if `other` is in `self`.
    pub fn contains(self, other: Self) -> bool {
        self.file == other.file && self.start <= other.start && other.end <= self.end
    }

    /// The empty span behind `self`.
    pub fn after(self) -> Self {
        Self { start: self.end, ..self }
    }
}

/// A source file, or the text of a macro call.
#[derive(Debug, Clone)]
pub struct Source {
    /// Path as messages show it.
    pub path: PathBuf,
    /// The contents.
    pub text: Arc<str>,
    /// Line and column (from 0) at which the text starts in its file: not zero for text inside a macro.
    pub origin: (usize, usize),
    /// Offsets of the beginnings of the lines.
    lines: Vec<u32>,
}

/// The bytes at which the lines of `text` begin.
fn lines(text: &str) -> Vec<u32> {
    std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at as u32 + 1)).collect()
}

/// All source files of a compilation.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    files: Vec<Source>,
}

impl Sources {
    /// Adds a source file.
    pub fn add(&mut self, path: impl Into<PathBuf>, text: impl Into<Arc<str>>) -> FileId {
        self.add_at(path, text, (0, 0))
    }

    /// Adds a text that starts at the given line and column (from 0) of its file.
    pub fn add_at(&mut self, path: impl Into<PathBuf>, text: impl Into<Arc<str>>, origin: (usize, usize)) -> FileId {
        let text: Arc<str> = text.into();
        self.files.push(Source { path: path.into(), lines: lines(&text), text, origin });
        FileId(self.files.len() as u32 - 1)
    }

    /// The source file with this number.
    pub fn get(&self, file: FileId) -> &Source {
        &self.files[file.0 as usize]
    }

    /// The number of the source file with this path, if it was read.
    pub fn find(&self, path: &Path) -> Option<FileId> {
        self.files.iter().position(|s| s.path == path).map(|i| FileId(i as u32))
    }

    /// All source files.
    pub fn iter(&self) -> impl Iterator<Item = &Source> {
        self.files.iter()
    }

    /// The text at `span`.
    pub fn text(&self, span: Span) -> &str {
        &self.get(span.file).text[span.start as usize..span.end as usize]
    }

    /// Returns `true` if a comment on the line of `span`, or directly above it, allows a warning:
    /// `// allow(never-leaves): the last state`.
    pub fn is_allowed(&self, span: Span, code: &str) -> bool {
        let source = self.get(span.file);
        let line = source.lines.partition_point(|start| *start <= span.start) - 1;
        let text = |line: usize| {
            let end = source.lines.get(line + 1).map_or(source.text.len(), |next| *next as usize);
            source.text[source.lines[line] as usize..end].trim()
        };
        let allows = |comment: &str| {
            let codes = comment.trim().strip_prefix("allow(").and_then(|rest| rest.split_once(')'));
            codes.is_some_and(|(codes, _)| codes.split(',').any(|allowed| allowed.trim() == code))
        };
        let behind = text(line).rsplit_once("//").map(|(_, comment)| comment);
        let above = (0..line).rev().map_while(|line| text(line).strip_prefix("//"));
        behind.into_iter().chain(above).any(allows)
    }

    /// Line and column of a position, both from 1, the column in characters.
    pub fn line_column(&self, file: FileId, offset: u32) -> (usize, usize) {
        let source = self.get(file);
        let line = source.lines.partition_point(|start| *start <= offset) - 1;
        // Editors do not show a byte order mark, so that it does not count as a column.
        let before = &source.text[source.lines[line] as usize..offset as usize];
        let column = before.trim_start_matches('\u{feff}').chars().count();
        let shift = if line == 0 { source.origin.1 } else { 0 };
        (source.origin.0 + line + 1, column + shift + 1)
    }
}

/// Access to the outside. The compiler does nothing else that could differ between two runs.
pub trait World {
    /// The contents of a file.
    ///
    /// # Errors
    /// Returns the reason why the file cannot be read, without its path.
    fn read(&mut self, path: &Path) -> Result<Arc<str>, String>;

    /// Returns `true` if the file exists.
    fn exists(&mut self, path: &Path) -> bool;
}
