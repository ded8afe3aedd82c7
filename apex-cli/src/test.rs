//! `apex test`: the tests of a source file, interpreted or as Rust tests.

mod interpreted;
mod results;

use crate::{
    answer::Answer,
    build::{self, Built, How, Outcome, Turn},
    calls::{self, Call},
    made::{self, Made},
    project::{self, Checked},
    run,
};
use apex_dsl::{
    codegen::module_name,
    report::nearest,
    script::{Script, Step},
};
use apex_host::Workspace;
use interpreted::Interpretation;
use std::{
    ffi::OsString,
    io::{self, IsTerminal as _, Read},
    path::Path,
    process::{ExitCode, Stdio},
};

/// Checks, builds and runs the tests whose names contain `filter`. They are interpreted, unless they are to be
/// `compiled` or can only be.
pub fn run(
    file: &Path,
    filter: Option<&str>,
    compiled: bool,
    how: How,
    answer: &mut Answer,
) -> Result<ExitCode, String> {
    let checked = project::check(file)?;
    answer.messages(&checked.diagnostics, &checked.sources);
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    let scripts = checked.programs.iter().flat_map(|p| &p.scripts).filter(|script| script.study.is_none());
    let scripts: Vec<&Script> = scripts.collect();
    if scripts.is_empty() {
        answer.give(|| format!("`{}` has no `test`", file.display()), || results::json(&[]))?;
        return Ok(ExitCode::SUCCESS);
    }
    let names = chosen(&scripts, filter)?;
    if !compiled && let Some(code) = interpreted(file, &checked, &names, how, answer)? {
        return Ok(code);
    }
    let Some(Found { built, names, turn }) = built(file, &checked, &names, how)? else { return answer.not_built() };
    let mut command = built.command();
    command.arg("--exact").args(&names).current_dir(run::package(file)?).env("RUST_BACKTRACE", "0");
    if answer.is_json() {
        let output = command.stderr(Stdio::inherit()).output().map_err(|e| built.not_started(&e))?;
        let tests = results::read(&String::from_utf8_lossy(&output.stdout), &names);
        answer.give(String::new, || results::json(&tests))?;
        return Ok(if output.status.success() { ExitCode::SUCCESS } else { ExitCode::from(1) });
    }
    // Rust's tests would not colour what goes through this command.
    command.args(io::stdout().is_terminal().then_some("--color=always"));
    let mut child = command.arg("--quiet").stdout(Stdio::piped()).spawn().map_err(|e| built.not_started(&e))?;
    drop(turn);
    let output = child.stdout.take().map_or(Ok(String::new()), passed_on)?;
    let status = child.wait().map_err(|e| format!("cannot wait for the tests: {e}"))?;
    for line in results::failed(&output).iter().filter_map(|name| in_studio(file, &checked, name)) {
        project::print(&line)?;
    }
    Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

/// Interprets tests. Returns `None`, after a note, if they can only be compiled.
fn interpreted(
    file: &Path,
    checked: &Checked,
    names: &[&str],
    how: How,
    answer: &mut Answer,
) -> Result<Option<ExitCode>, String> {
    let folder = run::package(file)?;
    let workspace = Workspace::load(&folder)?;
    run::has_apex(&folder, &workspace)?;
    let turn = Turn::wait(&workspace, how)?;
    let text = run::absolute(file)?;
    let runner = match interpreted::build(&text, &workspace, names, features(checked), how)? {
        Interpretation::Of(runner) => runner,
        Interpretation::Broken => return answer.not_built().map(Some),
        Interpretation::None(reason) => {
            if !how.quiet {
                project::print_error(&format!("note: the tests are compiled, because {reason}"));
            }
            return Ok(None);
        }
    };
    let is_json = answer.is_json();
    if !is_json {
        project::write(&format!("\nrunning {}\n", project::counted(names.len(), "test")))?;
    }
    let start = std::time::Instant::now();
    drop(turn);
    let tests = runner.run(&folder, names, |test| match is_json {
        true => Ok(()),
        false => project::write(if test.passed { "." } else { "F" }),
    })?;
    answer.give(|| results::text(&tests, start.elapsed()), || results::json(&tests))?;
    let failed: Vec<&str> = tests.iter().filter(|test| !test.passed).map(|test| test.name.as_str()).collect();
    if !is_json {
        for line in failed.iter().filter_map(|name| in_studio(file, checked, name)) {
            project::print(&line)?;
        }
    }
    Ok(Some(if failed.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(1) }))
}

