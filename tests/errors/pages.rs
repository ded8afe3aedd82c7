//! The pages of `docs/errors/`: their examples are compiled, and their messages are the real ones.
//! `APEX_UPDATE_EXPECTATIONS=1` writes the text block after a wrong example again.

use super::{
    compile::{Compiled, catalog, compile, folder},
    expect::without_lines,
};
use apex_dsl::report::{PAGES, render};
use std::{env, fs};

/// Codes of which no short text is an example.
const WITHOUT_EXAMPLE: [&str; 6] =
    ["claim-undecided", "internal-error", "target", "too-deep", "too-large", "unreadable"];

const WRONG: &str = "```afg wrong\n";
const MESSAGE: &str = "```text\n";
const RIGHT: &str = "```afg\n";
const END: &str = "```\n";

/// Content of the first block of `page` that begins with `fence`.
fn block<'a>(page: &'a str, fence: &str) -> Option<&'a str> {
    let (_, rest) = page.split_once(fence)?;
    rest.split_once(END).map(|(block, _)| block)
}

/// All messages as `apex check` prints them, without the lines of Rust files.
fn messages(compiled: &Compiled) -> String {
    let rendered = compiled.diagnostics.sorted().into_iter().map(|d| render(d, &compiled.sources, false) + "\n");
    without_lines(&rendered.collect::<Vec<_>>().join("\n"))
}

#[test]
fn every_page_is_true() {
    let mut catalog = catalog();
    let mut wrong = vec![];
    for (code, page) in PAGES {
        assert!(page.starts_with(&format!("# {code}\n\n")), "{code}");
        let Some(example) = block(page, WRONG) else {
            assert!(WITHOUT_EXAMPLE.contains(code), "{code} has no example");
            continue;
        };
        // The file name that the messages show; imports are searched in its folder.
        let compiled = compile("robot.afg".as_ref(), example, &mut catalog);
        let found: Vec<&str> = compiled.diagnostics.sorted().iter().map(|d| d.code).collect();
        assert!(!found.is_empty() && found.iter().all(|c| c == code), "{code}: the wrong example has {found:?}");
        let shown = block(page, MESSAGE).unwrap_or_else(|| panic!("{code} shows no message"));
        let real = messages(&compiled);
        if shown != real {
            let changed = page.replacen(&format!("{MESSAGE}{shown}{END}"), &format!("{MESSAGE}{real}{END}"), 1);
            wrong.push((*code, changed));
        }
        let right = block(page, RIGHT).unwrap_or_else(|| panic!("{code} has no right example"));
        let compiled = compile("robot.afg".as_ref(), right, &mut catalog);
        assert_eq!(messages(&compiled), "", "{code}: the right example");
    }
    if env::var_os("APEX_UPDATE_EXPECTATIONS").is_some() {
        for (code, page) in wrong {
            fs::write(folder().join(format!("../../docs/errors/{code}.md")), page).unwrap();
        }
    } else {
        let codes: Vec<&str> = wrong.iter().map(|(code, _)| *code).collect();
        assert!(codes.is_empty(), "the messages of {codes:?} are others; APEX_UPDATE_EXPECTATIONS=1 writes them anew");
    }
}

#[test]
fn every_code_has_a_page() {
    let pages: Vec<&str> = PAGES.iter().map(|(code, _)| *code).collect();
    let codes = super::emitted();
    assert_eq!(pages, codes.iter().map(String::as_str).collect::<Vec<_>>());
    let files = super::files(&folder().join("../../docs/errors"), "md");
    let names: Vec<String> = files.iter().map(|f| f.file_stem().unwrap().to_string_lossy().into_owned()).collect();
    assert_eq!(names, pages);
}
