//! Tests that are interpreted: only the nodes and types that they use are compiled, so that a changed source file
//! mostly needs no rustc.

use super::results::Tested;
use crate::{
    build::{self, Built, How, Outcome, Wanted, earlier, write_if_other},
    made::Made,
};
use apex_host::Workspace;
use apex_interpret::{MARK, Source};
use std::{
    fs,
    io::{BufRead as _, BufReader},
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// The crate that the program is made with.
const INTERPRETER: &str = "apex-interpret";
/// File of the program in its package.
const FILE: &str = "src/main.rs";

/// A program that interprets tests.
pub struct Runner {
    built: Built,
    command: Command,
}

/// Answer to the question if tests can be interpreted.
pub enum Interpretation {
    /// The program that interprets them.
    Of(Box<Runner>),
    /// The crates of the nodes do not compile. Cargo has printed why.
    Broken,
    /// They can only be compiled, for this reason.
    None(String),
}

/// Builds the program that runs the tests with these names, with these features of the runtime.
pub fn build(
    text: &Path,
    workspace: &Workspace,
    names: &[&str],
    features: &[&str],
    how: How,
) -> Result<Interpretation, String> {
    if Made::tool(workspace, INTERPRETER).is_none() {
        return Ok(Interpretation::None(format!("the crate `{INTERPRETER}` is not beside the runtime")));
    }
    let made =
        Made { workspace, what: "interpret", text, program: "", features, tools: &[INTERPRETER], file: FILE, code: "" };
    let (folder, name) = (made.folder(), made.name());
    let file = folder.join(FILE);
    // Its crates have to be known before its code.
    let before = fs::read_to_string(&file).unwrap_or_else(|_| "fn main() {}\n".to_owned());
    let wanted = Wanted { hushed: Some(name.clone()), ..Made { code: &before, ..made }.make()? };
    let cache = workspace.cache_folder();
    let code = match Source::load(&folder, (&name, true), text, &cache).and_then(|source| source.runner(names)) {
        Ok(code) => code,
        Err(reason) => return Ok(Interpretation::None(reason)),
    };
    write_if_other(&file, &code)?;
    let built = match built(&wanted, &name, workspace, how)? {
        Outcome::Built(built) => built,
        Outcome::Refused => {
            return Ok(Interpretation::None("rustc only accepts its nodes as parts of the program".to_owned()));
        }
        Outcome::Broken | Outcome::Nothing => return Ok(Interpretation::Broken),
    };
    let mut command = built.command();
    command.arg(&folder).arg(name).args([text, &workspace.root, &cache]).args(names);
    Ok(Interpretation::Of(Box::new(Runner { built, command })))
}

/// Builds the program `name`, unless only source files of Apex have changed: where a library has graphs, cargo would
/// compile it again, although the program takes only nodes from it.
fn built(wanted: &Wanted, name: &str, workspace: &Workspace, how: How) -> Result<Outcome, String> {
    let libraries = workspace.libraries();
    let folders = libraries.iter().map(|(_, folder)| *folder).chain([&*workspace.root, &*wanted.package]);
    let mut manifests: Vec<PathBuf> = folders.map(|folder| folder.join("Cargo.toml")).collect();
    manifests.push(wanted.package.join("Cargo.lock"));
    if let Some(built) = earlier::built(wanted, name, how, &manifests) {
        return Ok(Outcome::Built(built));
    }
    let begun = earlier::begin(wanted, how);
    let outcome = build::build(wanted, build::PROGRAM, how)?;
    if begun.is_ok() && matches!(outcome, Outcome::Built(_)) {
        // Without the note, cargo is asked the next time.
        let _ = earlier::end(wanted, how);
    }
    Ok(outcome)
}

impl Runner {
    /// Runs the tests with these names in a folder. Each is passed on when it has ended.
    pub fn run(
        mut self,
        folder: &Path,
        names: &[&str],
        mut ended: impl FnMut(&Tested) -> Result<(), String>,
    ) -> Result<Vec<Tested>, String> {
        let mut child =
            self.command.current_dir(folder).stdout(Stdio::piped()).spawn().map_err(|e| self.built.not_started(&e))?;
        let (mut tests, mut running): (Vec<Tested>, Option<Tested>) = (vec![], None);
        for line in child.stdout.take().into_iter().flat_map(|output| BufReader::new(output).lines()) {
            let line = line.map_err(|e| format!("cannot read the output of the tests: {e}"))?;
            let (said, mark) = line.rsplit_once(MARK).map_or((line.as_str(), None), |(said, mark)| (said, Some(mark)));
            if let Some(test) = running.as_mut().filter(|_| !said.is_empty() || mark.is_none()) {
                test.output += said;
                test.output.push('\n');
            }
            match mark {
                Some("passed" | "end") => {
                    if let Some(mut test) = running.take() {
                        let shown = if test.passed { 0 } else { test.output.trim_end().len() };
                        test.output.truncate(shown);
                        ended(&test)?;
                        tests.push(test);
                    }
                }
                Some("failed") => running.iter_mut().for_each(|test| test.passed = false),
                Some(mark) => {
                    running = mark.strip_prefix("begin ").map(|name| Tested {
                        name: name.to_owned(),
                        passed: true,
                        output: String::new(),
                    });
                }
                None => {}
            }
        }
        let status = child.wait().map_err(|e| format!("cannot wait for the tests: {e}"))?;
        match running {
            _ if status.success() => {
                tests.sort_by_key(|test| names.iter().position(|name| *name == test.name));
                Ok(tests)
            }
            Some(test) => Err(format!("`{}` ended the program that runs the tests ({status})", test.name)),
            None => Err(format!("the program that runs the tests has ended ({status})")),
        }
    }
}
