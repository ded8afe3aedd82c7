//! What to say about text that fits no rule.

use super::{Grammar, Rule};
use crate::{
    report::Diagnostic,
    source::{FileId, Span},
};
use pest::{
    Parser as _,
    error::{Error, ErrorVariant, InputLocation},
};

/// Explains a statement that could not be read: `text` begins at `start` of `file`.
pub fn statement(file: FileId, start: usize, text: &str) -> Diagnostic {
    let first = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').next().unwrap_or_default();
    let rule = match first {
        "node" => Rule::node_stmt,
        "in" | "out" | "slot" | "event" => Rule::port_stmt,
        "claim" => Rule::claim_stmt,
        _ => Rule::chain_stmt,
    };
    again(rule, file, start, text, "a statement is a port, a `node`, a connection or a `claim`")
}

/// Explains an item that could not be read.
pub fn item(file: FileId, start: usize, text: &str) -> Diagnostic {
    let first = text.split_whitespace().find(|w| !w.starts_with("//")).unwrap_or_default();
    let span = Span::new(file, start, start + text.trim_end().len().min(first.len().max(1)));
    match first {
        "fsm" | "test" => Diagnostic::error("not-yet", span, format!("`{first}` items are not supported yet")),
        _ if text.trim_start().starts_with("use") => {
            again(Rule::use_item, file, start, text, "an import is `use path::{Name, …};`")
        }
        _ => again(Rule::graph_item, file, start, text, "a file holds `use`, `graph` and `robot` items"),
    }
}

fn again(rule: Rule, file: FileId, start: usize, text: &str, otherwise: &str) -> Diagnostic {
    match Grammar::parse(rule, text) {
        Err(error) => diagnose(file, start, text, &error),
        Ok(_) => {
            let span = Span::new(file, start, start + text.trim_end().len());
            Diagnostic::error("syntax", span, "this cannot stand here").note(otherwise)
        }
    }
}

/// Puts pest's error into words. The text that it is about begins at `start` of the file.
pub fn diagnose(file: FileId, start: usize, text: &str, error: &Error<Rule>) -> Diagnostic {
    let at = match error.location {
        InputLocation::Pos(at) | InputLocation::Span((at, _)) => at,
    };
    let mut expected: Vec<&str> = match &error.variant {
        ErrorVariant::ParsingError { positives, .. } => positives.iter().filter_map(|r| name(*r)).collect(),
        ErrorVariant::CustomError { .. } => vec![],
    };
    expected.sort_unstable();
    expected.dedup();
    let message = match expected.as_slice() {
        [] => "this does not belong here".to_owned(),
        [one] => format!("expected {one}"),
        [rest @ .., last] => format!("expected {} or {last}", rest.join(", ")),
    };
    // What is missing is missing behind the last word, not before the next.
    let missing = expected.contains(&"`;`") || at >= text.trim_end().len();
    let at = start + if missing { text[..at].trim_end().len() } else { at };
    let diagnostic = Diagnostic::error("syntax", Span::new(file, at, at), message);
    if expected == ["`;`"] { diagnostic.fix("end the statement", Span::new(file, at, at), ";") } else { diagnostic }
}

fn name(rule: Rule) -> Option<&'static str> {
    Some(match rule {
        Rule::semi => "`;`",
        Rule::colon => "`:`",
        Rule::coloncolon => "`::`",
        Rule::assign => "`=`",
        Rule::lbrace => "`{`",
        Rule::rbrace => "`}`",
        Rule::rparen => "`)`",
        Rule::arrow => "`->` or `=>`",
        Rule::ident | Rule::name | Rule::path => "a name",
        Rule::port_ref => "a port",
        Rule::instance | Rule::endpoint => "a node or port",
        Rule::args => "`(`",
        Rule::ty | Rule::type_arg => "a type",
        Rule::expr | Rule::primary | Rule::number | Rule::string => "a value",
        Rule::binary => "an operator",
        Rule::use_group => "`{`",
        Rule::type_args | Rule::generics => "`<`",
        Rule::params => "`(`",
        Rule::range_op => "`..` or `..=`",
        Rule::node_kw => "`node`",
        Rule::claim_kw => "`claim`",
        Rule::graph_kw => "`graph` or `robot`",
        Rule::use_kw => "`use`",
        Rule::arg => "an argument `name = value`",
        Rule::param => "a parameter `name: type`",
        Rule::use_tree => "a path",
        Rule::list => "`[`",
        Rule::as_kw => "`as`",
        Rule::in_kw => "`in`",
        Rule::unit_tag => "`[unit]`",
        Rule::default => "`= value`",
        Rule::limits => "`in low..=high`",
        Rule::handed_in => "a type",
        Rule::port_kind => "`in`, `out`, `slot` or `event`",
        // Modifiers, documentation and operators would only blow up the list.
        _ => return None,
    })
}
