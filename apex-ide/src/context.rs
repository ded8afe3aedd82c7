//! Recognition of the context at a place from the tokens before it.

use super::lex::tokens_before;
use apex_dsl::syntax::MAX_DEPTH;
use apex_dsl::syntax::tokens::{Token, TokenKind, unit_start};

/// One end of a connection, as written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PortId {
    /// `node`, `node.port`
    Reference(Vec<String>),
    /// The path of a node that is written in place.
    InPlace(Vec<String>),
}

impl PortId {
    /// Returns `true` for `in.*`, `out.*` or `node.*`.
    pub fn is_each_port(&self) -> bool {
        matches!(self, Self::Reference(parts) if parts.last().is_some_and(|part| part == "*"))
    }
}

/// Role of a node or port that is named.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Named {
    /// End of a connection that sends.
    Sends,
    /// End of a connection that takes.
    Takes,
    /// Anything in the tested graph: its ports, its nodes and their ports.
    Tested,
    /// A port into which tokens can be fed.
    Fed,
    /// A node or nested graph.
    Node,
}

/// Quantity of a number that is being written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Quantity {
    /// Not known.
    Any,
    /// A time.
    Time,
    /// The quantity of this argument of this node.
    Argument(Vec<String>, String),
}

/// Context of a place: the kind of text that is expected there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Context {
    /// Text that cannot be guessed: a new name, a number.
    Nothing,
    /// An item.
    Item,
    /// The next segment of an import, behind these segments.
    Import(Vec<String>),
    /// The next segment of a path, behind `a::b::`.
    Path(Vec<String>),
    /// A type.
    Type,
    /// A statement of a graph.
    Statement,
    /// The constructor of a named node; `true` if the node is handed in.
    Constructor(bool),
    /// An end of a connection, with the opposite end of the arrow if there is one.
    Name(Named, Option<PortId>),
    /// A port of this node, with its role and the opposite end of the arrow.
    Port(PortId, Named, Option<PortId>),
    /// The name of an argument of this node, with the arguments that are given already.
    Argument(Vec<String>, Vec<String>),
    /// The value of this argument of this node.
    Value(Vec<String>, String),
    /// A time.
    Time,
    /// Any other value.
    Expression,
    /// The unit of a number.
    Unit(Quantity),
    /// A modifier behind an instance.
    Modifier,
    /// A list input of this node.
    List(Vec<String>),
    /// The kind of a claim.
    Claim,
    /// A statement of a state machine; `true` inside a state.
    Machine(bool),
    /// A state.
    State,
    /// A slot of the state machine.
    MachineSlot,
    /// An event of the state machine.
    MachineEvent,
    /// A statement of a test.
    Test,
    /// A statement of a study.
    Tune,
    /// The graph that is tested.
    Tested,
    /// A parameter that a study can vary; of this node, or else of any.
    Varied(Vec<String>),
    /// A test of the text.
    Required,
    /// One of these keywords.
    Words(&'static [&'static str]),
}

/// The context at `offset`, and the beginning of the word of which a part is written.
pub fn context(text: &str, offset: usize) -> (Context, usize) {
    let Some(mut tokens) = tokens_before(text, offset) else { return (Context::Nothing, offset) };
    if depth(&tokens) > MAX_DEPTH {
        return (Context::Nothing, offset);
    }
    let last = tokens.last().copied().filter(|t| t.start + t.text.len() == offset);
    match last {
        Some(Token { kind: TokenKind::Word, start, .. }) => {
            tokens.pop();
            (at_word(&tokens), start)
        }
        Some(Token { kind: TokenKind::Number, text, start }) => {
            tokens.pop();
            let start = start + unit_start(text);
            (unit(&tokens), start)
        }
        _ => (at_word(&tokens), offset),
    }
}

