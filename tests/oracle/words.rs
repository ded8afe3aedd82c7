//! The words of the language that no random program has, which docs/compiler.md lists.

use apex_dsl::syntax::keywords::KEYWORDS;
use apex_tests::{
    oracle::{generate, machine, on_threads, with_timeouts},
    texts,
};
use std::{collections::BTreeSet, fs, path::Path};

/// Number of random programs that are looked at. Each word comes in some of a hundred, or in none.
const PROGRAMS: u64 = 1000;
/// Text before the words on the page.
const HEAD: &str = "Random programs have none of these words of the language yet:";

#[test]
fn what_random_programs_lack_is_listed() {
    let texts = (0..PROGRAMS).flat_map(|seed| {
        let case = || generate(seed, true);
        let cases = [generate(seed, false), case(), with_timeouts(case()), on_threads(case())];
        cases.map(|case| case.text("Random")).into_iter().chain([machine(seed, "Random")])
    });
    let missing = missing(texts);
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/compiler.md")).expect("the page");
    let listed = page.split_once(HEAD).and_then(|(_, rest)| rest.split("\n\n").next()).unwrap_or_default();
    let listed: BTreeSet<&str> = listed.split('`').skip(1).step_by(2).collect();
    assert_eq!(listed, missing, "the list in docs/compiler.md is not true any more: {}", shown(&missing));
}

#[test]
fn random_texts_have_every_word() {
    let texts = (0..PROGRAMS).flat_map(|seed| texts::generate(seed).texts).map(|text| text.text());
    let missing = missing(texts);
    assert!(missing.is_empty(), "no random text has: {}", shown(&missing));
}

/// The words of the language that none of these texts has.
fn missing(texts: impl Iterator<Item = String>) -> BTreeSet<&'static str> {
    let mut written = BTreeSet::new();
    for text in texts {
        let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        written.extend(words.map(str::to_owned));
    }
    KEYWORDS.iter().map(|word| word.text).filter(|word| !written.contains(*word)).collect()
}

fn shown(words: &BTreeSet<&str>) -> String {
    words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}
