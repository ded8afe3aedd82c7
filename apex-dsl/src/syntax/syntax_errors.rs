//! Explanations of text that matches no rule of the grammar.

use super::{
    grammar::{Grammar, Rule},
    keywords::{self, KeywordPosition},
    mistakes::CommonMistake,
};
use crate::{
    report::{Diagnostic, nearest},
    source::{FileId, Span},
};
use pest::{
    Parser as _,
    error::{Error, ErrorVariant, InputLocation},
};

/// The word at the beginning of a text; empty if something else stands there.
fn first_word(text: &str) -> &str {
    text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').map_or(text, |end| &text[..end])
}

/// Explains a statement that could not be parsed. `text` begins at `start` of `file`.
pub fn statement(file: FileId, start: usize, text: &str) -> Diagnostic {
    let first = first_word(text);
    let rule = match first {
        "node" => Rule::node_stmt,
        "in" | "out" | "slot" | "event" => Rule::port_stmt,
        "claim" => Rule::claim_stmt,
        "thread" => Rule::thread_stmt,
        "record" => Rule::record_stmt,
        _ => Rule::chain_stmt,
    };
    again(rule, file, start, text, "a statement is a port, a `node`, a connection or a `claim`")
}

/// Explains a statement of a state machine that could not be parsed.
pub fn in_machine(file: FileId, start: usize, text: &str) -> Diagnostic {
    let first = first_word(text);
    let rule = match first {
        "in" | "out" | "slot" | "event" => Rule::port_stmt,
        "state" => Rule::state_item,
        "entry" | "exit" => Rule::entry_exit,
        _ => Rule::transition,
    };
    let otherwise = "an `fsm` contains `slot`, `event` and `state`; a state contains `on slot if guard => state -> event;`, `after 5s => state -> event;`, `entry -> event;`, `exit -> event;` and states";
    again(rule, file, start, text, otherwise)
}

/// Explains a statement of a test that could not be parsed.
pub fn in_test(file: FileId, start: usize, text: &str) -> Diagnostic {
    let first = first_word(text);
    let rule = match first {
        "replace" => Rule::replace_stmt,
        "feed" => Rule::feed_stmt,
        "wait" => Rule::wait_stmt,
        "never" => Rule::never_stmt,
        _ => Rule::expect_stmt,
    };
    let otherwise = "a test contains `replace node = Node();`, `feed port = value;`, `wait 1s;`, `expect port == value within 1s;` and `never port;`";
    again(rule, file, start, text, otherwise)
}

/// Explains a statement of a study that could not be parsed.
pub fn in_tune(file: FileId, start: usize, text: &str) -> Diagnostic {
    let first = first_word(text);
    let rule = match first {
        "vary" => Rule::vary_stmt,
        "minimise" | "maximise" => Rule::goal_stmt,
        "require" => Rule::require_stmt,
        "seeds" => Rule::seeds_stmt,
        "holdout" => Rule::holdout_stmt,
        "replace" | "feed" | "wait" | "never" | "expect" => return in_test(file, start, text),
        _ => {
            let span = Span::new(file, start, start + first.len().max(token(text)));
            let error = Diagnostic::error("syntax", span, format!("no statement of a `tune` begins with `{first}`"));
            let known = keywords::words_at(KeywordPosition::Tune).chain(keywords::words_at(KeywordPosition::Test));
            return match nearest(first, known.map(|word| word.text)) {
                Some(meant) => error.guess(format!("did you mean `{meant}`?"), span, meant),
                None => error.note(IN_TUNE),
            };
        }
    };
    again(rule, file, start, text, IN_TUNE)
}

const IN_TUNE: &str = "a `tune` contains `vary node.parameter in 0..=1;`, `minimise port;`, `maximise port;`, `require test;`, `require never port;`, `seeds 32;`, `holdout 32;` and the statements of a test";

const OUTSIDE: &str = "a source file contains `use`, `graph`, `robot`, `fsm`, `test` and `tune` items";

