//! YAML: values of parameters on the command line, and the structure of files.

use saphyr_parser::{Event, Parser, ScalarStyle, Span, StrInput};

/// A value with its place.
#[derive(Debug, PartialEq)]
pub struct Value {
    pub place: Place,
    pub kind: Kind,
}

/// Line and column, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    pub line: usize,
    pub column: usize,
}

#[derive(Debug, PartialEq)]
pub enum Kind {
    /// A single value. A plain one, without quotes, may be a number.
    Single {
        text: String,
        is_plain: bool,
    },
    List(Vec<Value>),
    /// Keys with their places.
    Map(Vec<(String, Place, Value)>),
}

/// Mistake, and its place.
#[derive(Debug, PartialEq, Eq)]
pub struct Problem {
    pub place: Place,
    pub message: String,
}

/// Most values within one another.
const DEPTH: usize = 64;

/// Reads a text with one value; `None` if it is empty.
pub fn read(text: &str) -> Result<Option<Value>, Problem> {
    let mut reader = Reader(Parser::new_from_str(text));
    loop {
        match reader.next()? {
            Some((Event::StreamStart | Event::DocumentStart(_), _)) => {}
            Some((Event::StreamEnd | Event::DocumentEnd, _)) | None => return Ok(None),
            Some((event, place)) => {
                let value = reader.value(event, place, 0)?;
                return match (reader.next()?, reader.next()?) {
                    (_, Some((Event::DocumentStart(_), place))) => {
                        Err(problem(place, "a second document begins, and one is read"))
                    }
                    _ => Ok(Some(value)),
                };
            }
        }
    }
}

struct Reader<'a>(Parser<'a, StrInput<'a>>);

fn problem(place: Place, message: impl Into<String>) -> Problem {
    Problem { place, message: message.into() }
}

impl<'a> Reader<'a> {
    fn next(&mut self) -> Result<Option<(Event<'a>, Place)>, Problem> {
        let place = |span: &Span| Place { line: span.start.line(), column: span.start.col() + 1 };
        match self.0.next_event() {
            None => Ok(None),
            Some(Ok((event, span))) => Ok(Some((event, place(&span)))),
            Some(Err(error)) => {
                let (at, info) = (error.marker(), error.info());
                Err(problem(Place { line: at.line(), column: at.col() + 1 }, format!("this is not YAML: {info}")))
            }
        }
    }

    fn value(&mut self, event: Event<'a>, place: Place, depth: usize) -> Result<Value, Problem> {
        if depth > DEPTH {
            return Err(problem(place, format!("more than {DEPTH} values are within one another")));
        }
        let kind = match event {
            Event::Scalar(text, style, ..) => {
                Kind::Single { text: text.into_owned(), is_plain: style == ScalarStyle::Plain }
            }
            Event::SequenceStart(..) => {
                let mut all = vec![];
                while let Some((event, place)) = self.inside(&Event::SequenceEnd, place)? {
                    all.push(self.value(event, place, depth + 1)?);
                }
                Kind::List(all)
            }
            Event::MappingStart(..) => self.map(place, depth)?,
            _ => return Err(problem(place, "aliases (`*`) are not read: write the value")),
        };
        Ok(Value { place, kind })
    }

    fn map(&mut self, place: Place, depth: usize) -> Result<Kind, Problem> {
        let mut all: Vec<(String, Place, Value)> = vec![];
        while let Some((event, at)) = self.inside(&Event::MappingEnd, place)? {
            let Event::Scalar(key, ..) = event else { return Err(problem(at, "a key is a single word")) };
            if all.iter().any(|(other, ..)| *other == key) {
                return Err(problem(at, format!("`{key}` is there twice")));
            }
            let Some((event, place)) = self.next()? else { return Err(problem(at, "a value is missing")) };
            all.push((key.into_owned(), at, self.value(event, place, depth + 1)?));
        }
        Ok(Kind::Map(all))
    }

    /// Next event in a list or map; `None` at its end.
    fn inside(&mut self, end: &Event<'_>, begin: Place) -> Result<Option<(Event<'a>, Place)>, Problem> {
        match self.next()? {
            Some((event, _)) if event == *end => Ok(None),
            Some(next) => Ok(Some(next)),
            None => Err(problem(begin, "this has no end")),
        }
    }
}

