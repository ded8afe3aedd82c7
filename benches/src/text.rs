//! Source files that are too long to be written by hand.

#[path = "mixed.rs"]
mod mixed;

use std::fmt::Write as _;

/// Paths relative to this package, and contents of all generated files.
pub fn files() -> Vec<(String, String)> {
    let formatted = |text: String| apex_ide::format(&text).unwrap_or(text);
    let graphs = all().into_iter().map(|(name, text)| (format!("graphs/{name}"), formatted(text)));
    graphs.chain([("src/hand/mixed1000.rs".to_owned(), mixed::rust())]).collect()
}

/// Names and contents of all generated graphs.
fn all() -> Vec<(String, String)> {
    let chains = [3, 10, 100, 1000].map(|n| (format!("chain{n}.afg"), chain(n)));
    let silent = [10, 100, 1000].map(|n| (format!("silent{n}.afg"), silent(n)));
    let diamonds = [8, 64].map(|w| (format!("diamond{w}.afg"), diamond(w)));
    let filtered = [("bot100.afg".to_owned(), bot100()), ("merge8.afg".to_owned(), merge8())];
    let machines = [("fsm16.afg".to_owned(), machine()), ("fsm16nodes.afg".to_owned(), state_nodes())];
    let mixed = ("mixed1000.afg".to_owned(), mixed::graph());
    chains.into_iter().chain(silent).chain(diamonds).chain(filtered).chain([mixed]).chain(machines).collect()
}

fn chain(n: u32) -> String {
    let ops = ops(1, n);
    format!(
        "/// {n} operations in a row.\ngraph Chain{n} {{\n    node source = Count();\n    node sink = Sink();\n\n    \
         source{ops}\n        -> sink;\n}}\n"
    )
}

fn silent(n: u32) -> String {
    let ops = ops(1, n);
    format!(
        "/// {n} operations in a row that never get a message.\ngraph Silent{n} {{\n    node source = Silent();\n    \
         node sink = Sink();\n\n    source{ops}\n        -> sink;\n}}\n"
    )
}

fn bot100() -> String {
    let ops = ops(3, 100);
    format!(
        "/// A filter that passes 1 % in front of 98 operations.\ngraph Bot100 {{\n    node source = Count();\n    \
         node sink = Sink();\n\n    source -> op(k = 1) -> OneOf(period = 100){ops}\n        -> sink;\n}}\n"
    )
}

fn diamond(w: u32) -> String {
    let mut text = format!(
        "/// {w} operations side by side, and their sum.\ngraph Diamond{w} {{\n    node source = Count();\n    \
         node all = total();\n    node sink = Sink();\n\n"
    );
    for k in 1..=w {
        let _ = writeln!(text, "    source -> op(k = {k}) -> all;");
    }
    text.push_str("    all -> sink;\n}\n");
    text
}

fn merge8() -> String {
    let filters: Vec<String> = (2..10).map(|period| format!("OneOf(period = {period})")).collect();
    format!(
        "/// The first of 8 filters that passes a value.\ngraph Merge8 {{\n    node source = Count();\n    \
         node sink = Sink();\n\n    source -> [{}] -> first() -> sink;\n}}\n",
        filters.join(", ")
    )
}

/// Number of states.
const STATES: u32 = 16;

fn machine() -> String {
    let mut text =
        "/// A ring of 16 states.\nfsm Ring {\n    slot next;\n    slot reset;\n    event entered: u64;\n\n".to_owned();
    for s in 0..STATES {
        let _ = writeln!(
            text,
            "    state s{s} {{ entry -> entered({}); on next => s{}; on reset => s0; }}",
            s + 1,
            (s + 1) % STATES
        );
    }
    text.push_str(
        "}\n\n/// Its symbols and what is entered.\ngraph Fsm16 {\n    node symbols = Symbols();\n    node ring = Ring();\n    \
         node sink = Entered();\n\n    symbols.next -> ring.next;\n    symbols.reset -> ring.reset;\n    \
         ring.entered -> sink.s;\n}\n",
    );
    text
}

fn state_nodes() -> String {
    let mut text =
        "/// A ring of 16 nodes, of which one is active.\ngraph StateRing {\n    node symbols = Symbols();\n    \
                    node sink = Entered();\n"
            .to_owned();
    for s in 0..STATES {
        let kind = if s == 0 { "First" } else { "State" };
        let _ = writeln!(text, "    node s{s} = {kind}(number = {});", s + 1);
    }
    text.push_str("\n    start => s0.enter;\n");
    for s in 0..STATES {
        let _ = writeln!(
            text,
            "    symbols.next -> s{s}.next;\n    symbols.reset -> s{s}.reset;\n    s{s}.left => s{}.enter;\n    \
             s{s}.entered -> sink.s;",
            (s + 1) % STATES
        );
    }
    for s in 1..STATES {
        let _ = writeln!(text, "    s{s}.back => s0.enter;");
    }
    text + "}\n"
}

/// ` -> op(k = …)` from `first` to `last`, five per line.
fn ops(first: u32, last: u32) -> String {
    let mut text = String::new();
    for k in first..=last {
        text.push_str(if (k - first).is_multiple_of(5) { "\n        -> " } else { " -> " });
        let _ = write!(text, "op(k = {k})");
    }
    text
}