/// Explains an item that could not be parsed.
pub fn item(file: FileId, start: usize, text: &str) -> Diagnostic {
    let first = first_word(text);
    let first = if first.is_empty() { text.split_whitespace().next().unwrap_or_default() } else { first };
    let first = first.char_indices().nth(40).map_or(first, |(end, _)| &first[..end]);
    let span = Span::new(file, start, start + first.len());
    match first {
        "test" => again(Rule::test_item, file, start, text, OUTSIDE),
        "tune" => again(Rule::tune_item, file, start, text, OUTSIDE),
        "fsm" => again(Rule::fsm_item, file, start, text, OUTSIDE),
        "use" => again(Rule::use_item, file, start, text, "an import is `use path::{Name, …};`"),
        "pub" | "graph" | "robot" => again(Rule::graph_item, file, start, text, OUTSIDE),
        _ if text.trim_start().starts_with("///") => again(Rule::graph_item, file, start, text, OUTSIDE),
        _ => {
            let message = format!("no item begins with `{first}`");
            let error = Diagnostic::error("syntax", span, message).note(OUTSIDE);
            let known = keywords::words_at(KeywordPosition::Item).map(|word| word.text);
            match if first == "import" { Some("use") } else { nearest(first, known) } {
                Some(meant) => error.guess(format!("did you mean `{meant}`?"), span, meant),
                None => error,
            }
        }
    }
}

fn again(rule: Rule, file: FileId, start: usize, text: &str, otherwise: &str) -> Diagnostic {
    match Grammar::parse(rule, text) {
        Err(error) => diagnose(file, start, text, &error),
        Ok(_) => {
            let span = Span::new(file, start, start + text.trim_end().len());
            Diagnostic::error("syntax", span, "this is not allowed here").note(otherwise)
        }
    }
}

/// Turns an error of pest into a message. `text` begins at `start` of the file.
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
    // A statement that ends with its line needs only the semicolon, whatever else could follow.
    let before = text[..at].trim_end().len();
    let ends = text[before..at].contains('\n') || at >= text.trim_end().len() || text[at..].starts_with('}');
    if ends && expected.contains(&"`;`") {
        expected = vec!["`;`"];
    }
    let slip = CommonMistake { file, start, text, at, expected: &expected };
    if let Some(diagnostic) = slip.explained().filter(|_| expected != ["`;`"] || !ends) {
        return diagnostic;
    }
    let message = match expected.as_slice() {
        [] => "this does not belong here".to_owned(),
        [one] => format!("expected {one}"),
        [rest @ .., last] => format!("expected {} or {last}", rest.join(", ")),
    };
    // A missing token is reported behind the previous one, a wrong token at its own place.
    if ends {
        let behind = Span::new(file, start + before, start + before);
        let error = Diagnostic::error("syntax", behind, message);
        return if expected == ["`;`"] { error.fix("end the statement", behind, ";") } else { error };
    }
    let at = start + at;
    Diagnostic::error("syntax", Span::new(file, at, at + token(&text[at - start..])), message)
}

/// Length of the token at the start of `text`.
fn token(text: &str) -> usize {
    let word = text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(text.len());
    match text.as_bytes() {
        [b'-' | b'=', b'>', ..] => 2,
        _ if word > 0 => word,
        _ => text.chars().next().map_or(0, char::len_utf8),
    }
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
        Rule::expr | Rule::primary | Rule::number => "a value",
        Rule::string => "a string",
        Rule::binary => "an operator",
        Rule::plus_minus => "`+-`",
        Rule::use_group => "`{`",
        Rule::type_args | Rule::generics => "`<`",
        Rule::params => "`(`",
        Rule::range_op => "`..` or `..=`",
        Rule::node_kw => "`node`",
        Rule::claim_kw => "`claim`",
        Rule::thread_kw => "`thread`",
        Rule::setting => "a setting `name = value`",
        Rule::record_kw => "`record`",
        Rule::graph_kw => "`graph` or `robot`",
        Rule::actions => "`->`",
        Rule::target => "`=>`",
        Rule::hook_kw => "`entry` or `exit`",
        Rule::if_kw => "`if`",
        Rule::on_kw => "`on`",
        Rule::transition => "`on` or `after`",
        Rule::state_kw => "`state`",
        Rule::test_kw => "`test`",
        Rule::tune_kw => "`tune`",
        Rule::vary_kw => "`vary`",
        Rule::goal_kw => "`minimise` or `maximise`",
        Rule::at_kw => "`at`",
        Rule::require_kw => "`require`",
        Rule::seeds_kw => "`seeds`",
        Rule::holdout_kw => "`holdout`",
        Rule::fsm_kw => "`fsm`",
        Rule::compare => "a comparison",
        Rule::limit_kw => "`by` or `within`",
        Rule::never_kw => "`never`",
        Rule::expect_kw => "`expect`",
        Rule::wait_kw => "`wait`",
        Rule::feed_kw => "`feed`",
        Rule::replace_kw => "`replace`",
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
        // Modifiers, documentation and operators would make the list too long.
        _ => return None,
    })
}
