//! Source files: checked, formatted, repaired, completed, explained.

use crate::{
    mutate::{Dice, files, root, split, words},
    worker::Target,
};
use apex_dsl::{
    catalog::{Catalog, CrateSpec, Crates},
    passes,
    report::{Diagnostics, json, render},
    source::Sources,
    syntax::repaired,
};
use apex_host::Disk;
use apex_ide::format;
use apex_tests::texts::generate;
use std::collections::{BTreeMap, BTreeSet};

/// Maximum number of states to visit for claims: enough to reach the code, few enough for thousands of source files.
const STATES: usize = 500;

struct SourceSet {
    catalog: Catalog,
    texts: Vec<String>,
    vocabulary: Vec<String>,
    step: u64,
}

/// The target with source files.
pub fn texts() -> Box<dyn Target> {
    let folder = root().join("tests/errors");
    let spec = |name: &str, dependencies| CrateSpec {
        name: name.to_owned(),
        root: folder.join(format!("{name}.rs")),
        features: BTreeSet::new(),
        externs: BTreeSet::from(["core".to_owned()]),
        dependencies,
    };
    let dependencies = BTreeMap::from([("library".to_owned(), 1)]);
    let all = vec![spec("nodes", dependencies), spec("library", BTreeMap::new())];
    let crates = Crates { root: folder.clone(), all, here: 0, own: vec![0], ..Crates::default() };
    let catalog = Catalog::load(crates, &mut Disk::new(None));
    let mut texts = files(&root(), "afg");
    // Generated source files use nodes of another package, which tests the search for similar names.
    texts.extend((0..200).flat_map(|seed| generate(seed).texts).map(|text| text.text()));
    let mut vocabulary: BTreeSet<String> = BTreeSet::new();
    texts.iter().for_each(|text| vocabulary.extend(split(text).into_iter().map(str::to_owned)));
    Box::new(SourceSet { catalog, texts, vocabulary: vocabulary.into_iter().collect(), step: 0 })
}

impl Target for SourceSet {
    fn make(&mut self, dice: &mut Dice) -> Vec<u8> {
        let others: Vec<&str> = (0..12).map(|_| dice.of(&self.vocabulary).as_str()).collect();
        let mut text = dice.of(&self.texts).clone();
        if dice.below(8) == 0 {
            // The beginning of one source file and the end of another.
            let other = dice.of(&self.texts);
            let (a, b) = (split(&text), split(other));
            text = [&a[..dice.below(a.len())], &b[dice.below(b.len())..]].concat().concat();
        }
        words(&text, &others, dice).into_bytes()
    }

    fn run(&mut self, input: &[u8]) {
        let text = String::from_utf8_lossy(input);
        self.step += 1;
        let mut sources = Sources::default();
        let mut diagnostics = Diagnostics::default();
        let file = sources.add("fuzz.afg", text.as_ref());
        let checked =
            passes::check_all(file, &mut self.catalog, &mut sources, &mut Disk::new(None), STATES, &mut diagnostics);
        if !diagnostics.has_errors() {
            let place = |_| proc_macro2::Span::call_site();
            passes::generate(
                &checked.programs,
                &checked.texts.machines,
                &self.catalog,
                &sources,
                &place,
                true,
                &mut diagnostics,
            );
        }
        for diagnostic in diagnostics.sorted() {
            render(diagnostic, &sources, false);
            json(diagnostic, &sources);
        }
        let view =
            apex_ide::View { texts: &checked.texts, links: &checked.links, sources: &sources, catalog: &self.catalog };
        let mut dice = Dice::new(input.len() as u64 ^ self.step);
        edited(&view, &text, &mut dice);
        if let Ok(formatted) = format::format(&text) {
            assert_eq!(
                format::format(&formatted).ok().as_deref(),
                Some(&*formatted),
                "formatted twice is another text"
            );
        }
        if let Some(repaired) = repaired(&text) {
            assert!(text.len() <= repaired.len() + text.len() && !repaired.is_empty(), "repaired to nothing");
        }
    }
}

/// Queries of an editor at a few positions.
fn edited(view: &apex_ide::View<'_>, text: &str, dice: &mut Dice) {
    let occurrences = apex_ide::occurrences(view);
    apex_ide::outline(view);
    for _ in 0..3 {
        let mut offset = dice.below(text.len() + 1);
        while !text.is_char_boundary(offset) {
            offset -= 1;
        }
        apex_ide::complete(view, text, offset, &Vec::new);
        apex_ide::describe_word(view, text, offset);
        if let Some(found) = apex_ide::at(&occurrences, view, offset) {
            apex_ide::describe(view, found.definition);
        }
    }
}
