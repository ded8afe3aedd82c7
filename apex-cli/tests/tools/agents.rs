//! `apex agents`, and the guide that `apex new` writes.

use crate::{
    TARGET, builds, cargo,
    common::{Folder, apex, lock, package, stderr},
    new::run_in,
};
use std::{fs, path::Path};

/// Programs read the guide before every task.
const MOST: usize = 8 << 10;

/// Blocks of a page in this language.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    page.split(fence.as_str()).skip(1).map(|block| block.split_once("```").unwrap().0).collect()
}

fn agents(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    run_in(folder, apex().arg("agents"), arguments)
}

fn guide(folder: &Path) -> String {
    fs::read_to_string(folder.join("AGENTS.md")).unwrap()
}

#[test]
fn all_templates_have_a_guide() {
    let folder = Folder::new("agents-new");
    for (template, node) in
        [("robot", "- `Drive(speed"), ("node", "- `exceeds(level: u16)`: `in raw: u16"), ("firmware", "- `Motor(")]
    {
        let project = folder.0.join(format!("my-{template}"));
        let made = apex().args(["new", "--template", template]).arg(&project).output().unwrap();
        assert_eq!((made.status.code(), stderr(&made)), (Some(0), String::new()));
        let text = guide(&project);
        assert!(text.contains(node) && text.contains("apex check ") && text.len() <= MOST, "{text}");
        // Cargo, which `apex new` does not run, finds the same nodes.
        lock(&project);
        assert_eq!(agents(&project, &["--check"]), (Some(0), String::new(), String::new()), "{template}");
    }
}

#[test]
fn what_the_guide_shows_is_right() {
    let _guard = builds();
    let folder = Folder::new("agents-right");
    package(&folder, "");
    assert_eq!(agents(&folder.0, &[]).0, Some(0));
    let text = guide(&folder.0);
    let lone = Folder::new("agents-lone");
    for graph in blocks(&text, "afg") {
        let file = lone.file("guide.afg", graph);
        for arguments in [&["check"][..], &["fmt", "--check"]] {
            let (code, said, errors) = run_in(&lone.0, apex().args(arguments), &[file.to_str().unwrap()]);
            assert_eq!((code, said, errors), (Some(0), String::new(), String::new()));
        }
        assert!(graph.contains("\ntest "), "its behaviour is tested");
    }
    // The rows of the grammar name what is there, and so do the sentences.
    let words = text.split('`').skip(1).step_by(2).filter(|word| word.starts_with(char::is_uppercase));
    for node in words.filter(|word| word.chars().all(char::is_alphanumeric) && !["AGENTS", "CODE"].contains(word)) {
        let (code, _, errors) = run_in(&lone.0, apex().arg("nodes"), &[node]);
        assert_eq!(code, Some(0), "{node}: {errors}");
    }
    let rust: String = blocks(&text, "rust").concat();
    folder.file("src/lib.rs", format!("{rust}\n#[cfg(test)]\nmod graphs {{ apex_macros::graph!(\"tests.afg\"); }}\n"));
    let uses = "graph Uses {\n    in  x: f32;\n    out y: u64;\n\n    node tally = Tally(most = 2);\n    x -> double() -> tally.x;\n    tally.out -> y;\n}\n\n\
                test counts: Uses {\n    feed x = 1;\n    expect y == 1 within 0s;\n}\n";
    folder.file("tests.afg", uses);
    let (code, output, errors) = run_in(&folder.0, cargo().env("CARGO_TARGET_DIR", TARGET), &["test", "--quiet"]);
    assert!(code == Some(0) && !errors.contains("warning"), "{output}{errors}");
}

#[test]
fn a_guide_is_kept_up_to_date_beside_what_others_have_written() {
    let folder = Folder::new("agents-kept");
    let nodes = |count: usize| -> String {
        let node = |i| {
            format!(
                "/// Sends the number {i}, which stands here for a longer text.\n#[node]\npub fn number_{i}() -> u64 {{ {i} }}\n"
            )
        };
        "use apex_rt::prelude::*;\n".to_owned() + &(0..count).map(node).collect::<String>()
    };
    package(&folder, &nodes(2));
    folder.file("AGENTS.md", "# Mine\n\nBe careful.\n");
    let old = guide(&folder.0);
    let (code, _, errors) = agents(&folder.0, &["--check"]);
    assert!(code == Some(1) && errors.contains("is not up to date: run `apex agents`"), "{errors}");
    assert_eq!(guide(&folder.0), old);
    assert_eq!(agents(&folder.0, &[]).0, Some(0));
    assert_eq!(agents(&folder.0, &["--check"]).0, Some(0));
    folder.file("AGENTS.md", guide(&folder.0) + "\nBe quick.\n");
    folder.file("src/lib.rs", nodes(200));
    assert_eq!(agents(&folder.0, &["--check"]).0, Some(1));
    assert_eq!(agents(&folder.0, &[]).0, Some(0));
    let text = guide(&folder.0);
    assert!(text.starts_with("# Mine\n\nBe careful.\n\n<!--") && text.ends_with("-->\n\nBe quick.\n"), "{text}");
    assert!(text.contains("- and more: `apex nodes` lists them") && text.len() <= MOST, "{text}");
    assert_eq!(text.matches("## Grammar in brief").count(), 1);
    let (code, _, errors) = agents(Path::new("/"), &[]);
    assert!(code == Some(2) && errors.contains("there is no package in `.`"), "{errors}");
}
