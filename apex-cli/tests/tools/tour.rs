//! Follows `docs/tour.md` from its beginning: makes the project, writes the code, runs every command, and compares the
//! output with the page.

use crate::{
    TARGET, builds, cargo,
    common::{Folder, apex, lock, stderr},
};
use std::{
    env, fs,
    path::{Path, PathBuf},
};

/// Commands that are not run here: they install the command, or take a minute of real time.
const LEFT_OUT: [&str; 3] = [
    "cargo install --path apex/apex-cli --profile tool",
    "cargo run",
    "apex run robot.afg --robot Robot --save-params tuned.toml",
];

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs")
}

/// Blocks of the page in their order: the info string of the fence, and the lines.
fn blocks(page: &str) -> Vec<(&str, &str)> {
    let fenced = page.split("\n```").skip(1).step_by(2);
    fenced.map(|block| block.split_once('\n').expect("a block has lines")).collect()
}

/// State of a reader who follows the tour.
struct Follower {
    folder: PathBuf,
    /// Standard error of the last command.
    errors: String,
    commands: usize,
}

impl Follower {
    /// Runs the commands of a block, and compares their output.
    fn run(&mut self, block: &str) {
        for part in format!("\n{block}").split("\n$ ").skip(1) {
            let (command, expected) = part.split_once('\n').unwrap_or((part, ""));
            if LEFT_OUT.contains(&command) {
                continue;
            }
            self.commands += 1;
            if let Some(folder) = command.strip_prefix("cd ") {
                self.folder.push(folder);
                lock(&self.folder);
                continue;
            }
            let said = self.said(command.trim_end_matches(" | cat"));
            let mut lines = said.lines();
            for line in expected.lines() {
                let real = lines.next().unwrap_or_default();
                // Long operations append their duration.
                assert!(real == line || real.starts_with(&format!("{line}; finished in")), "{command}: {said}");
            }
            let rest: String = lines.collect();
            assert!(expected.is_empty() || rest.is_empty(), "{command} says more: {said}");
        }
    }

    fn said(&mut self, command: &str) -> String {
        let words: Vec<&str> = command.split(' ').collect();
        let mut program = match words[0] {
            "apex" => apex(),
            "cargo" => cargo(),
            other => panic!("the tour calls `{other}`"),
        };
        program.args(&words[1..]).current_dir(&self.folder);
        let output = program.env("CARGO_TARGET_DIR", TARGET).env("CARGO_NET_OFFLINE", "true").output().unwrap();
        self.errors = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{command}: {}", self.errors);
        String::from_utf8(output.stdout).unwrap()
    }

    /// Diagnostics of `apex check` for a source file.
    fn messages(&mut self, text: &str) -> String {
        fs::write(self.folder.join("near.afg"), text).unwrap();
        let output = apex().args(["check", "near.afg"]).current_dir(&self.folder).output().unwrap();
        let errors = stderr(&output);
        errors.split_once("\nfor more about an error").map_or(errors.clone(), |(messages, _)| messages.to_owned())
    }
}

#[test]
fn the_tour_can_be_followed() {
    let _guard = builds();
    let page = fs::read_to_string(docs().join("tour.md")).unwrap();
    let folder = Folder::new("tour");
    let mut follower = Follower { folder: folder.0.clone(), errors: String::new(), commands: 0 };
    let (mut wrong, mut texts) = (None, 0);
    for (words, block) in blocks(&page) {
        match words {
            "console" => follower.run(block),
            "afg" => {
                texts += 1;
                assert_eq!(follower.messages(&format!("{block}\n")), "", "{block}");
            }
            "afg wrong" => wrong = Some(block),
            "text" => {
                if let Some(text) = wrong.take() {
                    assert_eq!(follower.messages(&format!("{text}\n")).trim_end(), block);
                }
            }
            _ => {}
        }
    }
    assert!(texts >= 3 && follower.commands >= 8, "{texts} texts, {} commands", follower.commands);
    the_picture_is_the_one_that_was_drawn(&follower.folder);
    the_project_is_as_it_should_be(&mut follower);
}

/// `APEX_UPDATE_EXPECTATIONS=1` writes the picture of the page again.
fn the_picture_is_the_one_that_was_drawn(project: &Path) {
    let (drawn, shown) = (project.join("picture.svg"), docs().join("images/rover.svg"));
    if env::var_os("APEX_UPDATE_EXPECTATIONS").is_some() {
        fs::copy(&drawn, &shown).unwrap();
    }
    let same = fs::read(&drawn).unwrap() == fs::read(&shown).unwrap();
    assert!(same, "docs/images/rover.svg is another picture: APEX_UPDATE_EXPECTATIONS=1 writes it anew");
}

/// The project of `apex new` is formatted, has no warnings and no placeholders; `apex run` runs its program.
fn the_project_is_as_it_should_be(follower: &mut Follower) {
    for file in ["Cargo.toml", "README.md", ".gitignore", "robot.afg", "src/lib.rs", "src/main.rs", "world.txt"] {
        let text = fs::read_to_string(follower.folder.join(file)).unwrap();
        assert!(!["{name}", "{checkout}", "{runtime}"].iter().any(|hole| text.contains(hole)), "{file}: {text}");
    }
    assert_eq!(follower.said("apex fmt --check robot.afg") + &follower.errors, "");
    assert_eq!(follower.said("cargo fmt --check"), "");
    let tested = follower.said("cargo test");
    assert!(tested.contains("comes_home ... ok") && !follower.errors.contains("warning"), "{}", follower.errors);
    let ran = follower.said("apex run robot.afg -- --fast");
    assert!(ran.trim_end().ends_with("is home"), "{ran}");

    // A drawing that is not a world ends the run with a reason.
    fs::write(follower.folder.join("world.txt"), "####\n#> X\n####\n").unwrap();
    let mut cargo = cargo();
    cargo.args(["run", "--quiet", "--", "--fast"]).current_dir(&follower.folder);
    let output = cargo.env("CARGO_TARGET_DIR", TARGET).env("CARGO_NET_OFFLINE", "true").output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("line 2, column 4 of the world: `X` means nothing"), "{}", stderr(&output));
}
