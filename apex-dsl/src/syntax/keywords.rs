//! Keywords of the language, for completion, hover and colours in editors. The grammars in `editors/` are tested
//! against this list.

/// Position of a keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeywordPosition {
    /// The beginning of an item.
    Item,
    /// The beginning of a statement of a graph.
    Graph,
    /// The beginning of a statement of a state machine or of a state.
    Machine,
    /// The beginning of a statement of a test.
    Test,
    /// A modifier behind an instance.
    Modifier,
    /// The inside of a statement.
    Inside,
    /// A value.
    Value,
    /// A predefined node, which every graph has unless one of its own nodes has that name.
    Node,
    /// The kind of a claim.
    Claim,
}

/// A keyword.
#[derive(Debug, Clone, Copy)]
pub struct Keyword {
    /// The keyword.
    pub text: &'static str,
    /// Its position.
    pub position: KeywordPosition,
    /// Its documentation.
    pub docs: &'static str,
}

const fn keyword(text: &'static str, position: KeywordPosition, docs: &'static str) -> Keyword {
    Keyword { text, position, docs }
}

/// All keywords. A keyword with several positions has several entries.
pub const KEYWORDS: [Keyword; 53] = [
    keyword(
        "use",
        KeywordPosition::Item,
        "Imports nodes and types of a crate, or graphs of a text in the same folder.",
    ),
    keyword("graph", KeywordPosition::Item, "A graph: ports, nodes and connections. It is used as a node is."),
    keyword("robot", KeywordPosition::Item, "A graph without ports: what runs on one machine."),
    keyword("fsm", KeywordPosition::Item, "A state machine: slots, events, and states in which tokens lead on."),
    keyword("test", KeywordPosition::Item, "Runs a graph on simulated time."),
    keyword("in", KeywordPosition::Graph, "An input: synchronous, takes tokens."),
    keyword("out", KeywordPosition::Graph, "An output: synchronous, sends tokens."),
    keyword("slot", KeywordPosition::Graph, "A slot: asynchronous, takes tokens."),
    keyword("event", KeywordPosition::Graph, "An event: asynchronous, sends tokens."),
    keyword(
        "node",
        KeywordPosition::Graph,
        "A node with a name: `node name = Type();`, or `node name: Type;` if it is made in Rust.",
    ),
    keyword(
        "claim",
        KeywordPosition::Graph,
        "Something that must be true of activity in every run; decided before the program runs.",
    ),
    keyword(
        "thread",
        KeywordPosition::Graph,
        "What is said about the thread of a group: `thread vision { cores = [1]; priority = 80 }`.",
    ),
    keyword(
        "record",
        KeywordPosition::Graph,
        "The file in which a run is recorded, and ports whose tokens are recorded besides those of the sources.",
    ),
    keyword("slot", KeywordPosition::Machine, "A slot: what it takes leads from state to state."),
    keyword("event", KeywordPosition::Machine, "An event: what transitions trigger."),
    keyword("state", KeywordPosition::Machine, "A state. It may have states inside."),
    keyword(
        "on",
        KeywordPosition::Machine,
        "What happens when a token comes to a slot: `on slot if guard => state -> event;`.",
    ),
    keyword("entry", KeywordPosition::Machine, "Events that are triggered when the state is entered."),
    keyword("exit", KeywordPosition::Machine, "Events that are triggered when the state is left."),
    keyword("replace", KeywordPosition::Test, "Another node stands for the one of the graph."),
    keyword("feed", KeywordPosition::Test, "Puts tokens into an input or slot of the graph."),
    keyword("wait", KeywordPosition::Test, "Lets time pass."),
    keyword("expect", KeywordPosition::Test, "It has happened by now, or does `within` or `by` a time."),
    keyword("never", KeywordPosition::Test, "From here on it does not happen."),
    keyword("every", KeywordPosition::Modifier, "The source fires at 0 and then once per period."),
    keyword(
        "after",
        KeywordPosition::Modifier,
        "The source fires at that time for the first time; without `every` only then.",
    ),
    keyword(
        "timeout",
        KeywordPosition::Modifier,
        "The node triggers its event `timeout` when it has been active for so long.",
    ),
    keyword(
        "deadline",
        KeywordPosition::Modifier,
        "How long after the firing of its source the node must have finished; else it triggers `late`.",
    ),
    keyword("on", KeywordPosition::Modifier, "The group of threads that the node runs in."),
    keyword(
        "each",
        KeywordPosition::Modifier,
        "Runs once per element of a list input; results are collected in order.",
    ),
    keyword(
        "delay",
        KeywordPosition::Modifier,
        "Holds the outputs back for as many iterations as there are initial tokens. Breaks cycles.",
    ),
    keyword("pipelined", KeywordPosition::Modifier, "Begins with the next token before it is done with the last."),
    keyword("essential", KeywordPosition::Modifier, "The node wants to see ⊥."),
    keyword("restart", KeywordPosition::Modifier, "After a failure the node is made anew."),
    keyword("par", KeywordPosition::Inside, "`each par`: the elements in parallel, with the same result."),
    keyword("as", KeywordPosition::Inside, "Gives what is imported another name."),
    keyword("if", KeywordPosition::Inside, "The transition is taken only where this holds."),
    keyword("by", KeywordPosition::Inside, "Until when it is expected, counted from the start."),
    keyword("within", KeywordPosition::Inside, "Until when it is expected, counted from the step before."),
    keyword("recording", KeywordPosition::Inside, "The tokens that passed a port in a recorded run, at their times."),
    keyword("active", KeywordPosition::Inside, "Whether a node or nested graph is active."),
    keyword("in", KeywordPosition::Inside, "The range of a parameter: `gap: f32[m] = 0.1 in 0..=1`."),
    keyword("true", KeywordPosition::Value, "True."),
    keyword("false", KeywordPosition::Value, "False."),
    keyword("start", KeywordPosition::Node, "Where activity begins."),
    keyword(
        "hung",
        KeywordPosition::Node,
        "An event: a node has been running for longer than the `hang` of its thread.",
    ),
    keyword("reset", KeywordPosition::Node, "A slot: nothing is active any more, and `start` happens again."),
    keyword("exit", KeywordPosition::Node, "A slot that ends the program with code 0."),
    keyword("abort", KeywordPosition::Node, "A slot that ends the program with code 1."),
    keyword("exclusive", KeywordPosition::Claim, "No two of them are ever active at the same time."),
    keyword(
        "reaches",
        KeywordPosition::Claim,
        "Whenever the first is active, there is a way on which activity can come to the second.",
    ),
    keyword("conserved", KeywordPosition::Claim, "There is always as much activity in the program as `start` gave."),
    keyword("crate", KeywordPosition::Inside, "The package that the text belongs to."),
];

