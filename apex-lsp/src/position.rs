//! Bytes of a text, and the lines and columns of the protocol.

use lsp_types::{Position, PositionEncodingKind, Range};

/// In what columns are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Bytes.
    Utf8,
    /// Units of UTF-16: what every client knows.
    Utf16,
}

impl Encoding {
    /// Bytes if the client offers them.
    pub fn choose(offered: Option<&[PositionEncodingKind]>) -> Self {
        let bytes = offered.is_some_and(|kinds| kinds.contains(&PositionEncodingKind::UTF8));
        if bytes { Self::Utf8 } else { Self::Utf16 }
    }

    /// Its name in the protocol.
    pub fn kind(self) -> PositionEncodingKind {
        match self {
            Self::Utf8 => PositionEncodingKind::UTF8,
            Self::Utf16 => PositionEncodingKind::UTF16,
        }
    }

    fn width(self, c: char) -> usize {
        match self {
            Self::Utf8 => c.len_utf8(),
            Self::Utf16 => c.len_utf16(),
        }
    }
}

/// Where the lines of a text begin.
#[derive(Debug, Clone)]
pub struct Lines {
    starts: Vec<usize>,
    encoding: Encoding,
}

impl Lines {
    /// The lines of `text`; they end with `\n`, `\r\n` or `\r`.
    pub fn new(text: &str, encoding: Encoding) -> Self {
        let bytes = text.as_bytes();
        let ends = |i: usize| bytes[i] == b'\n' || bytes[i] == b'\r' && bytes.get(i + 1) != Some(&b'\n');
        let starts = std::iter::once(0).chain((0..bytes.len()).filter(|i| ends(*i)).map(|i| i + 1)).collect();
        Self { starts, encoding }
    }

    /// The position of a byte of `text`; behind the end for one that lies further.
    pub fn position(&self, text: &str, offset: usize) -> Position {
        let offset = offset.min(text.len());
        let line = self.starts.partition_point(|start| *start <= offset) - 1;
        let before = text[self.starts[line]..].char_indices().take_while(|(i, _)| self.starts[line] + i < offset);
        let column: usize = before.map(|(_, c)| self.encoding.width(c)).sum();
        Position::new(line as u32, column as u32)
    }

    /// The range of `start..end`.
    pub fn range(&self, text: &str, start: usize, end: usize) -> Range {
        Range::new(self.position(text, start), self.position(text, end))
    }

    /// The byte at a position: the end of the line for one behind it, the end of the text for a line that there is not.
    pub fn offset(&self, text: &str, position: Position) -> usize {
        let Some(&start) = self.starts.get(position.line as usize) else { return text.len() };
        let end = self.starts.get(position.line as usize + 1).copied().unwrap_or(text.len());
        let line = text[start..end].trim_end_matches(['\r', '\n']);
        let mut column = 0;
        for (i, c) in line.char_indices() {
            if column >= position.character as usize {
                return start + i;
            }
            column += self.encoding.width(c);
        }
        start + line.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_in_both_encodings() {
        let text = "aü\r\n😀b\rc\n";
        for (encoding, columns) in [(Encoding::Utf8, [3, 4, 5]), (Encoding::Utf16, [2, 2, 3])] {
            let lines = Lines::new(text, encoding);
            for (offset, line, column) in
                [(3, 0, columns[0]), (9, 1, columns[1]), (10, 1, columns[2]), (11, 2, 0), (13, 3, 0)]
            {
                assert_eq!(lines.position(text, offset), Position::new(line, column), "{encoding:?} {offset}");
                assert_eq!(lines.offset(text, Position::new(line, column)), offset, "{encoding:?} {line}:{column}");
            }
            assert_eq!(lines.offset(text, Position::new(0, 99)), 3);
            assert_eq!(lines.offset(text, Position::new(99, 0)), text.len());
            assert_eq!(lines.position(text, 99), Position::new(3, 0));
        }
    }

    /// A column inside of a character is the one behind it.
    #[test]
    fn no_position_splits_a_character() {
        let text = "😀b";
        assert_eq!(Lines::new(text, Encoding::Utf16).offset(text, Position::new(0, 1)), 4);
        assert_eq!(Lines::new(text, Encoding::Utf8).offset(text, Position::new(0, 2)), 4);
    }
}
