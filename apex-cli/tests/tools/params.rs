//! `apex run` with parameters from a file.

use crate::{
    TARGET, builds,
    common::{Folder, apex, package, stderr},
};
use std::{fs, path::Path, process::Output};

const SPEAKER: &str = "\
use apex_rt::prelude::*;
/// Prints its volume.
#[node]
pub struct Speaker {
    #[param(default = 3, range = 0..=10)]
    volume: u8,
}
#[node]
impl Speaker {
    fn process(&mut self, x: &u8) { println!(\"{}\", self.volume * x); }
}
";

/// Runs a robot with parameters.
fn run(file: &Path, arguments: &[&Path]) -> Output {
    let mut command = apex();
    command.arg("run").arg(file);
    for (option, path) in ["--params", "--save-params"].iter().zip(arguments) {
        command.arg(option).arg(path);
    }
    command.env("CARGO_TARGET_DIR", TARGET).output().unwrap()
}

#[test]
fn parameters_from_a_file() {
    let _guard = builds();
    let folder = Folder::new("params");
    package(&folder, SPEAKER);
    // A graph that waits for its input has nothing to do: the run ends at once.
    let file =
        folder.file("robot.afg", "graph Robot {\n    in x: u8;\n    node speaker = Speaker();\n    x -> speaker;\n}\n");
    let (load, save) = (folder.file("load.toml", "[speaker]\nvolume = 5\n"), folder.0.join("save.toml"));
    let output = run(&file, &[&load, &save]);
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    assert_eq!(fs::read_to_string(&save).unwrap(), "[speaker]\nvolume = 5 # 0..=10\n");

    folder.file("load.toml", "[speaker]\nvolume = 11\n[spaeker]\nvolume = 1\n");
    fs::remove_file(&save).unwrap();
    let output = run(&file, &[&load, &save]);
    assert_eq!((output.status.code(), output.stdout.len(), save.exists()), (Some(2), 0, false));
    let name = load.display();
    assert_eq!(
        stderr(&output),
        format!(
            "error: {name}:2:10: `speaker.volume` cannot be 11: its range is 0..=10\n\
             {name}:3:2: there is no node `spaeker` with parameters; did you mean `speaker`?\n"
        )
    );

    // The package's own program gets no flags that it does not support.
    folder.file("src/main.rs", "fn main() {}\n");
    let output = run(&file, &[&load]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output)
            .starts_with("error: `--params` and `--save-params` only apply to programs that `apex run` generates")
    );
}