/// The keywords with one position.
pub fn words_at(position: KeywordPosition) -> impl Iterator<Item = &'static Keyword> {
    KEYWORDS.iter().filter(move |w| w.position == position)
}

/// Words that cannot be names. The last five are words of Rust that cannot even be raw identifiers.
pub const RESERVED: [&str; 17] = [
    "use", "graph", "robot", "node", "in", "out", "slot", "event", "claim", "record", "true", "false", "self", "Self",
    "super", "crate", "_",
];

/// Returns `true` if `text` can be a name.
pub fn is_name(text: &str) -> bool {
    let begins = text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    begins && text.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_') && !RESERVED.contains(&text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The keywords of the grammar are in the list: those of rules that end in `_kw` and of a few others.
    #[test]
    fn the_grammar_has_these_words() {
        let grammar = include_str!("afg.pest");
        let words = |line: &str| -> Vec<String> { line.split('"').skip(1).step_by(2).map(str::to_owned).collect() };
        let is_word =
            |name: &str| name.ends_with("_kw") || ["port_kind", "pipelined", "essential", "restart"].contains(&name);
        let rules = grammar.lines().filter_map(|line| line.split_once('=')).map(|(name, rule)| (name.trim(), rule));
        for (name, rule) in rules {
            if is_word(name) {
                for text in words(rule) {
                    assert!(KEYWORDS.iter().any(|w| w.text == text), "`{text}` of `{name}` is not in the list");
                }
            } else if name == "reserved" {
                assert_eq!(words(rule), RESERVED);
            }
        }
        for keyword in KEYWORDS.iter().filter(|w| {
            !matches!(w.position, KeywordPosition::Node | KeywordPosition::Claim | KeywordPosition::Value)
                && w.text != "crate"
        }) {
            assert!(grammar.contains(&format!("\"{}\"", keyword.text)), "`{}` is not in the grammar", keyword.text);
        }
    }
}
