//! The formatter: its output (`cases.md`), and properties for every source file.

mod cases;
#[path = "../hostile/random.rs"]
mod hostile;
#[path = "../hostile/large.rs"]
mod large;
mod properties;
mod shake;

use properties::check;
use rayon::prelude::*;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Folder of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// All source files of the repository by name.
fn texts() -> Vec<(String, String)> {
    let mut texts = vec![];
    for folder in ["apex-rt", "benches", "nodes", "robots", "tests"] {
        collect(&root().join(folder), &mut texts);
    }
    texts.sort();
    assert!(texts.len() > 100, "only {} texts were found", texts.len());
    texts
}

fn collect(folder: &Path, texts: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, texts);
        } else if path.extension().is_some_and(|e| e == "afg") {
            // One file is not UTF-8.
            texts.extend(fs::read_to_string(&path).ok().map(|text| (path.display().to_string(), text)));
        }
    }
}

/// `true` for source files that are not formatted: those with errors, and those with expected positions.
fn stays_as_it_is(name: &str) -> bool {
    ["tests/errors/", "tests/hostile/", "tests/macro/"].iter().any(|folder| name.contains(folder))
}

#[test]
fn the_texts_of_the_repository_are_formatted() {
    for (name, text) in texts().into_iter().filter(|(name, _)| !stays_as_it_is(name)) {
        assert_eq!(check(&name, &text).as_ref(), Some(&text), "{name}: `apex fmt` has not been run");
    }
}

#[test]
fn the_documentation_is_formatted() {
    let mut pages = vec![root().join("README.md")];
    pages.extend(markdown(&root().join("docs")));
    let mut count = 0;
    for page in pages {
        let text = fs::read_to_string(&page).unwrap();
        for block in text.split("```afg\n").skip(1).filter_map(|rest| rest.split_once("```")) {
            let name = page.display().to_string();
            assert_eq!(check(&name, block.0).as_deref(), Some(block.0), "{name}");
            count += 1;
        }
    }
    assert!(count > 30, "only {count} graphs were found");
}

/// Pages of the documentation, without those about errors, whose source files are wrong.
fn markdown(folder: &Path) -> Vec<PathBuf> {
    let mut pages = vec![];
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("errors") {
            pages.extend(markdown(&path));
        } else if path.extension().is_some_and(|e| e == "md") {
            pages.push(path);
        }
    }
    pages
}

#[test]
fn every_text_keeps_what_it_says() {
    let texts: Vec<(String, String)> =
        texts().into_iter().chain(hostile::texts(0..100)).chain(large::texts()).collect();
    texts.par_iter().for_each(|(name, text)| drop(check(name, text)));
}

/// Valid source files of the repository and of the generators of other tests.
fn legal() -> Vec<(String, String)> {
    let sound = |(name, text): (String, String)| check(&name, &text).map(|formatted| (name, formatted));
    let mut texts: Vec<(String, String)> =
        texts().into_iter().filter(|(_, text)| text.len() < 20_000).filter_map(sound).collect();
    for seed in 0..40 {
        let text = apex_tests::oracle::generate(seed, seed % 2 == 0).text("Random");
        texts.extend(sound((format!("generated from {seed}"), text)));
    }
    assert!(texts.len() > 150, "only {} texts are in order", texts.len());
    texts
}

#[test]
fn blanks_and_line_ends_make_no_difference() {
    legal().into_par_iter().enumerate().for_each(|(seed, (name, text))| {
        let shaken = shake::blanks(&text, seed as u64);
        assert_eq!(check(&name, &shaken).as_ref(), Some(&text), "{name}:\n{shaken}");
    });
}

#[test]
fn comments_survive_everywhere() {
    legal().into_par_iter().enumerate().for_each(|(seed, (name, text))| {
        for rarity in [2, 30] {
            let commented = shake::comments(&text.replace("\r\n", "\n"), rarity, seed as u64);
            let Some(formatted) = check(&name, &commented) else { panic!("{name} became wrong:\n{commented}") };
            let bare = check(&name, &properties::without_comments(&formatted));
            let expected = check(&name, &properties::without_comments(&text));
            assert_eq!(bare, expected, "{name}:\n{commented}");
        }
    });
}
