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
    /// The beginning of a statement of a study, which has those of a test, too.
    Tune,
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
pub const KEYWORDS: [Keyword; 68] = [
    keyword(
        "use",
        KeywordPosition::Item,
        "Imports nodes and types of a crate, or graphs of a source file in the same folder.",
    ),
    keyword("pub", KeywordPosition::Item, "A graph that is a program, too, if another graph contains it."),
    keyword("graph", KeywordPosition::Item, "A graph: ports, nodes and connections. It can be used as a node."),
    keyword("robot", KeywordPosition::Item, "A graph without ports: the program of one machine."),
    keyword("fsm", KeywordPosition::Item, "A state machine: slots, events, and states with transitions."),
    keyword("test", KeywordPosition::Item, "Runs a graph on simulated time."),
    keyword("tune", KeywordPosition::Item, "Searches the parameters of a graph: a test with `vary` and `minimise`."),
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
        "A statement about activity that must hold in every run. The compiler proves or refutes it.",
    ),
    keyword(
        "thread",
        KeywordPosition::Graph,
        "The settings of a thread: `thread vision { cores = [1]; priority = 80 }`.",
    ),
    keyword(
        "record",
        KeywordPosition::Graph,
        "The file in which a run is recorded, and ports whose tokens are recorded besides those of the sources.",
    ),
    keyword("slot", KeywordPosition::Machine, "A slot: its tokens trigger transitions."),
    keyword("event", KeywordPosition::Machine, "An event: triggered by transitions."),
    keyword("state", KeywordPosition::Machine, "A state. It may contain other states."),
    keyword(
        "on",
        KeywordPosition::Machine,
        "A transition for the tokens of a slot: `on slot if guard => state -> event;`.",
    ),
    keyword(
        "after",
        KeywordPosition::Machine,
        "A transition when the machine has been in the state for some time: `after 5s => state -> event;`.",
    ),
    keyword("entry", KeywordPosition::Machine, "Events that are triggered when the state is entered."),
    keyword("exit", KeywordPosition::Machine, "Events that are triggered when the state is left."),
    keyword("replace", KeywordPosition::Test, "Replaces a node of the graph by another one."),
    keyword("feed", KeywordPosition::Test, "Puts tokens into an input or slot of the graph."),
    keyword("wait", KeywordPosition::Test, "Lets time pass."),
    keyword(
        "expect",
        KeywordPosition::Test,
        "Requires that something has happened by now, or happens `within` or `by` a time.",
    ),
    keyword("never", KeywordPosition::Test, "Requires that something does not happen from here on."),
    keyword(
        "vary",
        KeywordPosition::Tune,
        "A parameter whose value is searched: `vary node.parameter in 0..=1`, by default in its declared range.",
    ),
    keyword(
        "minimise",
        KeywordPosition::Tune,
        "The output whose last value in a run should be small: `minimise node.error at 90%`, which nine of ten seeds reach.",
    ),
    keyword("maximise", KeywordPosition::Tune, "The output whose last value in a run should be great."),
    keyword(
        "require",
        KeywordPosition::Tune,
        "Tests that must pass with the values, or `never what`: what must not happen in any run.",
    ),
    keyword("seeds", KeywordPosition::Tune, "The number of runs with each set of values, which differ in their seed."),
    keyword(
        "holdout",
        KeywordPosition::Tune,
        "Seeds or a recording (`holdout \"other.mcap\"`) that only score the result.",
    ),
    keyword("every", KeywordPosition::Modifier, "The source fires at 0 and then once per period."),
    keyword("after", KeywordPosition::Modifier, "The first firing of the source; without `every` the only one."),
    keyword(
        "timeout",
        KeywordPosition::Modifier,
        "The node triggers its event `timeout` when it has been active for this time.",
    ),
    keyword(
        "deadline",
        KeywordPosition::Modifier,
        "The maximum age of the oldest token at the end of a firing. If it is older, the node triggers `late`.",
    ),
    keyword("on", KeywordPosition::Modifier, "The thread that the node runs on."),
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
    keyword(
        "pipelined",
        KeywordPosition::Modifier,
        "The node releases its inputs as soon as it has fired, before the nodes downstream have.",
    ),
    keyword(
        "skip",
        KeywordPosition::Modifier,
        "A late source skips the firings that it has missed, but for the last one.",
    ),
    keyword("essential", KeywordPosition::Modifier, "The node processes ⊥, too."),
    keyword("restart", KeywordPosition::Modifier, "After a failure, the node is replaced by a new one."),
    keyword("par", KeywordPosition::Inside, "`each par`: processes the elements in parallel, with the same result."),
    keyword("as", KeywordPosition::Inside, "Imports under another name."),
    keyword("if", KeywordPosition::Inside, "The transition is taken only if this condition holds."),
    keyword("resume", KeywordPosition::Inside, "Continues in the last of its innermost states: `=> resume work`."),
    keyword("repeat", KeywordPosition::Inside, "Begins the last state inside again: `=> repeat work`."),
    keyword("by", KeywordPosition::Inside, "The latest time at which it is expected, counted from the start."),
    keyword(
        "within",
        KeywordPosition::Inside,
        "The latest time at which it is expected, counted from the previous step.",
    ),
    keyword("recording", KeywordPosition::Inside, "The tokens that passed a port in a recorded run, at their times."),
    keyword(
        "at",
        KeywordPosition::Inside,
        "The share of the seeds that must reach the value of a goal; 50% is the median.",
    ),
    keyword("active", KeywordPosition::Inside, "True if a node or nested graph is active."),
    keyword("in", KeywordPosition::Inside, "The range of a parameter: `gap: f32[m] = 0.1 in 0..=1`."),
    keyword("true", KeywordPosition::Value, "True."),
    keyword("false", KeywordPosition::Value, "False."),
    keyword("start", KeywordPosition::Node, "The event with which activity begins."),
    keyword(
        "hung",
        KeywordPosition::Node,
        "An event: triggered when a node has been running for longer than the `hang` of its thread.",
    ),
    keyword(
        "set_back",
        KeywordPosition::Node,
        "An event: triggered when the time has gone back, as when a recording is looped.",
    ),
    keyword("reset", KeywordPosition::Node, "A slot that deactivates all nodes and triggers `start` again."),
    keyword("exit", KeywordPosition::Node, "A slot that ends the program with code 0."),
    keyword("abort", KeywordPosition::Node, "A slot that ends the program with code 1."),
    keyword("exclusive", KeywordPosition::Claim, "No two of the nodes are ever active at the same time."),
    keyword(
        "reaches",
        KeywordPosition::Claim,
        "Whenever the first node is active, there is a path on which activity can reach the second.",
    ),
    keyword(
        "conserved",
        KeywordPosition::Claim,
        "The amount of activity in the program is always that created by `start`.",
    ),
    keyword("live", KeywordPosition::Claim, "The tokens of events never wait for one another."),
    keyword("crate", KeywordPosition::Inside, "The package of the source file."),
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
        let is_word = |name: &str| {
            name.ends_with("_kw") || ["port_kind", "pipelined", "skip", "essential", "restart"].contains(&name)
        };
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