/// The unit of a number behind these tokens.
fn unit(tokens: &[Token<'_>]) -> Context {
    match at_word(tokens) {
        Context::Value(of, param) => Context::Unit(Quantity::Argument(of, param)),
        Context::Time => Context::Unit(Quantity::Time),
        Context::Nothing | Context::Expression => Context::Unit(Quantity::Any),
        _ => Context::Nothing,
    }
}

/// Number of open brackets, each of which is examined by recursion.
fn depth(tokens: &[Token<'_>]) -> usize {
    tokens.iter().fold(0_usize, |depth, token| match token.text {
        "(" | "[" | "{" => depth + 1,
        ")" | "]" | "}" => depth.saturating_sub(1),
        _ => depth,
    })
}

fn is(token: Option<&Token<'_>>, text: &str) -> bool {
    token.is_some_and(|t| t.text == text && !matches!(t.kind, TokenKind::Text { .. }))
}

/// The context of a word behind these tokens.
fn at_word(tokens: &[Token<'_>]) -> Context {
    if let Some(path) = path_before(tokens) {
        return in_import(tokens).map_or(Context::Path(path), Context::Import);
    }
    match opener(tokens) {
        None => outside(&tokens[statement(tokens, 0)..]),
        Some(open) => match tokens[open].text {
            "{" => in_braces(tokens, open),
            "(" => in_parens(tokens, open),
            _ => in_brackets(tokens, open),
        },
    }
}

/// The segments of a path that ends with `::`.
fn path_before(tokens: &[Token<'_>]) -> Option<Vec<String>> {
    let mut path = vec![];
    let mut rest = tokens;
    while let [before @ .., word, colons] = rest
        && colons.text == "::"
    {
        path.push(word.text.to_owned());
        rest = before;
    }
    path.reverse();
    (!path.is_empty()).then_some(path)
}

/// The path before the last token, if the tokens belong to an import.
fn in_import(tokens: &[Token<'_>]) -> Option<Vec<String>> {
    let mut at = tokens.len();
    let mut path = path_before(tokens).unwrap_or_default();
    // Go outwards through the groups to the keyword `use`.
    loop {
        let before = &tokens[..at];
        let start = before.iter().rposition(|t| matches!(t.text, ";" | "use")).unwrap_or(0);
        match opener(before) {
            Some(open) if open > start && is(tokens[..open].last(), "::") => {
                let outer = path_before(&tokens[..open])?;
                path = outer.into_iter().chain(path).collect();
                at = open;
            }
            Some(_) => return None,
            None => return is(tokens.get(start), "use").then_some(path),
        }
    }
}

/// The innermost open bracket.
fn opener(tokens: &[Token<'_>]) -> Option<usize> {
    let mut depth = 0_usize;
    for (i, token) in tokens.iter().enumerate().rev() {
        match token.text {
            ")" | "]" | "}" => depth += 1,
            "(" | "[" | "{" if depth == 0 => return Some(i),
            "(" | "[" | "{" => depth -= 1,
            // An item begins here: brackets that are still open before it were never closed.
            "pub" | "graph" | "robot" | "fsm" if depth == 0 && starts_item(tokens, i) => return None,
            _ => {}
        }
    }
    None
}

fn starts_item(tokens: &[Token<'_>], at: usize) -> bool {
    let named = tokens.get(at + 1).is_none_or(|t| t.kind == TokenKind::Word);
    named && (at == 0 || matches!(tokens[at - 1].text, ";" | "}"))
}

/// Beginning of the statement that is written last, at `from` or later.
fn statement(tokens: &[Token<'_>], from: usize) -> usize {
    let mut depth = 0_usize;
    for (i, token) in tokens.iter().enumerate().skip(from).rev() {
        match token.text {
            // A block ends a statement, a group of an import does not.
            "}" if depth == 0 && !ends_group(tokens, i) => return i + 1,
            ";" if depth == 0 => return i + 1,
            ")" | "]" | "}" => depth += 1,
            "(" | "[" | "{" => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    from
}

/// Returns `true` if the brace that closes at `at` was opened behind `::`.
fn ends_group(tokens: &[Token<'_>], at: usize) -> bool {
    opener(&tokens[..at]).is_some_and(|open| is(tokens[..open].last(), "::"))
}

/// The context outside all brackets.
fn outside(item: &[Token<'_>]) -> Context {
    match item {
        [] => Context::Item,
        [first] if first.text == "use" => Context::Import(vec![]),
        [first, .., last] if matches!(first.text, "test" | "tune") && last.text == ":" => Context::Tested,
        _ => Context::Nothing,
    }
}

fn in_braces(tokens: &[Token<'_>], open: usize) -> Context {
    if is(tokens[..open].last(), "::") {
        return match (in_import(tokens), tokens.last()) {
            (Some(path), Some(last)) if matches!(last.text, "{" | ",") => Context::Import(path),
            _ => Context::Nothing,
        };
    }
    let header = &tokens[header(tokens, open)..open];
    let written = &tokens[statement(tokens, open + 1)..];
    match header.first().map(|t| t.text) {
        Some("fsm") => in_machine(written, false),
        Some("state") => in_machine(written, true),
        Some("test") => in_test(written),
        Some("tune") => in_tune(written),
        Some("pub" | "graph" | "robot") => in_graph(written),
        Some("record") => in_record(written),
        _ => Context::Nothing,
    }
}

/// Beginning of the header of the block that opens at `open`.
fn header(tokens: &[Token<'_>], open: usize) -> usize {
    let before = &tokens[..open];
    statement(before, opener(before).map_or(0, |outer| outer + 1))
}

/// The context in a graph.
fn in_graph(written: &[Token<'_>]) -> Context {
    let Some(last) = written.last() else { return Context::Statement };
    match (written[0].text, written) {
        ("in" | "out" | "slot" | "event", [_, name, rest @ ..]) if name.kind == TokenKind::Word => typed(rest),
        ("in" | "out" | "slot" | "event", [_]) => Context::Nothing,
        ("node", [_]) | ("node", [_, _]) => Context::Nothing,
        ("node", [_, _, equals]) if equals.text == "=" => Context::Constructor(false),
        ("node", [_, _, colon]) if colon.text == ":" => Context::Constructor(true),
        ("node", [_, _, colon, ..]) if colon.text == ":" && last.text == "<" => Context::Type,
        ("claim", [_]) => Context::Claim,
        ("claim" | "record", _) => Context::Nothing,
        ("thread", [_]) => Context::Nothing,
        _ => behind_instance(written).unwrap_or_else(|| in_chain(written)),
    }
}

/// The context in a `record` block.
fn in_record(written: &[Token<'_>]) -> Context {
    match written.split_last() {
        None => Context::Name(Named::Node, None),
        Some((last, before)) if last.text == "." => {
            Context::Port(PortId::Reference(reference_before(before).0), Named::Tested, None)
        }
        Some(_) => Context::Nothing,
    }
}

/// The context behind the name in a declaration.
fn typed(written: &[Token<'_>]) -> Context {
    match written.last() {
        Some(last) if matches!(last.text, ":" | "<" | ",") => Context::Type,
        _ => Context::Nothing,
    }
}

/// Modifiers with a value.
const TIMES: [&str; 5] = ["every", "after", "timeout", "deadline", "delay"];

/// The context behind the arguments of an instance: a modifier, or the value of one.
fn behind_instance(written: &[Token<'_>]) -> Option<Context> {
    let last = written.last()?;
    let open = written.iter().any(|t| t.text == ")") || written.iter().any(|t| t.text == ":");
    let behind_value = written.len() > 1 && TIMES.contains(&written[written.len() - 2].text);
    match last.text {
        ")" => Some(Context::Modifier),
        "delay" if open => Some(Context::Expression),
        word if TIMES.contains(&word) && open => Some(Context::Time),
        "each" | "par" | "pipelined" | "skip" | "essential" | "restart" if open => Some(Context::Modifier),
        "on" if open => Some(Context::Nothing),
        "=" | "+" | "-" | "*" | "/" if open => Some(Context::Expression),
        _ if behind_value && open => Some(Context::Modifier),
        _ => None,
    }
}

/// The context in a chain of connections.
fn in_chain(written: &[Token<'_>]) -> Context {
    let Some(last) = written.last() else { return Context::Name(Named::Sends, None) };
    match last.text {
        "->" | "=>" => Context::Name(Named::Takes, end_before(&written[..written.len() - 1])),
        "." => {
            let name = &written[..written.len() - 1];
            let (of, start) = reference_before(name);
            let before = &name[..start];
            let other = arrow_before(before);
            let side = if other.is_some() || has_arrow(before) { Named::Takes } else { Named::Sends };
            Context::Port(PortId::Reference(of), side, other)
        }
        _ => Context::Nothing,
    }
}

fn has_arrow(tokens: &[Token<'_>]) -> bool {
    tokens.iter().any(|t| matches!(t.text, "->" | "=>"))
}

/// The end before the last arrow, also from inside an open list.
fn arrow_before(tokens: &[Token<'_>]) -> Option<PortId> {
    let at = tokens.iter().rposition(|t| matches!(t.text, "->" | "=>"))?;
    end_before(&tokens[..at])
}

/// The reference `a.b` at the end of these tokens, and its beginning.
fn reference_before(tokens: &[Token<'_>]) -> (Vec<String>, usize) {
    let mut parts = vec![];
    let mut at = tokens.len();
    while at > 0 && tokens[at - 1].kind == TokenKind::Word {
        parts.push(tokens[at - 1].text.to_owned());
        at -= 1;
        if at == 0 || tokens[at - 1].text != "." {
            break;
        }
        at -= 1;
    }
    parts.reverse();
    (parts, at)
}

/// The last end of a connection in these tokens.
fn end_before(tokens: &[Token<'_>]) -> Option<PortId> {
    let start = tokens.iter().rposition(|t| matches!(t.text, "->" | "=>")).map_or(0, |i| i + 1);
    let mut end = &tokens[start..];
    while end.first().is_some_and(|t| t.text == "[") {
        end = &end[1..];
    }
    let words = end.iter().take_while(|t| t.kind == TokenKind::Word || matches!(t.text, "." | "::" | "*"));
    let (mut parts, mut in_place, mut has_port) = (vec![], false, false);
    for token in words.clone() {
        match token.text {
            "::" => in_place = true,
            "." => has_port = true,
            word => parts.push(word.to_owned()),
        }
    }
    let is_instance = in_place || !has_port && end.get(words.count()).is_some_and(|t| matches!(t.text, "(" | "<"));
    match (parts.is_empty(), is_instance) {
        (true, _) => None,
        (_, true) => Some(PortId::InPlace(parts)),
        (_, false) => Some(PortId::Reference(parts)),
    }
}

fn in_parens(tokens: &[Token<'_>], open: usize) -> Context {
    let before = &tokens[..open];
    let header = &tokens[header(tokens, open)..open];
    let inside = &tokens[open + 1..];
    let word = before.last().filter(|t| t.kind == TokenKind::Word).map(|t| t.text);
    match (header.first().map(|t| t.text), header.len(), word) {
        (Some("graph" | "robot"), 2, _) | (Some("pub"), 3, _) => return in_parameters(inside),
        (Some("claim"), 2, _) => return Context::Name(Named::Node, None),
        (_, _, Some("active")) => return in_condition(inside),
        (_, _, Some("each" | "par")) => return each_of(before).map_or(Context::Nothing, Context::List),
        (_, _, Some(_)) if opener(before).is_some_and(|o| is_state(tokens, o)) => return Context::Expression,
        // A value for a slot.
        (_, _, Some(_)) if is(before.iter().rev().nth(1), ".") => return Context::Expression,
        (_, _, Some(_)) => {}
        _ => return nested(tokens, open),
    }
    in_arguments(path_of(before), inside)
}

fn is_state(tokens: &[Token<'_>], open: usize) -> bool {
    tokens[open].text == "{" && is(tokens.get(header(tokens, open)), "state")
}

/// The path `a::b` at the end of these tokens.
fn path_of(tokens: &[Token<'_>]) -> Vec<String> {
    match tokens.split_last() {
        Some((word, rest)) => {
            let mut path = path_before(rest).unwrap_or_default();
            path.push(word.text.to_owned());
            path
        }
        None => vec![],
    }
}

/// The node whose `each` is at the end of these tokens.
fn each_of(tokens: &[Token<'_>]) -> Option<Vec<String>> {
    let each = tokens.iter().rposition(|t| t.text == "each")?;
    let open = opener(tokens[..each].split_last().filter(|(last, _)| last.text == ")")?.1)?;
    Some(path_of(&tokens[..open]))
}

/// The context in brackets around a part of a value: that of the whole value.
fn nested(tokens: &[Token<'_>], open: usize) -> Context {
    match at_word(&tokens[..open]) {
        Context::Value(of, param) => Context::Value(of, param),
        around @ (Context::Expression | Context::Time) => around,
        _ => Context::Nothing,
    }
}

fn in_arguments(of: Vec<String>, inside: &[Token<'_>]) -> Context {
    let start = last_comma(inside);
    let given = |tokens: &[Token<'_>]| -> Vec<String> {
        let names = tokens.windows(2).filter(|w| w[0].kind == TokenKind::Word && w[1].text == "=");
        names.map(|w| w[0].text.to_owned()).collect()
    };
    match &inside[start..] {
        [] => Context::Argument(of, given(inside)),
        [name, equals, ..] if equals.text == "=" => Context::Value(of, name.text.to_owned()),
        _ => Context::Nothing,
    }
}

/// Beginning of the last element of a list.
fn last_comma(tokens: &[Token<'_>]) -> usize {
    let mut depth = 0_usize;
    for (i, token) in tokens.iter().enumerate().rev() {
        match token.text {
            ")" | "]" | "}" => depth += 1,
            "(" | "[" | "{" => depth = depth.saturating_sub(1),
            "," if depth == 0 => return i + 1,
            _ => {}
        }
    }
    0
}

/// The context in the parameters of a graph.
fn in_parameters(inside: &[Token<'_>]) -> Context {
    let written = &inside[last_comma(inside)..];
    match written.last().map(|t| t.text) {
        Some(":" | "<") => Context::Type,
        Some("=" | "in" | ".." | "..=" | "+" | "-" | "*" | "/") => Context::Expression,
        _ => Context::Nothing,
    }
}

fn in_brackets(tokens: &[Token<'_>], open: usize) -> Context {
    let inside = &tokens[open + 1..];
    let begins = inside.is_empty() || inside.last().is_some_and(|t| t.text == ",");
    match at_word(&tokens[..open]) {
        Context::Name(named, other) if begins => Context::Name(named, other),
        Context::Statement if begins => Context::Name(Named::Sends, None),
        Context::Name(..) | Context::Statement if is(inside.last(), ".") => {
            let (of, _) = reference_before(&inside[..inside.len() - 1]);
            let other = arrow_before(&tokens[header(tokens, open)..open]);
            let named = if other.is_some() { Named::Takes } else { Named::Sends };
            Context::Port(PortId::Reference(of), named, other)
        }
        Context::Name(..) if is(inside.last(), ")") => Context::Modifier,
        Context::Type if begins => Context::Type,
        Context::Value(of, param) => Context::Value(of, param),
        Context::Expression => Context::Expression,
        Context::Nothing if inside.is_empty() && tokens[..open].last().is_some_and(|t| t.kind == TokenKind::Word) => {
            Context::Unit(Quantity::Any)
        }
        _ => Context::Nothing,
    }
}

fn in_machine(written: &[Token<'_>], in_state: bool) -> Context {
    let Some(last) = written.last() else { return Context::Machine(in_state) };
    match (written[0].text, last.text) {
        ("slot" | "event", ":") => Context::Type,
        ("on", "on") => Context::MachineSlot,
        ("on" | "after", "=>") => Context::State,
        ("after", "after") => Context::Expression,
        ("on" | "after", "resume" | "repeat") if written.iter().rev().nth(1).is_some_and(|t| t.text == "=>") => {
            Context::State
        }
        ("on", "if") => Context::Expression,
        ("on" | "after" | "entry" | "exit", "->") => Context::MachineEvent,
        ("on" | "after" | "entry" | "exit", ",") if has_arrow(written) => Context::MachineEvent,
        ("on", _) if written.len() == 2 => Context::Words(&["if"]),
        _ => Context::Nothing,
    }
}

fn in_tune(written: &[Token<'_>]) -> Context {
    let Some(last) = written.last() else { return Context::Tune };
    match (written[0].text, last.text) {
        ("vary", "vary") => Context::Varied(vec![]),
        ("vary", ".") => Context::Varied(reference_before(&written[1..written.len() - 1]).0),
        ("vary", "in" | ".." | "..=" | "+" | "-" | "*" | "/") => Context::Expression,
        ("vary", _) if !written.iter().any(|t| t.text == "in") => Context::Words(&["in"]),
        ("minimise" | "maximise", _) if written.len() == 1 => Context::Name(Named::Tested, None),
        ("minimise" | "maximise", ".") => in_condition(&written[1..]),
        ("minimise" | "maximise", _) if !written.iter().any(|t| t.text == "at") => Context::Words(&["at"]),
        ("require", "require" | ",") => Context::Required,
        ("require", _) if written.get(1).is_some_and(|t| t.text == "never") => in_test(&written[1..]),
        ("vary" | "minimise" | "maximise" | "require" | "seeds" | "holdout", _) => Context::Nothing,
        _ => in_test(written),
    }
}

fn in_test(written: &[Token<'_>]) -> Context {
    let Some(last) = written.last() else { return Context::Test };
    match (written[0].text, last.text) {
        ("expect" | "never", _) if written.len() == 1 => Context::Name(Named::Tested, None),
        ("expect" | "never", "." | "==" | "!=" | "<" | ">") => in_condition(&written[1..]),
        ("expect", "by" | "within") | ("wait", "wait") | (_, "every") => Context::Time,
        ("feed", "feed") => Context::Name(Named::Fed, None),
        ("feed", "=") => Context::Expression,
        ("feed", _) => Context::Words(&["every"]),
        ("replace", "replace") => Context::Name(Named::Node, None),
        ("replace", ".") => in_condition(&written[1..]),
        ("replace", "=") => Context::Constructor(false),
        ("replace", ")") => Context::Modifier,
        ("expect", _) => Context::Words(&["by", "within"]),
        _ => Context::Nothing,
    }
}

/// The context in a condition of a test.
fn in_condition(inside: &[Token<'_>]) -> Context {
    match inside.split_last() {
        None => Context::Name(Named::Node, None),
        Some((last, before)) if last.text == "." => {
            Context::Port(PortId::Reference(reference_before(before).0), Named::Tested, None)
        }
        Some(_) => Context::Expression,
    }
}

#[cfg(test)]
mod tests;
