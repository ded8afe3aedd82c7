//! Names and values of robots, checked before they are written anywhere: robots are programs of others.

/// `true` for the full name of a node, a parameter or a graph: identifiers with points between them.
pub fn is_name(text: &str) -> bool {
    let is_identifier = |part: &str| {
        let mut chars = part.chars();
        chars.next().is_some_and(|c| c == '_' || c.is_alphabetic()) && chars.all(|c| c == '_' || c.is_alphanumeric())
    };
    text.split('.').all(is_identifier)
}

/// `true` for a value of a parameter in TOML, on one line.
pub fn is_value(text: &str) -> bool {
    !text.contains(|c: char| c.is_control() || c == '#')
        && text.parse::<toml::Value>().is_ok_and(|value| is_plain(&value))
        || is_text(text)
}

/// `true` for a string, which may contain anything.
fn is_text(text: &str) -> bool {
    text.starts_with('"') && !text.contains(char::is_control) && text.parse::<toml::Value>().is_ok_and(|v| v.is_str())
}

fn is_plain(value: &toml::Value) -> bool {
    match value {
        toml::Value::Datetime(_) | toml::Value::Table(_) => false,
        toml::Value::Array(list) => list.iter().all(is_plain),
        _ => true,
    }
}

/// Text of a robot on one line: without control characters, which would do something to a terminal, and not too long.
pub fn one_line(text: &str) -> String {
    text.chars().take(500).map(|c| if c.is_control() { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_values_are_told_from_source_text() {
        assert!(["a", "fast.planner_2.speed", "größe.x"].into_iter().all(is_name));
        assert!(!["", "a.", "a b", "a.1", "a = 1\nb", "a]", "a{"].into_iter().any(is_name));
        let values = ["1", "-2.5e3", "nan", "true", "\"a # b\"", "[1, [2.0, 3]]", "inf", "[\"x\"]"];
        assert!(values.into_iter().all(is_value));
        let others = [
            "",
            "1) every 7ms; node evil = Pulse(boom = 1",
            "1\nboom = 1",
            "1 # x",
            "{ a = 1 }",
            "a",
            "1979-05-27",
            "\"a\nb\"",
        ];
        assert_eq!(others.into_iter().filter(|text| is_value(text)).collect::<Vec<_>>(), [""; 0]);
    }
}
