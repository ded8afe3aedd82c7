//! The examples of `docs/tools.md` are what the command does.

use crate::common::{Folder, apex};
use std::{fs, path::Path};

/// The first block of the page that is marked with this word.
fn block(word: &str) -> String {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/tools.md");
    let page = fs::read_to_string(page).unwrap();
    let (_, rest) = page.split_once(&format!("```{word}\n")).unwrap();
    rest.split_once("```").unwrap().0.to_owned()
}

#[test]
fn the_new_project_of_the_page() {
    let folder = Folder::new("docs-new");
    let console = block("console");
    let (command, said) = console.split_once('\n').unwrap();
    let arguments = command.strip_prefix("$ apex ").unwrap().split(' ');
    let output = apex().args(arguments).current_dir(&folder.0).output().unwrap();
    assert_eq!(String::from_utf8(output.stdout).unwrap(), said);
}

#[test]
fn the_import_of_the_page() {
    let folder = Folder::new("docs-import");
    let output = apex().arg("import").arg(folder.file("robot.apex", block("yaml"))).output().unwrap();
    assert_eq!(String::from_utf8(output.stdout).unwrap(), block("text"));
}
