//! The texts of the graphs that are too long to be written by hand.

use std::fmt::Write as _;

/// File names and texts of all generated graphs.
pub fn all() -> Vec<(String, String)> {
    let chains = [3, 10, 100, 1000].map(|n| (format!("chain{n}.afg"), chain(n)));
    let silent = [10, 100, 1000].map(|n| (format!("silent{n}.afg"), silent(n)));
    let diamonds = [8, 64].map(|w| (format!("diamond{w}.afg"), diamond(w)));
    let filtered = ("bot100.afg".to_owned(), bot100());
    chains.into_iter().chain(silent).chain(diamonds).chain([filtered]).collect()
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
         node all = sum{w}();\n    node sink = Sink();\n\n"
    );
    for k in 1..=w {
        let _ = writeln!(text, "    source -> op(k = {k}) -> all.x{k};");
    }
    text.push_str("    all -> sink;\n}\n");
    text
}

/// ` -> op(k = …)` from `first` to `last`, five in a line.
fn ops(first: u32, last: u32) -> String {
    let mut text = String::new();
    for k in first..=last {
        text.push_str(if (k - first).is_multiple_of(5) { "\n        -> " } else { " -> " });
        let _ = write!(text, "op(k = {k})");
    }
    text
}
