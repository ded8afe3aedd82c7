//! Keywords of the language, for completion, hover and colours in editors. The grammars in `editors/` are tested
//! against this list.

/// Position of a keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
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
pub struct Word {
    /// The keyword.
    pub text: &'static str,
    /// Its position.
    pub place: Place,
    /// Its documentation.
    pub docs: &'static str,
}

const fn word(text: &'static str, place: Place, docs: &'static str) -> Word {
    Word { text, place, docs }
}

/// All keywords. A keyword with several positions has several entries.
pub const WORDS: [Word; 53] = [
    word("use", Place::Item, "Imports nodes and types of a crate, or graphs of a text in the same folder."),
    word("graph", Place::Item, "A graph: ports, nodes and connections. It is used as a node is."),
    word("robot", Place::Item, "A graph without ports: what runs on one machine."),
    word("fsm", Place::Item, "A state machine: slots, events, and states in which tokens lead on."),
    word("test", Place::Item, "Runs a graph on simulated time."),
    word("in", Place::Graph, "An input: synchronous, takes tokens."),
    word("out", Place::Graph, "An output: synchronous, sends tokens."),
    word("slot", Place::Graph, "A slot: asynchronous, takes tokens."),
    word("event", Place::Graph, "An event: asynchronous, sends tokens."),
    word(
        "node",
        Place::Graph,
        "A node with a name: `node name = Type();`, or `node name: Type;` if it is made in Rust.",
    ),
    word(
        "claim",
        Place::Graph,
        "Something that must be true of activity in every run; decided before the program runs.",
    ),
    word(
        "thread",
        Place::Graph,
        "What is said about the thread of a group: `thread vision { cores = [1]; priority = 80 }`.",
    ),
    word(
        "record",
        Place::Graph,
        "The file in which a run is recorded, and ports whose tokens are recorded besides those of the sources.",
    ),
    word("slot", Place::Machine, "A slot: what it takes leads from state to state."),
    word("event", Place::Machine, "An event: what transitions trigger."),
    word("state", Place::Machine, "A state. It may have states inside."),
    word("on", Place::Machine, "What happens when a token comes to a slot: `on slot if guard => state -> event;`."),
    word("entry", Place::Machine, "Events that are triggered when the state is entered."),
    word("exit", Place::Machine, "Events that are triggered when the state is left."),
    word("replace", Place::Test, "Another node stands for the one of the graph."),
    word("feed", Place::Test, "Puts tokens into an input or slot of the graph."),
    word("wait", Place::Test, "Lets time pass."),
    word("expect", Place::Test, "It has happened by now, or does `within` or `by` a time."),
    word("never", Place::Test, "From here on it does not happen."),
    word("every", Place::Modifier, "The source fires at 0 and then once per period."),
    word("after", Place::Modifier, "The source fires at that time for the first time; without `every` only then."),
    word("timeout", Place::Modifier, "The node triggers its event `timeout` when it has been active for so long."),
    word(
        "deadline",
        Place::Modifier,
        "How long after the firing of its source the node must have finished; else it triggers `late`.",
    ),
    word("on", Place::Modifier, "The group of threads that the node runs in."),
    word("each", Place::Modifier, "Runs once per element of a list input; results are collected in order."),
    word(
        "delay",
        Place::Modifier,
        "Holds the outputs back for as many iterations as there are initial tokens. Breaks cycles.",
    ),
    word("pipelined", Place::Modifier, "Begins with the next token before it is done with the last."),
    word("essential", Place::Modifier, "The node wants to see ⊥."),
    word("restart", Place::Modifier, "After a failure the node is made anew."),
    word("par", Place::Inside, "`each par`: the elements in parallel, with the same result."),
    word("as", Place::Inside, "Gives what is imported another name."),
    word("if", Place::Inside, "The transition is taken only where this holds."),
    word("by", Place::Inside, "Until when it is expected, counted from the start."),
    word("within", Place::Inside, "Until when it is expected, counted from the step before."),
    word("recording", Place::Inside, "The tokens that passed a port in a recorded run, at their times."),
    word("active", Place::Inside, "Whether a node or nested graph is active."),
    word("in", Place::Inside, "The range of a parameter: `gap: f32[m] = 0.1 in 0..=1`."),
    word("true", Place::Value, "True."),
    word("false", Place::Value, "False."),
    word("start", Place::Node, "Where activity begins."),
    word("hung", Place::Node, "An event: a node has been running for longer than the `hang` of its thread."),
    word("reset", Place::Node, "A slot: nothing is active any more, and `start` happens again."),
    word("exit", Place::Node, "A slot that ends the program with code 0."),
    word("abort", Place::Node, "A slot that ends the program with code 1."),
    word("exclusive", Place::Claim, "No two of them are ever active at the same time."),
    word(
        "reaches",
        Place::Claim,
        "Whenever the first is active, there is a way on which activity can come to the second.",
    ),
    word("conserved", Place::Claim, "There is always as much activity in the program as `start` gave."),
    word("crate", Place::Inside, "The package that the text belongs to."),
];

/// The keywords with one position.
pub fn words_at(place: Place) -> impl Iterator<Item = &'static Word> {
    WORDS.iter().filter(move |w| w.place == place)
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
                    assert!(WORDS.iter().any(|w| w.text == text), "`{text}` of `{name}` is not in the list");
                }
            } else if name == "reserved" {
                assert_eq!(words(rule), RESERVED);
            }
        }
        for word in
            WORDS.iter().filter(|w| !matches!(w.place, Place::Node | Place::Claim | Place::Value) && w.text != "crate")
        {
            assert!(grammar.contains(&format!("\"{}\"", word.text)), "`{}` is not in the grammar", word.text);
        }
    }
}