/// Prints the output of tests while they run, and returns it.
fn passed_on(mut from: impl Read) -> Result<String, String> {
    let (mut all, mut part) = (vec![], [0; 4096]);
    loop {
        match from.read(&mut part) {
            Ok(0) => return Ok(String::from_utf8_lossy(&all).into_owned()),
            Ok(length) => {
                all.extend_from_slice(&part[..length]);
                project::write_bytes(&part[..length])?;
            }
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return Err(format!("cannot read the output of the tests: {e}")),
        }
    }
}

/// Line with the command that shows the graph of a test in the studio: if it is a program, or else the only robot.
fn in_studio(file: &Path, checked: &Checked, test: &str) -> Option<String> {
    let tree = &checked.texts.files.first()?.1;
    let path = &tree.tests.iter().find(|item| item.name.text == test)?.graph;
    let graph = path.segments.last()?.text.as_str();
    let programs = || checked.programs.iter().filter(|p| !p.is_test()).map(|p| &p.graph);
    let robots: Vec<&str> = programs().filter(|graph| graph.robot).map(|graph| graph.name.as_str()).collect();
    let (what, robot) = match robots.as_slice() {
        _ if programs().any(|program| program.name == graph) => (format!("`{graph}`"), graph),
        [robot] => (format!("`{robot}` instead of `{graph}`"), *robot),
        _ => return None,
    };
    let file = file.display();
    Some(format!("to see {what}, without the steps of `{test}`: apex studio --simulated --robot {robot} {file}"))
}

/// A program with tests.
pub struct Found {
    /// The program.
    pub built: Built,
    /// Names of the tests in it.
    pub names: Vec<String>,
    /// Lock on the program until it is started.
    pub turn: Turn,
}

/// Builds the program with the tests or studies `names`. Returns `None` after compile errors, which cargo has printed.
pub fn built(file: &Path, checked: &Checked, names: &[&str], how: How) -> Result<Option<Found>, String> {
    let folder = run::package(file)?;
    let workspace = Workspace::load(&folder)?;
    run::has_apex(&folder, &workspace)?;
    let tests =
        Tests { text: &run::absolute(file)?, folder: &folder, workspace: &workspace, features: features(checked), how };
    let turn = Turn::wait(&workspace, how)?;
    let found = match tests.own(names)? {
        Own::Found(built, tests) => Some((built, tests)),
        Own::Broken => None,
        Own::None => tests.made(names)?,
    };
    Ok(found.map(|(built, names)| Found { built, names, turn }))
}

/// Features of the runtime that the tests need.
fn features(checked: &Checked) -> &'static [&'static str] {
    let scripts = checked.programs.iter().flat_map(|p| &p.scripts);
    let is_recorded = |step: &Step| matches!(step, Step::FeedRecorded { .. });
    if scripts.flat_map(|script| &script.steps).any(is_recorded) { &[made::RECORD] } else { &[] }
}

/// Names of the tests to run.
fn chosen<'a>(scripts: &[&'a Script], filter: Option<&str>) -> Result<Vec<&'a str>, String> {
    let all = scripts.iter().map(|script| script.name.as_str());
    let filter = filter.unwrap_or_default();
    let names: Vec<&str> = all.clone().filter(|name| name.contains(filter)).collect();
    if names.is_empty() {
        let help = match nearest(filter, all.clone()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("there are `{}`", all.collect::<Vec<_>>().join("`, `")),
        };
        return Err(format!("there is no test whose name contains `{filter}`; {help}"));
    }
    Ok(names)
}

