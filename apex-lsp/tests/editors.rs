//! Comparison of the keywords and snippets in `editors/` with those of the compiler.

use apex_dsl::{
    report::Diagnostics,
    source::FileId,
    syntax::{
        self,
        keywords::{KEYWORDS, KeywordPosition, words_at},
    },
    units,
};
use serde_json::Value;
use std::{collections::BTreeSet, fs, path::Path};

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../editors").join(path)).unwrap()
}

fn words(place: KeywordPosition) -> BTreeSet<&'static str> {
    words_at(place).map(|w| w.text).collect()
}

#[test]
fn words_of_the_textmate_grammar() {
    let grammar: Value = serde_json::from_str(&read("vscode/syntaxes/afg.tmLanguage.json")).unwrap();
    for (name, place) in [
        ("item", KeywordPosition::Item),
        ("graph", KeywordPosition::Graph),
        ("machine", KeywordPosition::Machine),
        ("test", KeywordPosition::Test),
        ("tune", KeywordPosition::Tune),
        ("modifier", KeywordPosition::Modifier),
        ("inside", KeywordPosition::Inside),
        ("value", KeywordPosition::Value),
        ("node", KeywordPosition::Node),
        ("claim", KeywordPosition::Claim),
    ] {
        let pattern = grammar["repository"][format!("words-{name}")]["match"].as_str().unwrap();
        // The keywords are the only capturing group.
        let groups = pattern.split('(').skip(1).filter(|group| !group.starts_with('?'));
        let found: BTreeSet<&str> = groups.flat_map(|group| group.split(')').next().unwrap().split('|')).collect();
        assert_eq!(found, words(place), "words-{name}");
        let included = grammar["repository"]["words"]["patterns"].as_array().unwrap();
        assert!(included.iter().any(|p| p["include"] == format!("#words-{name}").as_str()), "words-{name}");
    }
}

#[test]
fn words_of_the_tree_sitter_grammar() {
    let found = words_in(&read("tree-sitter-afg/grammar.js"));
    // These are no words of its own there: a claim and a node are named, a crate is a path.
    let named = |place| matches!(place, KeywordPosition::Claim | KeywordPosition::Node);
    let wanted = KEYWORDS.iter().filter(|w| !named(w.position) && w.text != "crate").map(|w| w.text.to_owned());
    let wanted: BTreeSet<String> = wanted.collect();
    assert_eq!(found, wanted);

    let colours = read("tree-sitter-afg/queries/highlights.scm");
    for word in wanted.iter().filter(|w| !words(KeywordPosition::Value).contains(w.as_str())) {
        assert!(colours.contains(&format!("\"{word}\"")), "`{word}` has no colour");
    }
    for word in words(KeywordPosition::Node) {
        assert!(colours.contains(&format!("\"{word}\"")), "`{word}` has no colour");
    }
}

/// Keywords of a grammar: all strings of letters in its rules that are not the names of fields.
fn words_in(grammar: &str) -> BTreeSet<String> {
    let rules = grammar.split_once("rules: {").expect("a grammar has rules").1;
    let rules: String = rules.lines().filter(|line| !line.trim().starts_with("//")).collect();
    let mut found = BTreeSet::new();
    let mut before = "";
    for (index, part) in rules.split('\'').enumerate() {
        let is_string = index % 2 == 1;
        if is_string && !before.ends_with("field(") && part.chars().all(|c| c.is_ascii_alphabetic()) {
            found.insert(part.to_owned());
        }
        before = part;
    }
    found
}

/// The grammar accepts any word as a unit; therefore every unit of the compiler must be a word.
#[test]
fn units_are_words() {
    for unit in units::names() {
        assert!(unit == "%" || unit.bytes().all(|b| b.is_ascii_alphabetic()), "{unit}");
    }
}

/// Every snippet is free of syntax errors, alone or in the construct that it belongs to.
#[test]
fn snippets() {
    let snippets: Value = serde_json::from_str(&read("vscode/snippets.json")).unwrap();
    let snippets = snippets.as_object().unwrap();
    for (name, snippet) in snippets {
        let body = match &snippet["body"] {
            Value::Array(lines) => lines.iter().map(|l| l.as_str().unwrap()).collect::<Vec<_>>().join("\n"),
            line => line.as_str().unwrap().to_owned(),
        };
        let text = filled(&body);
        let around = [text.clone(), format!("graph A {{ {text} }}"), format!("fsm A {{ {text} }}")];
        assert!(around.iter().any(|text| is_syntax(text)), "{name}: {text}");
        assert_eq!(snippet["prefix"], name.as_str());
    }
    let missing: Vec<&str> = words(KeywordPosition::Item)
        .into_iter()
        .chain(words(KeywordPosition::Graph))
        .filter(|w| !snippets.contains_key(*w))
        .collect();
    assert_eq!(missing, Vec::<&str>::new());
}

fn is_syntax(text: &str) -> bool {
    let mut diagnostics = Diagnostics::default();
    syntax::parse(FileId(0), text, &mut diagnostics);
    !diagnostics.has_errors()
}

/// A snippet with its default values: `${1:name}` becomes `name`, as does every other `$1`.
fn filled(body: &str) -> String {
    let mut text = body.to_owned();
    for number in 0..10 {
        let open = format!("${{{number}:");
        let default = text.split_once(&open).map(|(_, rest)| rest.split('}').next().unwrap().to_owned());
        let default = default.unwrap_or_default();
        text = text.replace(&format!("{open}{default}}}"), &default).replace(&format!("${number}"), &default);
    }
    text
}
