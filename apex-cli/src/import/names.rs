//! Converts names of a graph file to names of the language.

use std::collections::BTreeMap;

/// Words that are reserved in the language or in Rust.
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

/// Names that are taken, each with the number for the next equal name.
#[derive(Default)]
pub struct Taken(BTreeMap<String, usize>);

impl Taken {
    /// Reserves a name.
    pub fn reserve(&mut self, name: String) {
        self.0.entry(name).or_insert(2);
    }

    /// Takes the name, or the name with a number if it is taken already.
    pub fn unique(&mut self, name: String) -> String {
        let Some(mut number) = self.0.get(&name).copied() else {
            self.reserve(name.clone());
            return name;
        };
        let numbered = |number| format!("{name}_{number}");
        while self.0.contains_key(&numbered(number)) {
            number += 1;
        }
        let candidate = numbered(number);
        // The next search continues here, so that a thousand nodes of one name do not need a thousand full searches.
        self.0.insert(name, number + 1);
        self.reserve(candidate.clone());
        candidate
    }
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
        let mut taken = Taken::default();
        let names = ["a", "a_3", "a", "a", "a_3", "a"].map(|name| taken.unique(name.to_owned()));
        assert_eq!(names, ["a", "a_3", "a_2", "a_4", "a_3_2", "a_5"]);
    }
}
