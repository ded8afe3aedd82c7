//! Names of a graph file as names of the language.

use std::collections::BTreeSet;

/// Words that cannot be names in a text or in Rust.
const RESERVED: &[&str] = &[
    "abort", "as", "async", "await", "break", "claim", "const", "continue", "crate", "dyn", "else", "enum", "event",
    "exit", "extern", "false", "fn", "for", "gen", "graph", "if", "impl", "in", "let", "loop", "match", "mod", "move",
    "mut", "node", "out", "pub", "ref", "reset", "return", "robot", "self", "slot", "start", "static", "struct",
    "super", "trait", "true", "type", "unsafe", "use", "where", "while", "yield",
];

/// `csapex::RandomTrees_0` → `random_trees_0`; `max depth` → `max_depth`.
pub fn snake(name: &str) -> String {
    let name = name.rsplit("::").next().unwrap_or(name);
    let mut text = String::new();
    let mut before = '_';
    for c in name.chars() {
        if !c.is_ascii_alphanumeric() {
            if before != '_' {
                text.push('_');
            }
            before = '_';
            continue;
        }
        if c.is_ascii_uppercase() && before.is_ascii_lowercase() {
            text.push('_');
        }
        text.push(c.to_ascii_lowercase());
        before = c;
    }
    let text = text.trim_end_matches('_');
    match text.chars().next() {
        None => "unnamed".to_owned(),
        Some(first) if first.is_ascii_digit() => format!("n{text}"),
        Some(_) if RESERVED.contains(&text) => format!("{text}_"),
        Some(_) => text.to_owned(),
    }
}

/// `csapex::RandomTrees` → `RandomTrees`; `my graph` → `MyGraph`.
pub fn camel(name: &str) -> String {
    let name = name.rsplit("::").next().unwrap_or(name);
    let words = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let text: String = words.map(|word| word[..1].to_ascii_uppercase() + &word[1..]).collect();
    match text.chars().next() {
        None => "Unnamed".to_owned(),
        Some(first) if first.is_ascii_digit() => format!("N{text}"),
        Some(_) if text == "Self" => "Self_".to_owned(),
        Some(_) => text,
    }
}

/// The name, or the name with a number if it is taken; takes it.
pub fn unique(name: String, taken: &mut BTreeSet<String>) -> String {
    let mut candidate = name.clone();
    let mut number = 2;
    while !taken.insert(candidate.clone()) {
        candidate = format!("{name}_{number}");
        number += 1;
    }
    candidate
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_identifiers() {
        let names = ["csapex::RandomTrees_0", "~priors/0", "max depth", "2 of", "Ω", "in", "HTTPNode"];
        let snakes = ["random_trees_0", "priors_0", "max_depth", "n2_of", "unnamed", "in_", "httpnode"];
        assert_eq!(names.map(snake), snakes);
        assert_eq!(["csapex::Graph_0", "my graph", "3d", ""].map(camel), ["Graph0", "MyGraph", "N3d", "Unnamed"]);
        let mut taken = BTreeSet::new();
        assert_eq!(["a", "a", "a"].map(|name| unique(name.to_owned(), &mut taken)), ["a", "a_2", "a_3"]);
    }
}
