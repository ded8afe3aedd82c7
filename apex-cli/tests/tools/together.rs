//! Nothing is built twice, and concurrent commands do not disturb each other.

use crate::{
    TARGET, builds_alone, cargo,
    common::{Folder, apex, package, stderr},
};
use std::{
    fs::{self, File},
    io::{BufRead as _, BufReader, Read as _},
    path::{Path, PathBuf},
    process::{Child, Output, Stdio},
};

const NODES: &str = "\
use apex_rt::prelude::*;
/// Prints a word.
#[node]
pub struct Say {
    #[param(default = String::new())]
    word: String,
}
#[node]
impl Say {
    fn process(&mut self) -> u8 {
        println!(\"{}\", self.word);
        1
    }
}
";

/// A robot that prints a word and ends.
fn robot(name: &str, word: &str) -> String {
    format!("robot {name} {{\n    node say = Say(word = \"{word}\");\n    say -> exit;\n}}\n\n")
}

/// A source file with a robot, and with a test that has the same name in all source files.
fn text(name: &str, word: &str) -> String {
    let robot = robot(name, word);
    format!(
        "use crate::Say;\n\n{robot}graph Echo {{\n    in x: u8;\n    out y: u8;\n    x -> y;\n}}\n\n\
         test works: Echo {{\n    feed x = 1;\n    expect y == 1 within 1ms;\n}}\n"
    )
}

fn started(arguments: &[&str], file: &Path) -> Child {
    let mut command = apex();
    command.args(arguments).arg(file).env("CARGO_TARGET_DIR", TARGET).env_remove("CARGO_TERM_QUIET");
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn ended(child: Child) -> (Option<i32>, String, String) {
    let output = child.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stdout.clone()).unwrap(), stderr(&output))
}

/// Output of a command about its build, without the messages about waiting for other tests.
fn of_building((code, said, errors): (Option<i32>, String, String)) -> (Option<i32>, String, String) {
    let waits = |line: &&str| line.starts_with("waiting for another") || line.contains("Blocking waiting");
    (code, said, errors.lines().filter(|line| !waits(line)).map(|line| format!("{line}\n")).collect())
}

/// Names of the compiled crates in the output.
fn compiled(said: &str) -> Vec<&str> {
    said.lines().filter_map(|line| line.trim_start().strip_prefix("Compiling ")?.split(' ').next()).collect()
}

/// Realistic paths, some of which differ in one character only.
const PATHS: [&str; 7] = [
    "foo-bar/robot.afg",
    "foo_bar/robot.afg",
    "foo/bar/robot.afg",
    "it's \"here\"/Robot.afg",
    "o\u{308}l und \u{e9}clairs/ro\u{301}bot.afg",
    "\u{673a}\u{5668}\u{4eba}/\u{1f916}.afg",
    "\u{7f}\u{a0}/robot.afg",
];

/// Seven source files, each with a robot and a test of the same name, and two robots whose names differ in case, all at
/// once.
#[test]
fn each_command_runs_its_own_program() {
    let _guard = builds_alone();
    let folder = Folder::new("together");
    package(&folder, NODES);
    let file = |(number, path): (usize, &&str)| {
        let path = folder.0.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, text("Robot", &format!("I am {number}"))).unwrap();
        path
    };
    let files: Vec<PathBuf> = PATHS.iter().enumerate().map(file).collect();
    let two = folder.file("two.afg", text("Robot", "small") + "\n" + &robot("ROBOT", "large"));
    let mut running: Vec<(Child, String)> =
        files.iter().enumerate().map(|(i, file)| (started(&["run"], file), format!("I am {i}\n"))).collect();
    for (robot, word) in [("Robot", "small\n"), ("ROBOT", "large\n")] {
        running.push((started(&["run", "--robot", robot], &two), word.to_owned()));
    }
    for (child, word) in running {
        let (code, said, errors) = ended(child);
        assert_eq!((code, said.as_str()), (Some(0), word.as_str()), "{errors}");
    }
    // Finished builds are not repeated, and nothing is reported. The last path has a control character, which cargo's
    // dep-info files cannot represent: that one is built each time.
    for (i, file) in files[..files.len() - 1].iter().enumerate() {
        assert_eq!(of_building(ended(started(&["run"], file))), (Some(0), format!("I am {i}\n"), String::new()));
    }
}

/// Packages whose paths differ in one character have their own nodes.
#[test]
fn each_package_has_its_own_nodes() {
    let folder = Folder::new("together-nodes");
    let node = |name: &str| format!("use apex_rt::prelude::*;\n#[node]\npub fn {name}() -> u8 {{ 1 }}\n");
    let members = ["foo-bar", "foo_bar", "foo/bar"];
    folder.file("Cargo.toml", format!("[workspace]\nresolver = \"3\"\nmembers = {members:?}\n"));
    let runtime = Path::new(env!("CARGO_MANIFEST_DIR")).join("../apex-rt");
    for (number, member) in members.iter().enumerate() {
        let path = folder.0.join(member);
        fs::create_dir_all(path.join("src")).unwrap();
        let manifest = format!(
            "[package]\nname = \"p{number}\"\nedition = \"2024\"\n[dependencies]\napex-rt = {{ path = {runtime:?} }}\n"
        );
        fs::write(path.join("Cargo.toml"), manifest).unwrap();
        fs::write(path.join("src/lib.rs"), node(&format!("of_{number}"))).unwrap();
        fs::write(
            path.join("a.afg"),
            format!("use crate::of_{number};\ngraph A {{\n    out y: u8;\n    of_{number}() -> y;\n}}\n"),
        )
        .unwrap();
    }
    for _ in 0..2 {
        for member in members {
            let output = apex().arg("check").arg(folder.0.join(member).join("a.afg")).output().unwrap();
            assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()), "{member}");
        }
    }
}

