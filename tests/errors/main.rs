//! Diagnostics of wrong source files. The expectations are in `texts/*.afg` under the code that they refer to (see
//! `expect.rs`); `APEX_UPDATE_EXPECTATIONS=1` writes them again.

mod claims;
mod compile;
mod expect;
#[allow(dead_code, reason = "the compiler reads them; nothing runs them")]
mod library;
mod mistakes;
#[allow(dead_code, reason = "the compiler reads them; nothing runs them")]
mod nodes;
mod pages;

use apex_dsl::{
    catalog::{Catalog, CrateSpec, Crates},
    report::Diagnostic,
};
use apex_host::Disk;
use compile::{Compiled, catalog, compile, folder};
use std::{
    collections::{BTreeMap, BTreeSet},
    env, fs,
    path::{Path, PathBuf},
};

fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = vec![];
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path, extension));
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Nodes of a crate without a heap, and of one that has the standard library.
fn bare_catalog() -> Catalog {
    let spec = |name: &str, dependencies| CrateSpec {
        name: name.to_owned(),
        root: folder().join(format!("{name}.rs")),
        features: BTreeSet::from(["std".to_owned()]),
        externs: BTreeSet::from(["core".to_owned()]),
        dependencies,
    };
    let dependencies = BTreeMap::from([("library".to_owned(), 1)]);
    let all = vec![spec("bare", dependencies), spec("library", BTreeMap::new())];
    Catalog::load(Crates { root: folder(), all, here: 0, own: vec![0], ..Crates::default() }, &mut Disk::new(None))
}

/// All source files with their diagnostics.
fn compiled() -> Vec<(PathBuf, String, Compiled)> {
    let (mut usual, mut bare) = (catalog(), bare_catalog());
    let texts = files(&folder().join("texts"), "afg");
    assert!(!texts.is_empty());
    let compile = |path: PathBuf| {
        // One file is not UTF-8; another source file tries to import it.
        let text = fs::read_to_string(&path).ok()?;
        let catalog = if path.parent().is_some_and(|folder| folder.ends_with("bare")) { &mut bare } else { &mut usual };
        let compiled = compile(&path, &expect::strip(&text), catalog);
        Some((path, text, compiled))
    };
    texts.into_iter().filter_map(compile).collect()
}

#[test]
fn diagnostics_are_as_expected() {
    let update = env::var_os("APEX_UPDATE_EXPECTATIONS").is_some();
    let mut wrong = vec![];
    for (path, text, compiled) in compiled() {
        let annotated = expect::annotate(&compiled);
        if annotated == text {
            continue;
        }
        if update {
            fs::write(&path, annotated).unwrap();
        } else {
            wrong.push(format!("{}:\n{}", path.display(), difference(&text, &annotated)));
        }
    }
    assert!(wrong.is_empty(), "{}\nAPEX_UPDATE_EXPECTATIONS=1 writes the expectations anew", wrong.join("\n"));
}

/// Lines that only one of two texts has.
fn difference(expected: &str, found: &str) -> String {
    let (old, new): (Vec<&str>, Vec<&str>) = (expected.lines().collect(), found.lines().collect());
    let missing = old.iter().filter(|l| !new.contains(l)).map(|l| format!("- {l}"));
    let added = new.iter().filter(|l| !old.contains(l)).map(|l| format!("+ {l}"));
    missing.chain(added).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_fix_removes_its_diagnostic() {
    let mut catalog = catalog();
    let mut tried = 0;
    for (path, _, before) in compiled() {
        for diagnostic in before.diagnostics.sorted() {
            for fix in diagnostic.fixes.iter().filter(|f| f.span.file.0 == 0) {
                let text = expect::apply(&before.sources.get(fix.span.file).text, fix.span, &fix.replacement);
                let after = compile(&path, &text, &mut catalog);
                assert!(
                    count(&after, diagnostic) < count(&before, diagnostic),
                    "{}: `{}` does not mend {:?}:\n{text}",
                    path.display(),
                    fix.title,
                    diagnostic.message
                );
                tried += 1;
            }
        }
    }
    assert!(tried > 10, "only {tried} fixes were tried");
}

/// Number of diagnostics with the same code and message.
fn count(compiled: &Compiled, diagnostic: &Diagnostic) -> usize {
    let same = |d: &&Diagnostic| d.code == diagnostic.code && d.message == diagnostic.message;
    compiled.diagnostics.sorted().into_iter().filter(same).count()
}

#[test]
fn messages_keep_the_house_style() {
    for (path, _, compiled) in compiled() {
        for d in compiled.diagnostics.sorted() {
            let labels = d.secondary.iter().chain([&d.primary]).map(|l| &l.text).filter(|t| !t.is_empty());
            let all = labels.chain([&d.message]).chain(&d.notes).chain(d.fixes.iter().map(|f| &f.title));
            for message in all {
                let start = message.starts_with(|c: char| c.is_lowercase() || c.is_ascii_digit() || "`-".contains(c));
                assert!(start, "{}: starts neither lower case nor with code: {message}", path.display());
                assert!(!message.ends_with(['.', '!', ' ', '\n']), "{}: {message}", path.display());
                assert!(message.matches('`').count() % 2 == 0, "{}: open back quote: {message}", path.display());
                assert!(!message.contains("  "), "{}: double blank: {message}", path.display());
            }
        }
    }
}

/// Codes of all messages in the source of the compiler.
fn emitted() -> BTreeSet<String> {
    let sources = folder().join("../../apex-dsl/src");
    let mut emitted = BTreeSet::new();
    for path in files(&sources, "rs") {
        let text = fs::read_to_string(path).unwrap();
        for constructor in ["error(", "warning(", "unknown(", "everywhere("] {
            for (at, _) in text.match_indices(constructor) {
                let arguments = text[at + constructor.len()..].trim_start();
                let code = arguments.strip_prefix('"').and_then(|a| a.split_once('"')).map(|(code, _)| code);
                if let Some(code) = code.filter(|c| c.chars().all(|c| c.is_ascii_lowercase() || c == '-')) {
                    emitted.insert(code.to_owned());
                }
            }
        }
    }
    assert!(emitted.contains("unknown-port") && emitted.contains("bad-number"), "{emitted:?}");
    emitted
}

#[test]
fn every_code_has_a_text() {
    let emitted = emitted();
    let compiled = compiled();
    let covered: BTreeSet<&str> =
        compiled.iter().flat_map(|(_, _, c)| c.diagnostics.sorted()).map(|d| d.code).collect();
    // A fault of the compiler has no text that shows it.
    let is_shown = |code: &&String| covered.contains(code.as_str()) || *code == "internal-error";
    let missing: Vec<&String> = emitted.iter().filter(|code| !is_shown(code)).collect();
    assert!(missing.is_empty(), "no text has {missing:?}");
}
