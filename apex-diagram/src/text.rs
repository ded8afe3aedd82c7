//! Estimates of the width of text. The fonts of the reader are not known, so the estimates are generous.

/// Width of `text` in a sans-serif font of this size.
pub fn width(text: &str, size: f64) -> f64 {
    text.chars().map(em).sum::<f64>() * size
}

/// Width of bold text.
pub fn bold_width(text: &str, size: f64) -> f64 {
    width(text, size) * 1.1
}

fn em(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | 'I' | '.' | ',' | ':' | ';' | '|' | '\'' | '!' | '(' | ')' | '[' | ']' | ' ' => 0.38,
        'f' | 't' | 'r' | '-' | '/' | '"' => 0.43,
        'm' | 'w' | 'M' | 'W' | '@' | '%' => 0.98,
        'a'..='z' | '0'..='9' | '_' => 0.63,
        'A'..='Z' => 0.75,
        c if (c as u32) < 0x300 => 0.84,
        c if (c as u32) < 0x2e80 => 0.9,
        _ => 1.1,
    }
}

/// `text`, shortened to at most `most` characters.
pub fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    let kept: String = text.chars().take(most - 1).collect();
    format!("{kept}…")
}