/// Returns a value in TOML, in which parameters are set.
pub fn toml(value: &Value) -> Result<String, Problem> {
    match &value.kind {
        Kind::Single { text, is_plain: true } => {
            plain(text).ok_or_else(|| problem(value.place, "a value is missing here"))
        }
        Kind::Single { text, .. } => Ok(quoted(text)),
        Kind::List(all) => {
            let all: Vec<String> = all.iter().map(toml).collect::<Result<_, _>>()?;
            Ok(format!("[{}]", all.join(", ")))
        }
        Kind::Map(_) => Err(problem(value.place, "a list has values without names")),
    }
}

/// A plain value: a truth value, a number or a text, as the libraries of ROS read it; `None` if there is none.
fn plain(text: &str) -> Option<String> {
    let number = || {
        let begins = text.trim_start_matches(['+', '-']).starts_with(|c: char| c.is_ascii_digit() || c == '.');
        let hex = text.strip_prefix("0x").and_then(|digits| i64::from_str_radix(digits, 16).ok());
        let whole = hex.or_else(|| text.parse::<i64>().ok()).map(|number| number.to_string());
        whole.or_else(|| text.parse::<f64>().ok().filter(|_| begins).map(|number| format!("{number:?}")))
    };
    match text.to_ascii_lowercase().as_str() {
        "" | "~" | "null" => None,
        "true" | "yes" | "on" | "y" => Some("true".to_owned()),
        "false" | "no" | "off" | "n" => Some("false".to_owned()),
        ".inf" | "+.inf" => Some("inf".to_owned()),
        "-.inf" => Some("-inf".to_owned()),
        ".nan" => Some("nan".to_owned()),
        _ => Some(number().unwrap_or_else(|| quoted(text))),
    }
}

/// A text in TOML.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => quoted.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}

#[cfg(test)]
mod tests {
    use super::*;

    fn as_toml(text: &str) -> String {
        read(text).and_then(|value| toml(&value.expect("a value"))).expect("YAML")
    }

    #[test]
    fn values_are_those_of_ros() {
        for (yaml, expected) in [
            ("0.5", "0.5"),
            (".5", "0.5"),
            ("1e3", "1000.0"),
            ("-3", "-3"),
            ("+3", "3"),
            ("007", "7"),
            ("0x10", "16"),
            ("True", "true"),
            ("off", "false"),
            (".inf", "inf"),
            ("-.Inf", "-inf"),
            ("inf", "\"inf\""),
            ("[1, 2]", "[1, 2]"),
            ("[laser, 'true', \"a\\\"b\"]", "[\"laser\", \"true\", \"a\\\"b\"]"),
            ("- 1.5\n- .nan", "[1.5, nan]"),
            ("laser", "\"laser\""),
            ("'a b'", "\"a b\""),
            ("\"a\\nb\"", "\"a\\u000Ab\""),
            ("[]", "[]"),
            ("1.2.3", "\"1.2.3\""),
        ] {
            assert_eq!(as_toml(yaml), expected, "{yaml}");
        }
    }

    #[test]
    fn mistakes_have_their_place() {
        let wrong = |text: &str| {
            let Problem { place: Place { line, column }, message } =
                read(text).and_then(|value| value.map_or(Ok(String::new()), |value| toml(&value))).expect_err(text);
            format!("{line}:{column}: {message}")
        };
        assert_eq!(wrong("[1, ~]"), "1:5: a value is missing here");
        assert_eq!(wrong("a: 1\nb: 2\na: 3"), "3:1: `a` is there twice");
        assert_eq!(wrong("- a: 1"), "1:3: a list has values without names");
        assert_eq!(wrong("- &x 1\n- *x"), "2:3: aliases (`*`) are not read: write the value");
        assert_eq!(wrong("[a]: 1"), "1:1: a key is a single word");
        assert_eq!(wrong("a\n---\nb"), "2:1: a second document begins, and one is read");
        assert!(wrong("a: [1, 2\nb: 3").contains("this is not YAML"));
        assert!(wrong("a:\n\t- b").starts_with("2:"), "{}", wrong("a:\n\t- b"));
        assert_eq!(wrong(&"[".repeat(100)), "1:66: more than 64 values are within one another");
        assert!(wrong(&"[".repeat(100_000)).starts_with("1:"));
        assert_eq!(read("# nothing"), Ok(None));
    }
}
