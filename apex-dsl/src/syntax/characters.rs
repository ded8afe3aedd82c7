//! Characters without a meaning in the language, and their probable meaning.

use super::keywords::is_name;
use crate::{
    report::{Diagnostic, Diagnostics},
    source::Span,
};
use std::ops::Range;

/// Largest number of places that a message shows for one word.
const MAX_PLACES: usize = 8;
/// Largest number of words that are reported individually.
const MAX_WORDS: usize = 20;

/// An error about a character without a meaning.
pub fn unknown(char: char, span: Span) -> Diagnostic {
    let shown = match char {
        _ if is_invisible(char) => format!("U+{:04X}", char as u32),
        _ if char.is_control() => char.escape_debug().to_string(),
        _ => char.to_string(),
    };
    explained(char, Diagnostic::error("unknown-character", span, format!("unexpected character `{shown}`")))
}

/// Returns `true` for byte order marks, characters without width and marks of the writing direction, which other
/// programs leave in a source file.
fn is_invisible(char: char) -> bool {
    matches!(char, '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{2069}' | '\u{feff}')
}

/// Adds the probable meaning of a character to an error, if it is known.
fn explained(char: char, error: Diagnostic) -> Diagnostic {
    let span = error.primary.span;
    let meant = match char {
        '→' | '⟶' | '➔' => "->",
        '⇒' | '⟹' => "=>",
        '“' | '”' | '„' => "\"",
        '−' | '–' | '—' => "-",
        '°' => "deg",
        'µ' | 'μ' => "u",
        '\u{a0}' => " ",
        '\'' => return error.note("a string is written in double quotes"),
        '#' => return error.guess("a comment begins with `//`", span, "//"),
        c if is_invisible(c) => return error.fix("remove this invisible character", span, ""),
        c if c.is_alphabetic() => return error.note(NAMES),
        _ => return error,
    };
    error.fix(format!("write `{meant}`"), span, meant)
}

const NAMES: &str = "a name consists of the letters a to z, digits and `_`";

/// The word around the letter at `at`, if it would be a name with other letters.
pub fn foreign_word(text: &str, at: usize) -> Option<Range<usize>> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    let start = text[..at].rfind(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    let start = start.map_or(0, |before| before + text[before..].chars().next().map_or(1, char::len_utf8));
    let end = text[at..].find(|c: char| !is_part(c)).map_or(text.len(), |end| at + end);
    let begins = text[start..end].starts_with(|c: char| c.is_alphabetic() || c == '_');
    // The sign of micrometres belongs to a unit.
    let is_letter = text[at..end].starts_with(|c: char| c.is_alphabetic() && !matches!(c, 'µ' | 'μ'));
    (begins && is_letter).then_some(start..end)
}

/// Words with letters that are not allowed in names, each with its places.
#[derive(Default)]
pub struct Foreign(Vec<(String, Vec<Span>)>);

impl Foreign {
    /// Adds a word.
    pub fn add(&mut self, word: &str, place: Span) {
        if let Some((_, places)) = self.0.iter_mut().find(|(known, _)| known == word) {
            places.push(place);
        } else if self.0.len() < MAX_WORDS {
            self.0.push((word.to_owned(), vec![place]));
        }
    }

    /// Reports each word once.
    pub fn report(&self, diagnostics: &mut Diagnostics) {
        self.0.iter().for_each(|(word, places)| diagnostics.push(foreign(word, places)));
    }
}

fn foreign(word: &str, places: &[Span]) -> Diagnostic {
    let mut letters: Vec<String> = vec![];
    for letter in word.chars().filter(|c| !c.is_ascii()).map(|c| format!("`{c}`")) {
        if !letters.contains(&letter) {
            letters.push(letter);
        }
    }
    let also = match places.len() {
        1 => String::new(),
        2 => ", here and in another place".to_owned(),
        n => format!(", here and in {} other places", n - 1),
    };
    let whole = if word.chars().nth(1).is_some() { format!(": `{word}`") } else { String::new() };
    let letters = match letters.as_slice() {
        [first @ .., last] if !first.is_empty() => format!("letters {} and {last}", first.join(", ")),
        letters => format!("letter {}", letters.concat()),
    };
    let message = format!("a name cannot contain the {letters}{whole}{also}");
    let error = Diagnostic::error("unknown-character", places[0], message).note(NAMES);
    let plain = plain(word);
    if !is_name(&plain) || !plain.contains(|c: char| c.is_ascii_alphanumeric()) {
        return places.iter().skip(1).take(MAX_PLACES).fold(error, |error, place| error.also(*place, "here too"));
    }
    places.iter().take(MAX_PLACES).enumerate().fold(error, |error, (i, place)| {
        let error = if i == 0 { error } else { error.also(*place, "here too") };
        error.guess(format!("write `{plain}`"), *place, plain.clone())
    })
}

/// A word transcribed into the letters of names, as in its own language.
fn plain(word: &str) -> String {
    let mut plain = String::new();
    for char in word.chars() {
        let lower = char.to_lowercase().next().unwrap_or(char);
        let letters = match lower {
            _ if char.is_ascii() => {
                plain.push(char);
                continue;
            }
            'ä' | 'æ' => "ae",
            'ö' | 'ø' | 'œ' => "oe",
            'ü' => "ue",
            'ß' => "ss",
            'à' | 'á' | 'â' | 'ã' | 'å' | 'ą' | 'α' => "a",
            'ç' | 'ć' | 'č' => "c",
            'è' | 'é' | 'ê' | 'ë' | 'ę' | 'ě' => "e",
            'ì' | 'í' | 'î' | 'ï' | 'ı' => "i",
            'ł' => "l",
            'ñ' | 'ń' | 'ň' => "n",
            'ò' | 'ó' | 'ô' | 'õ' => "o",
            'ř' => "r",
            'ś' | 'š' => "s",
            'ù' | 'ú' | 'û' | 'ů' => "u",
            'ý' | 'ÿ' => "y",
            'ź' | 'ż' | 'ž' => "z",
            'β' => "beta",
            'γ' => "gamma",
            'δ' => "delta",
            'θ' => "theta",
            'λ' => "lambda",
            'φ' => "phi",
            'π' => "pi",
            'σ' => "sigma",
            'ω' => "omega",
            _ => "_",
        };
        plain.push_str(letters);
    }
    plain
}
