//! Conversion between byte offsets and the lines and columns of the protocol.

use lsp_types::{Position, PositionEncodingKind, Range};

/// Unit of columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Bytes.
    Utf8,
    /// UTF-16 code units, which every client supports.
    Utf16,
}

impl Encoding {
    /// Bytes if the client offers them, otherwise UTF-16.
    pub fn choose(offered: Option<&[PositionEncodingKind]>) -> Self {
        let bytes = offered.is_some_and(|kinds| kinds.contains(&PositionEncodingKind::UTF8));
        if bytes { Self::Utf8 } else { Self::Utf16 }
    }

    /// Name in the protocol.
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

/// Line starts and wide characters of a text. With them, a position is found without reading the text again, however
/// long its line is.
#[derive(Debug, Clone)]
pub struct Lines {
    /// Byte offsets of the line starts.
    starts: Vec<usize>,
    /// Byte offsets of the line ends, before their CR and LF.
    ends: Vec<usize>,
    /// Characters of several bytes.
    wide: Vec<Wide>,
    /// Length of the text in bytes.
    length: usize,
}

/// A character of several bytes.
#[derive(Debug, Clone, Copy)]
struct Wide {
    start: usize,
    end: usize,
    /// Difference between the numbers of bytes and columns up to its end.
    surplus: usize,
}

impl Lines {
    /// Lines of `text`. A line ends with LF, CR LF or CR.
    pub fn new(text: &str, encoding: Encoding) -> Self {
        let bytes = text.as_bytes();
        let breaks = |i: &usize| bytes[*i] == b'\n' || bytes[*i] == b'\r' && bytes.get(*i + 1) != Some(&b'\n');
        let starts: Vec<usize> = std::iter::once(0).chain((0..bytes.len()).filter(breaks).map(|i| i + 1)).collect();
        let next = starts.iter().skip(1).copied().chain([bytes.len()]);
        let end = |(start, next): (&usize, usize)| start + text[*start..next].trim_end_matches(['\r', '\n']).len();
        let ends = starts.iter().zip(next).map(end).collect();
        let mut surplus = 0;
        let wide = text.char_indices().filter(|(_, c)| !c.is_ascii()).map(|(start, c)| {
            surplus += c.len_utf8() - encoding.width(c);
            Wide { start, end: start + c.len_utf8(), surplus }
        });
        Self { starts, ends, wide: wide.collect(), length: text.len() }
    }

    /// Position of a byte offset. An offset after the end of the text is treated as the end, one inside a CR LF as the
    /// end of the line.
    pub fn position(&self, offset: usize) -> Position {
        let offset = offset.min(self.length);
        let line = self.starts.partition_point(|start| *start <= offset) - 1;
        let offset = offset.min(self.ends[line]);
        let column = self.columns(offset) - self.columns(self.starts[line]);
        Position::new(line as u32, column as u32)
    }

    /// Number of columns before a byte offset if the text were one line. A character counts as a whole.
    fn columns(&self, offset: usize) -> usize {
        let passed = self.wide.partition_point(|c| c.start < offset);
        passed.checked_sub(1).map_or(offset, |last| offset.max(self.wide[last].end) - self.wide[last].surplus)
    }

    /// Range of `start..end`.
    pub fn range(&self, start: usize, end: usize) -> Range {
        Range::new(self.position(start), self.position(end))
    }

    /// Byte offset of a position in `text`, to which these lines belong. A column after the end of a line is treated as
    /// the end of the line, a line after the end of the text as the end of the text.
    pub fn offset(&self, text: &str, encoding: Encoding, position: Position) -> usize {
        let Some(&start) = self.starts.get(position.line as usize) else { return text.len() };
        let line = &text[start..self.ends[position.line as usize]];
        let mut column = 0;
        for (i, c) in line.char_indices() {
            if column >= position.character as usize {
                return start + i;
            }
            column += encoding.width(c);
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
                assert_eq!(lines.position(offset), Position::new(line, column), "{encoding:?} {offset}");
                assert_eq!(
                    lines.offset(text, encoding, Position::new(line, column)),
                    offset,
                    "{encoding:?} {line}:{column}"
                );
            }
            assert_eq!(lines.offset(text, encoding, Position::new(0, 99)), 3);
            assert_eq!(lines.offset(text, encoding, Position::new(99, 0)), text.len());
            assert_eq!(lines.position(99), Position::new(3, 0));
            assert_eq!(lines.position(4), lines.position(3), "between CR and LF");
        }
    }

    /// A column inside a character is treated as the column after it.
    #[test]
    fn no_position_splits_a_character() {
        let text = "😀b";
        for (encoding, column) in [(Encoding::Utf16, 1), (Encoding::Utf8, 2)] {
            let lines = Lines::new(text, encoding);
            assert_eq!(lines.offset(text, encoding, Position::new(0, column)), 4);
        }
    }
}
