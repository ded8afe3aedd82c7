//! Mutation of inputs.

/// A small random number generator (xorshift64*).
pub struct Dice(u64);

impl Dice {
    /// The generator with `seed`.
    pub fn new(seed: u64) -> Self {
        let mut dice = Self(seed | 1);
        (0..4).for_each(|_| _ = dice.below(2));
        dice
    }

    /// A random number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        ((self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) % n.max(1) as u64) as usize
    }

    /// A random element of a list.
    pub fn of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}

/// Numbers and tokens that are often read wrongly.
const ODD: &[&str] = &[
    "0",
    "-1",
    "1e309",
    "-1e309",
    "NaN",
    "inf",
    "-0",
    "9223372036854775808",
    "18446744073709551616",
    "1e-320",
    "0x",
    "1.",
    ".5",
    "99999999999999999999999999999999999999999",
    "\"",
    "\\",
    "'",
    "[",
    "]",
    "{",
    "}",
    "(",
    ")",
    "\0",
    "\r",
    "\n",
    "\t",
    "\u{feff}",
    "\u{301}",
    "ß",
    "😀",
    "//",
    "/*",
    "*/",
    "///",
    "//!",
    ",",
    ";",
    "=",
    "=>",
    "->",
    "::",
    "..=",
    "%",
    "#",
];

/// Changes, removes, duplicates and exchanges bytes.
pub fn bytes(input: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = input.to_vec();
    for _ in 0..1 + dice.below(6) {
        if bytes.is_empty() {
            break;
        }
        let at = dice.below(bytes.len());
        let end = (at + 1 + dice.below(16)).min(bytes.len());
        match dice.below(7) {
            0 => bytes[at] ^= 1 << dice.below(8),
            1 => bytes[at] = *dice.of(&[0, 1, 0x7f, 0x80, 0xff]),
            2 => drop(bytes.drain(at..end)),
            3 => {
                let piece = bytes[at..end].to_vec();
                let to = dice.below(bytes.len());
                bytes.splice(to..to, piece);
            }
            4 => bytes.truncate(at),
            5 => bytes[at..end].fill(0xff),
            _ => {
                let to = dice.below(bytes.len());
                bytes.swap(at, to);
            }
        }
    }
    bytes
}

fn pick<'a>(words: &[&'a str], dice: &mut Dice) -> &'a str {
    if words.is_empty() { "" } else { words[dice.below(words.len())] }
}

/// Removes, duplicates and exchanges words of a text, or replaces them by words of `others`.
pub fn words<'a>(text: &'a str, others: &[&'a str], dice: &mut Dice) -> String {
    let mut words = split(text);
    for _ in 0..1 + dice.below(5) {
        if words.is_empty() {
            break;
        }
        let (a, b) = (dice.below(words.len()), dice.below(words.len()));
        let end = (a + 1 + dice.below(12)).min(words.len());
        match dice.below(8) {
            0 => drop(words.drain(a..end)),
            1 => drop(words.remove(a)),
            2 => words.insert(b, words[a]),
            3 => words.swap(a, b),
            4 => words[a] = ODD[dice.below(ODD.len())],
            5 => words[a] = pick(others, dice),
            6 => {
                let piece: Vec<&str> = words[a..end].to_vec();
                words.splice(b..b, piece);
            }
            _ => words.insert(a, pick(others, dice)),
        }
    }
    words.concat()
}

/// Splits a text into words and the text between them.
pub fn split(text: &str) -> Vec<&str> {
    let mut words = vec![];
    let mut start = 0;
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut before = None;
    for (at, c) in text.char_indices() {
        if before.is_some_and(|b| !(is_word(b) && is_word(c))) {
            words.push(&text[start..at]);
            start = at;
        }
        before = Some(c);
    }
    words.push(&text[start..]);
    words
}

/// All files below `folder` with this extension, sorted.
pub fn files(folder: &std::path::Path, ending: &str) -> Vec<String> {
    let mut found = vec![];
    let mut open = vec![folder.to_owned()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            let name = entry.file_name();
            if path.is_dir() {
                if !["target", ".git", "node_modules"].iter().any(|skipped| name.to_str() == Some(skipped)) {
                    open.push(path);
                }
            } else if path.extension().is_some_and(|e| e == ending) {
                found.push(path);
            }
        }
    }
    found.sort();
    found.iter().filter_map(|path| std::fs::read_to_string(path).ok()).filter(|t| t.len() < 20_000).collect()
}

/// Root of the repository.
pub fn root() -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}
