//! `apex test` interprets: it compiles as little as possible, and tests end as the compiled ones do.

use crate::{
    TARGET, builds_alone,
    common::{Folder, answer, apex, package, stderr},
};
use serde_json::Value;
use std::{collections::BTreeMap, fs, path::Path, process::Output};

const NODES: &str = "\
use apex_rt::prelude::*;

/// A thing to do.
#[derive(Debug, Clone, PartialEq)]
pub struct Job {
    pub name: String,
    pub speed: f64,
}

/// Nothing to do.
pub const IDLE: Job = Job { name: String::new(), speed: 0.0 };

/// Multiplies.
#[node]
pub fn scaled(x: &f64, #[param(default = 2.0, range = 0.0..=9.0)] by: f64) -> f64 { x * by }

/// Sends jobs, and fails for those without a name.
#[node]
#[derive(Default)]
pub struct Desk { count: u64 }
#[node]
impl Desk {
    #[slot]
    fn take(&mut self, job: &Job, done: Event<u64>) -> Result<(), String> {
        println!(\"takes {}\", job.name);
        if job.name.is_empty() {
            return Err(\"no name\".to_owned());
        }
        if job.speed < 0.0 {
            done.emit(7);
            panic!(\"it breaks\");
        }
        self.count += 1;
        done.emit(self.count);
        Ok(())
    }
}

/// Keeps what it sends in place.
#[node]
#[derive(Default)]
pub struct Sum { total: f64 }
#[node]
impl Sum {
    fn process(&mut self, x: &f64, sum: &mut Out<f64>) -> Option<f64> {
        self.total += x;
        *sum.get_mut() = self.total;
        (self.total > 3.0).then_some(self.total)
    }
}

/// Panics at numbers below zero.
#[node]
pub fn positive(x: &f64) -> f64 {
    assert!(*x >= 0.0, \"{x} is below zero\");
    *x
}

/// Ends the process at numbers above a hundred.
#[node]
pub fn bounded(x: &f64) -> f64 {
    if *x > 100.0 {
        std::process::exit(7);
    }
    *x
}
";

const TEXT: &str = "\
use crate::{Desk, IDLE, Job, Sum, bounded, positive, scaled};

graph Twice {
    in  x: f64;
    out y: f64;
    out many: f64;
    node sum = Sum();
    x -> scaled(by = 2) -> positive() -> bounded() -> [y, sum.x];
    sum.out -> many;
}

graph Office {
    slot job: Job;
    event done: u64;
    node desk = Desk();
    node other = Desk();
    job -> desk.take;
    [desk.done, other.done] -> done;
    desk.failed -> other.take(Job { name: \"again\", speed: 0.5 });
}

fsm Door {
    slot push;
    event opened: f64;
    state closed { on push => open; }
    state open { entry -> opened(0.5); on push => closed; }
}

graph Gate {
    slot push;
    event opened: f64;
    node door = Door();
    push -> door.push;
    door.opened -> opened;
}

test doubles: Twice {
    feed x = 2;
    expect y == 4 within 1ms;
    never many < 3;
}

test triples: Twice {
    feed x = [1, 2] every 10ms;
    expect y == 6 within 1s;
}

test jobs: Office {
    feed job = Job { name: \"clean\", speed: 1.5 };
    expect done == 1 within 1ms;
    feed job = IDLE;
    expect done == 1 within 1ms;
}

test idle: Office {
    feed job = IDLE;
    expect done == 3 within 1ms;
}

test breaks: Office {
    feed job = Job { name: \"fast\", speed: -1 };
    expect done == 7 within 1ms;
}

test door: Gate {
    feed push;
    expect opened == 0.5 within 1ms;
    expect active(door.open);
    never active(door.closed);
    feed push;
}

test panics: Twice {
    feed x = -1;
    expect y within 1ms;
}
";

fn run(folder: &Folder, arguments: &[&str]) -> Output {
    let mut command = apex();
    command.arg("test").args(arguments).arg("robot.afg").current_dir(&folder.0).env("CARGO_TARGET_DIR", TARGET);
    command.env_remove("CARGO_TERM_QUIET").output().unwrap()
}

/// Verdicts and messages by test, without folders and what Rust says around them.
fn ends(output: &Output) -> BTreeMap<String, (bool, String)> {
    let answer = answer(output, "test");
    let end = |test: &Value| {
        let lines = test["output"].as_str().unwrap().lines().map(|line| {
            // `thread 'name' (5) panicked at src/lib.rs:1:2:`
            let line = line.split_once("panicked at ").map_or(line, |(_, place)| place);
            line.trim_start_matches("  --> ").rsplit('/').next().unwrap_or(line).trim()
        });
        let lines = lines
            .filter(|line| !line.is_empty() && !["note: run with", "course.rs"].iter().any(|of| line.starts_with(of)));
        (test["name"].as_str().unwrap().to_owned(), (test["passed"] == true, lines.collect::<Vec<_>>().join("\n")))
    };
    answer["result"]["tests"].as_array().unwrap().iter().map(end).collect()
}

/// The crates that were compiled.
fn compiled(output: &Output) -> Vec<String> {
    let errors = stderr(output);
    let crates = errors.lines().filter_map(|line| line.trim_start().strip_prefix("Compiling ")?.split(' ').next());
    crates.map(str::to_owned).collect()
}

fn change(folder: &Folder, from: &str, to: &str) {
    let file = folder.0.join("robot.afg");
    let text = fs::read_to_string(&file).unwrap();
    assert!(text.contains(from), "{from}");
    fs::write(file, text.replacen(from, to, 1)).unwrap();
}

/// Verdicts and messages of the tests, which are the same when they are interpreted and when they are compiled.
fn ends_of_both(folder: &Folder) -> BTreeMap<String, (bool, String)> {
    let interpreted = run(folder, &["--format", "json"]);
    assert!(!stderr(&interpreted).contains("the tests are compiled"), "{}", stderr(&interpreted));
    let (first, other) = (ends(&interpreted), ends(&run(folder, &["--format", "json", "--compiled"])));
    assert_eq!(first, other);
    first
}

#[test]
fn tests_end_as_compiled_ones_and_most_changes_need_no_rustc() {
    let _guard = builds_alone();
    let folder = Folder::new("interpreted");
    package(&folder, NODES);
    folder.file("robot.afg", TEXT);
    let first = ends_of_both(&folder);
    let failed: Vec<&str> = first.iter().filter(|(_, (passed, _))| !passed).map(|(name, _)| name.as_str()).collect();
    assert_eq!(failed, ["door", "idle", "panics", "triples"]);
    assert!(first["idle"].1.starts_with("takes\ntakes again\ntest `idle` failed"), "{}", first["idle"].1);

    // Numbers, connections, modifiers, claims, states, another test: all that is not a type of a node.
    let changes = [
        ("feed x = 2;\n    expect y == 4", "feed x = 2.5;\n    expect y == 5"),
        ("scaled(by = 2) -> positive()", "positive() -> scaled(by = 2)"),
        ("expect y == 6 within 1s", "expect y == 4 within 2s"),
        ("expect done == 3", "expect done == 1"),
        ("    push -> door.push;", "    push -> door.push;\n    claim live;"),
        (
            "state closed { on push => open; }",
            "state closed { on push => ajar; }\n    state ajar { on push => open; after 1s => open; }",
        ),
        ("expect opened == 0.5 within 1ms", "expect opened == 0.5 within 2s"),
        ("    never active(door.closed);\n    feed push;\n", ""),
        ("feed x = -1;", "feed x = 1;"),
    ];
    changes.iter().for_each(|(from, to)| change(&folder, from, to));
    let output = run(&folder, &[]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("test result: ok. 7 passed; 0 failed;"), "{said}");
    assert_eq!((compiled(&output), stderr(&output)), (vec![], String::new()));

    // Another type of a node needs rustc, but for nothing else.
    change(&folder, "    job -> desk.take;", "    job -> [desk.take, third.take];\n    node third = Desk();");
    let crates = compiled(&run(&folder, &[]));
    assert!(crates.is_empty(), "its pieces are known: {crates:?}");
    change(&folder, "scaled(by = 2)", "scaled(by = 2) -> scaled(by = 1)");
    change(&folder, "feed job = IDLE", "feed job = Job { name: \"\", speed: 2.5 }");
    let crates = compiled(&run(&folder, &[]));
    assert!(crates.len() == 1 && crates[0].starts_with("apex-interpret-robot-"), "a new constant: {crates:?}");
}

#[test]
fn a_library_is_not_compiled_for_its_graphs() {
    let _guard = builds_alone();
    let folder = Folder::new("interpreted-library");
    package(&folder, &format!("{NODES}\napex_macros::graph!(\"robot.afg\");\n"));
    folder.file("robot.afg", TEXT);
    let failed = || {
        let output = run(&folder, &["--format", "json"]);
        let failed = ends(&output).into_iter().filter(|(_, (passed, _))| !passed).map(|(name, _)| name);
        (failed.collect::<Vec<_>>(), compiled(&output))
    };
    let all = ["door", "idle", "panics", "triples"].map(str::to_owned);
    assert_eq!(failed().0, all);
    // Cargo has written files after it has begun.
    failed();
    change(&folder, "expect y == 6 within 1s", "expect y == 4 within 1s");
    assert_eq!(failed(), (all[..3].to_vec(), vec![]));
    // A node has changed.
    folder.file(
        "src/lib.rs",
        format!("{NODES}\napex_macros::graph!(\"robot.afg\");\n").replace("x * by", "x * by + 1.0"),
    );
    let (failed, crates) = failed();
    assert!(
        failed.contains(&"doubles".to_owned()) && crates.contains(&"interpreted-library".to_owned()),
        "{failed:?} {crates:?}"
    );
}

#[test]
fn what_cannot_be_interpreted_is_compiled() {
    let _guard = builds_alone();
    let folder = Folder::new("interpreted-not");
    package(&folder, "");
    fs::write(folder.0.join("src/main.rs"), format!("{NODES}\napex_macros::graph!(\"robot.afg\");\nfn main() {{}}\n"))
        .unwrap();
    folder.file("robot.afg", TEXT);
    let output = run(&folder, &["--format", "json"]);
    let why = "note: the tests are compiled, because in a package of its own the file has an error: `crate` has no";
    assert!(stderr(&output).contains(why), "{}", stderr(&output));
    assert_eq!(ends(&output).len(), 7);
}

#[test]
fn a_node_that_ends_the_process_is_named() {
    let _guard = builds_alone();
    let folder = Folder::new("interpreted-ends");
    package(&folder, NODES);
    folder.file("robot.afg", TEXT.replace("feed x = -1", "feed x = 101"));
    let output = run(&folder, &["--quiet"]);
    assert_eq!(output.status.code(), Some(2));
    let errors = stderr(&output);
    assert!(errors.contains("error: `panics` ended the program that runs the tests (exit status: 7)"), "{errors}");
    assert!(Path::new(TARGET).is_dir());
}

/// Numbers of a recording, the times at which they come, and what is wrong with recordings.
const RECORDED: &str = "\
use crate::Sum;

graph Summed {
    in x: f64;
    out many: f64;
    node sum = Sum();
    x -> sum.x;
    sum.sum -> many;
}

test sums: Summed {
    wait 10ms;
    feed x = recording(\"run.mcap\", \"a.out\");
    expect many > 0;
    wait 10ms;
    expect many > 0 within 1ms;
    wait 1ms;
    never many > 0;
    wait 1s;
}

test late: Summed {
    feed x = recording(\"run.mcap\", \"a.out\");
    wait 1s;
    expect many > 0 within 1ms;
}

test no_channel: Summed {
    feed x = recording(\"run.mcap\", \"a.in\");
    wait 1s;
}

test no_file: Summed {
    feed x = recording(\"none.mcap\", \"a.out\");
    wait 1s;
}
";

#[test]
fn recordings_are_fed_as_to_compiled_tests() {
    let _guard = builds_alone();
    let folder = Folder::new("interpreted-recording");
    package(&folder, NODES);
    folder.file("robot.afg", RECORDED);
    fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/record/small.mcap"), folder.0.join("run.mcap"))
        .unwrap();
    let all = ends_of_both(&folder);
    let passed: Vec<&str> = all.iter().filter(|(_, (passed, _))| *passed).map(|(name, _)| name.as_str()).collect();
    assert_eq!(passed, ["sums"]);
    change(&folder, "wait 10ms;\n    feed", "wait 20ms;\n    feed");
    let output = run(&folder, &[]);
    assert_eq!(compiled(&output), Vec::<String>::new());
}