/// Tests of a source file, and their location.
struct Tests<'a> {
    text: &'a Path,
    folder: &'a Path,
    workspace: &'a Workspace,
    features: &'a [&'a str],
    how: How,
}

/// Tests in the package itself.
enum Own {
    /// Program with tests, and their names in it.
    Found(Built, Vec<String>),
    /// The package should have the tests, but does not compile.
    Broken,
    /// No tests.
    None,
}

impl Tests<'_> {
    /// Tests in the package itself, if it compiles the source file: `cargo build` has already built its dependencies.
    fn own(&self, names: &[&str]) -> Result<Own, String> {
        for (kind, name, root) in self.workspace.targets() {
            let select = match kind {
                "bin" => vec!["--bin".to_owned(), name.to_owned()],
                "lib" | "rlib" | "dylib" => vec!["--lib".to_owned()],
                // Test targets of a package may have a harness of their own, which does not list its tests.
                _ => continue,
            };
            for Call { module } in calls::find(root, self.folder, self.text) {
                let package = ["--package".to_owned(), self.workspace.binary().0.to_owned()];
                let mut select: Vec<OsString> = package.iter().chain(&select).map(Into::into).collect();
                select.extend(made::select_features(self.workspace, self.features));
                let (package, target) = (self.folder.to_owned(), self.workspace.target.clone());
                let wanted = build::Wanted { select, root: package.clone(), package, target, hushed: None };
                let built = match build::build(&wanted, build::TESTS, self.how)? {
                    Outcome::Built(built) => built,
                    Outcome::Nothing => continue,
                    Outcome::Broken | Outcome::Refused => return Ok(Own::Broken),
                };
                // Conditional compilation may have excluded the tests.
                if let Some(tests) = named(&listed(&built)?, &module, self.text, names) {
                    return Ok(Own::Found(built, tests));
                }
            }
        }
        Ok(Own::None)
    }

    /// Tests in a package that is made for them, or `None` if it does not compile.
    fn made(&self, names: &[&str]) -> Result<Option<(Built, Vec<String>)>, String> {
        let made = Made {
            workspace: self.workspace,
            what: "test",
            text: self.text,
            program: "",
            features: self.features,
            tools: &[],
            file: "src/lib.rs",
            code: &format!("apex_macros::graph!({:?});\n", made::utf8(self.text)?),
        };
        let Some(built) = build::build(&made.make()?, build::TESTS, self.how)?.program()? else {
            return Ok(None);
        };
        let tests =
            named(&listed(&built)?, &[], self.text, names).ok_or("rustc has left out tests of the source file")?;
        Ok(Some((built, tests)))
    }
}

/// Names of all tests in a program.
fn listed(built: &Built) -> Result<Vec<String>, String> {
    let output = built.command().args(["--list", "--format=terse"]).output().map_err(|e| built.not_started(&e))?;
    let list = String::from_utf8_lossy(&output.stdout);
    Ok(list.lines().filter_map(|line| Some(line.strip_suffix(": test")?.to_owned())).collect())
}

/// Names in `listed` that are in `module` and are one of `names`, or `None` if one is missing.
fn named(listed: &[String], module: &[String], text: &Path, names: &[&str]) -> Option<Vec<String>> {
    let (mut found, of_text) = (vec![], module_name(text, 0));
    for name in names {
        let path: Vec<&str> = module.iter().map(String::as_str).chain([of_text.as_str(), *name]).collect();
        let is_it = |test: &&String| {
            let parts: Vec<&str> = test.split("::").map(|part| part.trim_start_matches("r#")).collect();
            parts.starts_with(&path)
        };
        let before = found.len();
        found.extend(listed.iter().filter(is_it).cloned());
        if found.len() == before {
            return None;
        }
    }
    Some(found)
}
