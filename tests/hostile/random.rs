//! Random bytes, random tokens, and valid source files with random changes; deterministic for each seed.

use std::{fs, ops::Range, path::Path};

const TOKENS: &str = "graph A { } ( ) [ ] < > -> => ; : :: = , . .. ..= node in out slot event claim use as robot every 20ms each par \
    delay essential on timeout pipelined 1 1.5 1m 1e9 0x1f \"s\" true false ! - + * / % && || == x y Ramp double show Latch sum tune \
    halve lidar list G /// /* */ // u64 Image start";

/// A xorshift generator, which is good enough for texts.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 16) as usize % n.max(1)
    }
}

/// Some source files for each seed.
pub fn texts(seeds: Range<u64>) -> Vec<(String, String)> {
    let valid = valid();
    let tokens: Vec<&str> = TOKENS.split_whitespace().collect();
    let mut texts = vec![];
    for seed in seeds {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        let bytes: Vec<u8> = (0..500).map(|_| random.below(256) as u8).collect();
        texts.push((format!("bytes {seed}"), String::from_utf8_lossy(&bytes).into_owned()));
        let soup: Vec<&str> = (0..300).map(|_| tokens[random.below(tokens.len())]).collect();
        texts.push((format!("tokens {seed}"), soup.join(" ")));
        // Without brackets it passes the first scan.
        let flat: Vec<&str> = soup.into_iter().filter(|t| !"(){}[]/**/<".contains(t)).collect();
        texts.push((format!("statements {seed}"), format!("graph A {{ {} }}", flat.join(" "))));
        let text = &valid[random.below(valid.len())];
        texts.push((format!("mutation {seed}"), mutated(text, &tokens, &mut random)));
    }
    texts
}

/// Source files with expected diagnostics, which are nearly valid and use all features.
fn valid() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("errors/texts");
    let mut found = vec![];
    for sub in fs::read_dir(folder).unwrap() {
        for entry in fs::read_dir(sub.unwrap().path()).unwrap() {
            let text = fs::read_to_string(entry.unwrap().path()).unwrap_or_default();
            found.push(text.lines().filter(|l| !l.starts_with("//")).collect::<Vec<_>>().join("\n"));
        }
    }
    found.sort();
    found
}

/// Removes, duplicates, exchanges or replaces words.
fn mutated(text: &str, tokens: &[&str], random: &mut Random) -> String {
    let mut words: Vec<String> = vec![];
    for c in text.chars() {
        match words.last_mut() {
            Some(word) if c.is_alphanumeric() && word.ends_with(char::is_alphanumeric) => word.push(c),
            _ => words.push(c.to_string()),
        }
    }
    for _ in 0..1 + random.below(8) {
        if words.is_empty() {
            break;
        }
        let (a, b) = (random.below(words.len()), random.below(words.len()));
        match random.below(5) {
            0 => drop(words.remove(a)),
            1 => words.insert(b, words[a].clone()),
            2 => words.swap(a, b),
            3 => words[a] = tokens[random.below(tokens.len())].to_owned(),
            _ => words.insert(a, format!(" {} ", tokens[random.below(tokens.len())])),
        }
    }
    words.concat()
}
