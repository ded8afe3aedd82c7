use crate::{
    TARGET,
    common::{Folder, apex, stderr},
};
use std::{
    fs,
    path::Path,
    process::{Command, Output},
};

/// Runs a command in a folder as a user without network would.
fn run_in(folder: &Path, command: &mut Command, arguments: &[&str]) -> (Option<i32>, String, String) {
    let command = command.args(arguments).current_dir(folder);
    command.env("CARGO_TARGET_DIR", TARGET).env("CARGO_NET_OFFLINE", "true");
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    (output.status.code(), text, stderr(&output))
}

fn make(arguments: &[&str], folder: &Path) -> Output {
    apex().arg("new").args(arguments).arg(folder).output().unwrap()
}

#[test]
fn a_new_project_is_right_is_tested_and_runs() {
    let folder = Folder::new("new");
    let said = run_in(&folder.0, &mut apex(), &["new", "my-robot"]);
    assert_eq!(said, (Some(0), "made `my-robot`; next\n  cd my-robot\n  cargo run\n".to_owned(), String::new()));
    let project = folder.0.join("my-robot");
    for file in ["Cargo.toml", "README.md", ".gitignore", "robot.afg", "src/lib.rs", "src/main.rs"] {
        let text = fs::read_to_string(project.join(file)).unwrap();
        assert!(!["{name}", "{checkout}", "{runtime}", "{nodes}"].iter().any(|p| text.contains(p)), "{file}: {text}");
    }
    for arguments in [&["fmt", "--check", "."][..], &["check", "robot.afg"]] {
        assert_eq!(run_in(&project, &mut apex(), arguments), (Some(0), String::new(), String::new()));
    }
    let cargo = || Command::new(env!("CARGO"));
    let (code, output, errors) = run_in(&project, &mut cargo(), &["test"]);
    assert!(code == Some(0) && output.contains("a_wall_comes_and_goes::passes ... ok"), "{output}{errors}");
    assert!(!errors.contains("warning"), "{errors}");
    let (code, output, errors) = run_in(&project, &mut apex(), &["test", "robot.afg"]);
    assert!(code == Some(0) && output.contains("1 passed"), "{output}{errors}");
    let (code, output, errors) = run_in(&project, &mut apex(), &["run", "robot.afg"]);
    assert_eq!((code, output.as_str()), (Some(0), "a wall: turn\ndrive\na wall: turn\ndrive\n"), "{errors}");
    let (code, _, errors) = run_in(&project, &mut cargo(), &["fmt", "--check"]);
    assert_eq!(code, Some(0), "{errors}");
}

#[test]
fn what_is_there_is_not_overwritten() {
    let folder = Folder::new("new-there");
    let file = folder.file("robot", "mine");
    let output = make(&[], &file);
    assert_eq!((output.status.code(), fs::read_to_string(&file).unwrap().as_str()), (Some(2), "mine"));
    assert!(stderr(&output).starts_with("error: cannot make a project in `"), "{}", stderr(&output));

    fs::create_dir(folder.0.join("full")).unwrap();
    folder.file("full/notes.txt", "mine");
    let output = make(&[], &folder.0.join("full"));
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
    assert!(stderr(&output).ends_with("is not empty: take another name\n"), "{}", stderr(&output));
    assert_eq!(fs::read_dir(folder.0.join("full")).unwrap().count(), 1);

    fs::create_dir(folder.0.join("empty")).unwrap();
    assert_eq!(make(&[], &folder.0.join("empty")).status.code(), Some(0));
}

#[test]
fn names_that_no_package_can_have_are_refused() {
    let folder = Folder::new("new-names");
    for (name, message) in [
        ("My Robot", "only the letters `a` to `z`, digits, `-` and `_` are allowed; try `my-robot`"),
        ("7of9", "it must begin with a letter; try `of9`"),
        ("match", "it is taken by Rust, cargo or Apex; try `match-robot`"),
    ] {
        let output = make(&[], &folder.0.join(name));
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
        assert_eq!(stderr(&output), format!("error: `{name}` cannot be the name of a package: {message}\n"));
    }
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 0);
}

#[test]
fn the_crates_come_from_the_checkout_that_is_named() {
    let folder = Folder::new("new-path");
    let checkout = folder.0.join("the \"checkout\"");
    for name in ["apex-rt", "nodes"] {
        fs::create_dir_all(checkout.join(name)).unwrap();
        fs::write(checkout.join(name).join("Cargo.toml"), "").unwrap();
    }
    let output = make(&["--path", checkout.to_str().unwrap()], &folder.0.join("robot"));
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    let manifest = fs::read_to_string(folder.0.join("robot/Cargo.toml")).unwrap();
    assert!(manifest.contains(r#"the \"checkout\"/apex-rt" }"#), "{manifest}");

    let output = make(&["--path", folder.0.to_str().unwrap()], &folder.0.join("other"));
    assert_eq!((output.status.code(), folder.0.join("other").exists()), (Some(2), false));
    assert!(stderr(&output).contains("is no checkout of Apex"), "{}", stderr(&output));
}
