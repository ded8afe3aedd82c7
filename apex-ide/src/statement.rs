//! The statement of a graph at a place, also in a text that cannot be parsed: what an error there concerns.

use apex_dsl::syntax::tokens::{Token, TokenKind, tokens};

/// A statement of a graph.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Statement<'t> {
    /// Name of the graph.
    pub graph: &'t str,
    /// Names of the nodes in it: the declared one, or those at both ends of each connection in the range. Ports of the
    /// graph itself are among them.
    pub names: Vec<&'t str>,
    /// `true` if it connects nodes.
    pub connects: bool,
}

/// The statement that contains a range of bytes; `None` outside of graphs.
pub fn statement(text: &str, from: usize, to: usize) -> Option<Statement<'_>> {
    let is_code =
        |t: &Token<'_>| !matches!(t.kind, TokenKind::Blank | TokenKind::LineComment | TokenKind::BlockComment { .. });
    let all: Vec<Token<'_>> = tokens(text).filter(is_code).collect();
    // A place between two tokens belongs to the one before.
    let at = all.iter().rposition(|token| token.start <= from)?;
    let graph = graph_around(&all[..at])?;
    let ends = |token: &Token<'_>| matches!(token.text, ";" | "{" | "}");
    let start = all[..at].iter().rposition(ends).map_or(0, |end| end + 1);
    let length = all[at..].iter().position(ends).unwrap_or(all.len() - at);
    let all = &all[start..at + length];
    let word = |at: usize| all.get(at).filter(|token| token.kind == TokenKind::Word).map(|token| token.text);
    if word(0) == Some("node") {
        return Some(Statement { graph, names: word(1).into_iter().collect(), connects: false });
    }
    let is_arrow = |token: &&Token<'_>| matches!(token.text, "->" | "=>");
    let mut names = vec![];
    for part in all.split(|token| is_arrow(&token)) {
        // The part of a chain with both arrows around it.
        let (Some(first), Some(last)) = (part.first(), part.last()) else { continue };
        names.push((name(part), first.start.saturating_sub(3), last.end() + 3));
    }
    let connects = names.len() > 1;
    let (from, to) = (from, to.max(from + 1));
    let touched: Vec<bool> = names.iter().map(|(_, start, end)| *start < to && from < *end).collect();
    // A single end stands for its connections on both sides.
    let near = |at: usize| {
        let is = |at: Option<usize>| at.and_then(|at| touched.get(at)).is_some_and(|touched| *touched);
        is(Some(at)) || touched.iter().filter(|t| **t).count() == 1 && (is(at.checked_sub(1)) || is(Some(at + 1)))
    };
    let names = names.iter().enumerate().filter(|(at, _)| near(*at)).filter_map(|(_, (name, ..))| *name).collect();
    Some(Statement { graph, names, connects })
}

/// Name of the node at an end of a connection: `a` of `a.b`, `find` of `find()`.
fn name<'t>(part: &[Token<'t>]) -> Option<&'t str> {
    part.iter().find(|token| token.kind == TokenKind::Word).map(|token| token.text)
}

/// Name of the graph whose braces are open at the end.
fn graph_around<'t>(tokens: &[Token<'t>]) -> Option<&'t str> {
    let mut open = 0_i32;
    for (at, token) in tokens.iter().enumerate().rev() {
        match token.text {
            "}" => open += 1,
            "{" => open -= 1,
            "graph" | "robot" if open < 0 => {
                return tokens.get(at + 1).filter(|name| name.kind == TokenKind::Word).map(|name| name.text);
            }
            "fsm" | "test" | "tune" if open < 0 => return None,
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "graph A { node x = X(); x -> y; }\nrobot B {\n  node a = A() every 5ms;\n  a.out -> f(2) -> b.in; // c\n  b -> out\n";

    fn at(words: &str) -> Option<(&str, Vec<&str>, bool)> {
        let from = TEXT.find(words).expect("it is there");
        statement(TEXT, from, from + words.len()).map(|s| (s.graph, s.names, s.connects))
    }

    #[test]
    fn nodes_and_connections_are_found_also_in_half_written_texts() {
        assert_eq!(at("X()"), Some(("A", vec!["x"], false)));
        assert_eq!(at("x -> y"), Some(("A", vec!["x", "y"], true)));
        assert_eq!(at("5ms"), Some(("B", vec!["a"], false)));
        assert_eq!(at("-> f(2)"), Some(("B", vec!["a", "f"], true)));
        assert_eq!(at("b.in"), Some(("B", vec!["f", "b"], true)));
        assert_eq!(at("b -> out"), Some(("B", vec!["b", "out"], true)));
        assert_eq!(at("graph A"), None);
        assert_eq!(at("robot B"), None);
    }
}