/// Results of `cargo build` are used: the program itself, and for tests all but the crate with the tests.
#[test]
fn nothing_is_built_twice() {
    let _guard = builds_alone();
    let folder = Folder::new("once");
    package(&folder, &format!("{NODES}apex_macros::graph!(\"robot.afg\");\n"));
    folder.file("src/main.rs", "use apex_rt::prelude::*;\nfn main() { run(once::Robot::new(), WallClock::new()); }\n");
    let file = folder.file("robot.afg", text("Robot", "mine"));
    let other = folder.file("other.afg", text("Other", "another"));
    let mut cargo = cargo();
    let output: Output =
        cargo.args(["build", "--quiet"]).current_dir(&folder.0).env("CARGO_TARGET_DIR", TARGET).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));

    assert_eq!(of_building(ended(started(&["run"], &file))), (Some(0), "mine\n".to_owned(), String::new()));
    let (code, said, errors) = ended(started(&["test"], &file));
    assert!(code == Some(0) && said.contains("1 passed"), "{said}{errors}");
    let crates = compiled(&errors);
    assert!(crates.len() == 2 && crates[0] == "once" && crates[1].starts_with("apex-interpret-robot-"), "{errors}");
    let (code, said, errors) = ended(started(&["test", "--compiled"], &file));
    assert!(code == Some(0) && said.contains("1 passed"), "{said}{errors}");
    assert_eq!(compiled(&errors), ["once"], "{errors}");
    // A source file that no Rust code compiles: only its package and the package made for it are built.
    for (command, what) in [
        (&["test"][..], "apex-interpret-other-"),
        (&["test", "--compiled"], "apex-test-other-"),
        (&["run", "--robot", "Other"], "apex-run-other-"),
    ] {
        let (code, _, errors) = ended(started(command, &other));
        let crates = compiled(&errors);
        assert!(code == Some(0) && crates.iter().all(|name| *name == "once" || name.starts_with(what)), "{errors}");
        assert!(crates.last().is_some_and(|name| name.starts_with(what)), "{errors}");
    }
    for file in [&file, &other] {
        let (code, said, errors) = of_building(ended(started(&["test"], file)));
        assert!(code == Some(0) && said.contains("1 passed") && errors.is_empty(), "{said}{errors}");
    }
}

/// The second of two commands reports that it waits, unless it is quiet.
#[test]
fn a_command_that_waits_says_so() {
    let _guard = builds_alone();
    let folder = Folder::new("together-waits");
    package(&folder, NODES);
    let file = folder.file("robot.afg", text("Waiting", "done"));
    fs::create_dir_all(Path::new(TARGET).join("apex")).unwrap();
    let lock = File::create(Path::new(TARGET).join("apex/lock")).unwrap();
    lock.lock().unwrap();
    let mut child = started(&["run"], &file);
    let mut errors = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    errors.read_line(&mut line).unwrap();
    assert!(line.starts_with("waiting for another `apex` that builds in `"), "{line}");
    drop(lock);
    let mut rest = String::new();
    errors.read_to_string(&mut rest).unwrap();
    let (code, said, _) = ended(child);
    assert_eq!((code, said.as_str()), (Some(0), "done\n"), "{rest}");
}

/// Exit codes tell scripts the kind of failure.
#[test]
fn exit_codes() {
    let _guard = builds_alone();
    let folder = Folder::new("together-codes");
    package(&folder, NODES);
    let file = folder.file("robot.afg", text("Coded", "x").replace("y == 1", "y == 2"));
    let code = |arguments: &[&str]| ended(started(arguments, &file));
    assert_eq!(code(&["test", "--quiet"]).0, Some(1), "a test fails");
    let mut filtered = apex();
    let output = filtered.arg("test").arg(&file).arg("workz").output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(stderr(&output), "error: there is no test whose name contains `workz`; did you mean `works`?\n");
    fs::write(&file, text("Coded", "x").replace("-> exit", "-> abort")).unwrap();
    assert_eq!(code(&["run", "--quiet"]).0, Some(1), "the program aborts");
    folder.file("src/lib.rs", format!("{NODES}fn broken() -> u8 {{ true }}\n"));
    for command in ["run", "test"] {
        let (code, said, errors) = code(&[command, "--quiet"]);
        assert_eq!((code, said.as_str()), (Some(2), ""), "{command}");
        assert!(errors.contains("mismatched types"), "{errors}");
    }
}
