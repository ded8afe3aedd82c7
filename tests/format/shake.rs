//! Variations of a source file with other blanks, line ends and comments; deterministic for each seed.

/// A xorshift generator, which is good enough for texts.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 16) as usize % n
    }

    fn of<'a>(&mut self, list: &[&'a str]) -> &'a str {
        list[self.below(list.len())]
    }
}

/// A piece of a source file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Piece<'t> {
    /// Blanks between two tokens.
    Blanks(&'t str),
    /// A comment or a line of documentation, with the line end after it and the blanks around it.
    Line(&'t str),
    /// A token before and after which blanks are optional.
    Sign(&'t str),
    /// Anything else.
    Word(&'t str),
}

fn pieces(text: &str) -> Vec<Piece<'_>> {
    let mut pieces = vec![];
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let blanks = rest.len() - rest.trim_start().len();
        let behind = &rest[blanks..];
        let end_of = |found: Option<usize>| found.unwrap_or(rest.len());
        let (length, piece): (usize, fn(&str) -> Piece<'_>) = if behind.starts_with("//") || behind.starts_with("/*") {
            let end = if behind.starts_with("//") { behind.find('\n') } else { behind.find("*/").map(|at| at + 2) };
            let comment = rest[..end_of(end.map(|end| blanks + end))].len();
            (rest.len() - rest[comment..].trim_start().len(), |text| Piece::Line(text))
        } else if blanks > 0 {
            (blanks, |text| Piece::Blanks(text))
        } else if first == '"' {
            (end_of(rest[1..].find('"').map(|end| end + 2)), |text| Piece::Word(text))
        } else if "()[]{},;".contains(first) {
            (1, |text| Piece::Sign(text))
        } else {
            (end_of(rest.find(|c: char| c.is_whitespace() || "()[]{},;\"".contains(c))), |text| Piece::Word(text))
        };
        let (taken, left) = rest.split_at(length);
        pieces.push(piece(taken));
        rest = left;
    }
    pieces
}

/// Replaces blanks and line ends, but keeps empty lines.
pub fn blanks(text: &str, seed: u64) -> String {
    let blanks = [" ", "\n", "  \t ", "\n        ", " \n"];
    let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    let pieces = pieces(text);
    let mut shaken = String::new();
    for (i, piece) in pieces.iter().enumerate() {
        let next_to_line = |at: usize| matches!(pieces.get(at), Some(Piece::Line(_)));
        match piece {
            Piece::Blanks(old) if old.matches('\n').count() < 2 => shaken.push_str(random.of(&blanks)),
            Piece::Sign(sign) => {
                let (after_line, before_line) = (i > 0 && next_to_line(i - 1), next_to_line(i + 1));
                let after_blanks = i > 0 && matches!(pieces[i - 1], Piece::Blanks(_));
                let before_blanks = matches!(pieces.get(i + 1), Some(Piece::Blanks(_)));
                shaken.push_str(if after_line || after_blanks { "" } else { random.of(&["", "", " ", "\n"]) });
                shaken.push_str(sign);
                shaken.push_str(if before_line || before_blanks { "" } else { random.of(&["", " ", "  "]) });
            }
            Piece::Blanks(same) | Piece::Line(same) | Piece::Word(same) => shaken.push_str(same),
        }
    }
    shaken
}

/// Inserts comments where blanks are allowed, at one of `rarity` places. The number of empty lines is kept.
pub fn comments(text: &str, rarity: usize, seed: u64) -> String {
    let kinds = [
        " /* in */ ",
        " // to the end\n",
        "\n// alone\n",
        " /* ends */\n",
        "\n/* two\n     lines */\n",
        "\n/* begins */ ",
    ];
    let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    let mut commented = String::new();
    for piece in pieces(text) {
        let mut may_be_commented = || if random.below(rarity) == 0 { random.of(&kinds) } else { "" };
        let (before, same, behind) = match piece {
            Piece::Blanks(same) => ("", same, may_be_commented()),
            Piece::Sign(same) => (may_be_commented(), same, may_be_commented()),
            Piece::Line(same) | Piece::Word(same) => ("", same, ""),
        };
        for part in [before, same, behind] {
            let ends_line = commented.trim_end_matches([' ', '\t']).ends_with('\n');
            commented.push_str(if ends_line { part.strip_prefix('\n').unwrap_or(part) } else { part });
        }
    }
    commented + "// the end"
}
