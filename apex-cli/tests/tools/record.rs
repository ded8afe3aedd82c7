//! `apex run --record` and `apex replay`.

use crate::{
    TARGET, builds,
    common::{Folder, apex, package, stderr},
};
use std::{fs, process::Output};

const NODES: &str = "use apex_rt::prelude::*;

/// An unpredictable number.
#[node]
pub fn noise() -> u64 {
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |t| t.as_nanos() as u64)
}

#[node]
pub fn scaled(value: &u64, #[param] k: u64) -> u64 {
    value.wrapping_mul(k)
}

#[node]
#[derive(Default)]
pub struct Sum {
    sum: u64,
}

#[node]
impl Sum {
    fn process(&mut self, value: &u64, all: Event<u64>) {
        self.sum = self.sum.wrapping_add(*value);
        all.emit(self.sum);
    }
}

#[node]
#[derive(Default)]
pub struct Print;

#[node]
impl Print {
    #[slot]
    fn sum(&mut self, sum: &u64) {
        println!(\"{sum}\");
    }
}

#[node]
pub fn tick() {}

pub struct Opaque;

#[node]
pub fn opaque() -> Opaque {
    Opaque
}

#[node]
pub fn swallow(value: &Opaque) {
    let _ = value;
}
";

fn text(k: u32) -> String {
    format!(
        "use crate::{{Print, Sum, noise, scaled, tick}};

robot Adder {{
    node noise  = noise() every 5ms;
    node scaled = scaled(k = {k});
    node sum    = Sum();
    node print  = Print();
    node end    = tick() after 60ms;

    noise         -> scaled -> sum;
    sum.all       -> print.sum;
    end.processed -> exit;

    record \"adder.mcap\" {{
        scaled;
        sum.all;
    }}
}}

robot Apart {{
    node noise  = noise() every 5ms;
    node scaled = scaled(k = {k}) on far;
    node sum    = Sum() on back;
    node print  = Print();
    node end    = tick() after 60ms;

    noise         -> scaled -> sum;
    sum.all       -> print.sum;
    end.processed -> exit;

    record \"apart.mcap\" {{
        scaled;
        sum.all;
    }}
}}

pub graph Other {{
    node noise = noise() every 5ms;
    node print = Sum();
    noise -> print;
}}
"
    )
}

fn run(folder: &Folder, arguments: &[&str]) -> Output {
    apex()
        .args(arguments)
        .current_dir(&folder.0)
        .env("CARGO_TARGET_DIR", TARGET)
        .output()
        .expect("the command is there")
}

fn replay(folder: &Folder, recording: &str, robot: &str) -> (Option<i32>, String, String) {
    let output = run(folder, &["replay", recording, "robot.afg", "--robot", robot]);
    (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned(), stderr(&output))
}

#[test]
fn a_run_is_recorded_and_repeated() {
    let _guard = builds();
    let folder = Folder::new("record");
    package(&folder, NODES);
    folder.file("robot.afg", text(3));

    // Recordings by the source file, and by the command.
    for (robot, arguments, file) in [
        ("Adder", &[][..], "adder.mcap"),
        ("Adder", &["--record", "run.mcap"][..], "run.mcap"),
        // On several threads.
        ("Apart", &[][..], "apart.mcap"),
    ] {
        let output = run(&folder, &[&["run", "robot.afg", "--robot", robot], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(stderr(&output).contains(&format!("{file}`\n")), "{}", stderr(&output));
        let printed = String::from_utf8_lossy(&output.stdout).into_owned();
        let (code, stdout, stderr) = replay(&folder, file, robot);
        assert_eq!((code, stderr.as_str()), (Some(0), ""), "{stdout}");
        let rest = stdout.strip_prefix(printed.as_str()).expect("the robot prints the same");
        assert!(rest.starts_with("`scaled.out`: "), "{rest}");
        assert!(rest.ends_with("reactions, all the same\n"), "{rest}");
    }

    // A source file that was changed.
    folder.file("robot.afg", text(4));
    let (code, stdout, _) = replay(&folder, "run.mcap", "Adder");
    assert_eq!(code, Some(1), "{stdout}");
    assert!(stdout.contains("`scaled.out`: 0 of "), "{stdout}");
    assert!(stdout.contains("the first difference is token 1, at 0.0"), "{stdout}");
    assert!(stdout.ends_with("reactions, with differences\n"), "{stdout}");

    // A truncated recording.
    let bytes = fs::read(folder.0.join("run.mcap")).expect("it was recorded");
    folder.file("robot.afg", text(3));
    folder.file("cut.mcap", &bytes[..bytes.len() / 2]);
    let (code, stdout, _) = replay(&folder, "cut.mcap", "Adder");
    assert!(code == Some(1) && stdout.contains("the recording is incomplete: it was cut off"), "{code:?} {stdout}");

    // Another program.
    let output = run(&folder, &["replay", "run.mcap", "robot.afg", "--robot", "Other"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("is a recording of `Adder`, not of `Other`"), "{}", stderr(&output));

    // A source whose tokens cannot be recorded.
    folder.file(
        "opaque.afg",
        "use crate::{opaque, swallow};\nrobot Dark { node o = opaque() every 5ms; o -> swallow(); }\n",
    );
    let output = run(&folder, &["run", "opaque.afg", "--record", "dark.mcap"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("the tokens of `o.out` cannot be recorded: derive `serde::"),
        "{}",
        stderr(&output)
    );
    assert!(!folder.0.join("dark.mcap").exists());
}

#[test]
fn what_cannot_be_replayed_is_said_before_a_build() {
    let folder = Folder::new("no-record");
    package(&folder, NODES);
    folder.file("robot.afg", text(3));
    folder.file("text.mcap", "this is no recording");
    folder.file("empty.mcap", "");
    fs::create_dir(folder.0.join("folder.mcap")).expect("a new folder");
    for (file, message) in [
        ("text.mcap", "cannot read `text.mcap`: it is not an MCAP file, or its beginning is damaged"),
        ("empty.mcap", "cannot read `empty.mcap`: it is empty, or was cut off before anything was recorded"),
        ("folder.mcap", "cannot read `folder.mcap`: it is a folder"),
        ("missing.mcap", "cannot read `missing.mcap`: No such file"),
    ] {
        let (code, _, stderr) = replay(&folder, file, "Adder");
        assert!(code == Some(2) && stderr.starts_with(&format!("error: {message}")), "{code:?} {stderr}");
    }
    for (file, message) in [
        ("folder.mcap", "cannot record to `folder.mcap`: it is a folder; choose a file in it"),
        ("none/run.mcap", "cannot record to `none/run.mcap`: there is no folder `none`"),
    ] {
        let output = run(&folder, &["run", "robot.afg", "--robot", "Adder", "--record", file]);
        assert_eq!((output.status.code(), stderr(&output)), (Some(2), format!("error: {message}\n")));
    }
}
