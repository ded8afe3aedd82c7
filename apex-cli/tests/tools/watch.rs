//! A program that is rebuilt after changes. The tests wait for lines, never for a time.

use crate::{
    TARGET, builds,
    common::{Folder, apex, package},
};
use std::{
    io::{BufRead, BufReader, Lines},
    path::Path,
    process::{Child, ChildStderr, ChildStdout, Command, Stdio},
};

/// `apex run --watch`, seen from outside.
struct Watched {
    child: Child,
    output: Lines<BufReader<ChildStdout>>,
    errors: Lines<BufReader<ChildStderr>>,
}

impl Watched {
    fn start(file: &Path) -> Self {
        let mut command = apex();
        command.args(["run", "--watch"]).arg(file).env("CARGO_TARGET_DIR", TARGET);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let output = BufReader::new(child.stdout.take().unwrap()).lines();
        let errors = BufReader::new(child.stderr.take().unwrap()).lines();
        Self { child, output, errors }
    }

    /// Reads until the program prints this line.
    fn until(&mut self, line: &str) {
        assert!(self.output.by_ref().any(|l| l.unwrap() == line), "`{line}` never came");
    }

    /// Reads error messages until a line contains `part`.
    fn until_error(&mut self, part: &str) {
        assert!(self.errors.by_ref().any(|l| l.unwrap().contains(part)), "`{part}` never came");
    }

    /// Sends `SIGTERM`. The program must end too; otherwise its output would stay open.
    #[cfg(unix)]
    fn end(mut self) {
        assert!(Command::new("kill").arg(self.child.id().to_string()).status().unwrap().success());
        self.output.by_ref().for_each(drop);
        assert_eq!(self.child.wait().unwrap().code(), Some(0));
    }
}

const NODES: &str = "\
use apex_rt::prelude::*;
/// Prints its parameters.
#[node]
pub struct Speaker {
    #[param(default = String::from(\"none\"))]
    word: String,
    #[param(default = 1)]
    volume: u8,
    #[param(default = 1)]
    pace: u8,
}
#[node]
impl Speaker {
    fn process(&mut self) {
        println!(\"{} {} {}\", self.word, self.volume, self.pace);
    }
}
/// Sends nine.
#[node]
pub fn nine() -> u8 { 9 }
";

/// A speaker with a period.
fn text(arguments: &str) -> String {
    format!("graph Robot {{\n    node speaker = Speaker({arguments}) every 20ms;\n}}\n")
}

/// A speaker whose volume is set while it runs.
const SET: &str =
    "graph Robot {\n    node speaker = Speaker(word = \"one\");\n    nine() every 20ms -> speaker.volume;\n}\n";

#[cfg(unix)]
#[test]
fn the_program_follows_its_text_and_keeps_what_it_changed() {
    let _guard = builds();
    let folder = Folder::new("watch");
    package(&folder, NODES);
    let file = folder.file("robot.afg", "graph Robot {\n");
    let mut watched = Watched::start(&file);
    watched.until_error("waiting for a change");

    folder.file("robot.afg", SET);
    watched.until("one 9 1");

    // Values that the program changed are kept, values from the source file are taken, also after changes in Rust.
    folder.file("robot.afg", text("word = \"two\", pace = 2"));
    watched.until("two 9 2");
    folder.file("src/lib.rs", NODES.replace("{} {} {}", "<{} {} {}>"));
    watched.until("<two 9 2>");

    // Errors do not stop the running program.
    folder.file("robot.afg", text("word = \"three\", pase = 3"));
    watched.until_error("error[unknown-argument]");
    watched.until_error("the previous program keeps running");
    watched.until("<two 9 2>");
    folder.file("src/lib.rs", "compile_error!();");
    folder.file("robot.afg", text("word = \"three\""));
    watched.until_error("the previous program keeps running");
    watched.until("<two 9 2>");

    // A volume in the source file replaces the one that was kept.
    folder.file("src/lib.rs", NODES);
    folder.file("robot.afg", text("word = \"four\", volume = 5"));
    watched.until("four 5 1");
    watched.end();
    assert!(folder.0.join("robot.afg").exists());
}

/// The package's own program is also restarted after a change, even if it has ended.
#[cfg(unix)]
#[test]
fn a_program_of_its_own_is_restarted() {
    let folder = Folder::new("watch-own");
    package(&folder, NODES);
    let file = folder.file("robot.afg", "graph Robot { }\n");
    let main = |word: &str| format!("fn main() {{ println!(\"{word}\"); }}\n");
    folder.file("src/main.rs", main("first"));
    let mut watched = Watched::start(&file);
    watched.until("first");
    watched.until_error("the program has ended (exit status: 0); waiting for a change");
    folder.file("src/main.rs", main("second"));
    watched.until("second");
    watched.end();
}

#[test]
fn what_cannot_be_run_at_all_is_said_at_once() {
    let folder = Folder::new("watch-nothing");
    let refused = |name: &str, reason: &str| {
        let output = apex().args(["run", "--watch"]).arg(folder.0.join(name)).output().unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
        assert!(String::from_utf8(output.stderr).unwrap().contains(reason), "{name}");
    };
    folder.file("robot.afg", "graph Robot { }\n");
    refused("robot.afg", "is not in a cargo package");
    package(&folder, "");
    refused("missing.afg", "cannot read `");
}
