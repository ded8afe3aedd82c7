//! `apex agents`: a short guide to the language and to the nodes of a package, for programs that write code.

use crate::{
    nodes::Nodes,
    project::{self, Checker},
    replace, texts,
};
use apex_host::{Workspace, read_text};
use std::{
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

/// Name of the file, at which such programs look.
pub const FILE: &str = "AGENTS.md";
/// Largest size of the guide in bytes: it is read in full before every task.
const MOST: usize = 8000;

/// Lines around the part that the command writes. What is before and behind them is kept.
const BEGIN: &str = "<!-- Begin of the part that `apex agents` writes. -->";
const END: &str = "<!-- End of the part that `apex agents` writes. -->";

const GUIDE: &str = include_str!("guide.md");

/// Writes the guide of the package in `folder`; with `check` it only compares.
pub fn run(folder: &Path, check: bool) -> Result<ExitCode, String> {
    let manifest = folder.join("Cargo.toml");
    if !manifest.is_file() {
        return Err(format!("there is no package in `{}`: name the folder of one", folder.display()));
    }
    let mut checker = Checker::new(&manifest)?;
    let package = checker.workspace.as_ref().map_or_else(String::new, |workspace| workspace.binary().0.to_owned());
    let checkout = checkout(checker.workspace.as_ref());
    let wanted = whole(folder, &guide(folder, &package, &checkout, &mut checker)?)?;
    checker.save();
    let file = folder.join(FILE);
    if fs::read(&file).is_ok_and(|is| is == wanted.as_bytes()) {
        return Ok(ExitCode::SUCCESS);
    }
    if check {
        project::print_error(&format!("`{}` is not up to date: run `apex agents`", file.display()));
        return Ok(ExitCode::from(1));
    }
    replace::write(&file, &wanted)?;
    Ok(ExitCode::SUCCESS)
}

/// Writes the guide of a new package, for which cargo has not been run yet.
pub fn begin(folder: &Path, package: &str, checkout: &Path) -> Result<(), String> {
    let mut checker = Checker::alone(package, &folder.join("src/lib.rs"));
    let text = whole(folder, &guide(folder, package, checkout, &mut checker)?)?;
    replace::write(&folder.join(FILE), &text)
}

/// Checkout of Apex from which the package has the runtime.
fn checkout(workspace: Option<&Workspace>) -> PathBuf {
    let libraries = workspace.map(Workspace::libraries).unwrap_or_default();
    let runtime = libraries.iter().find(|(name, _)| *name == "apex-rt");
    runtime.and_then(|(_, folder)| folder.parent()).map_or(PathBuf::from("apex"), Path::to_owned)
}

/// Content of the file: the guide in place of the old one, or behind the text that is there.
fn whole(folder: &Path, guide: &str) -> Result<String, String> {
    let file = folder.join(FILE);
    let part = format!("{BEGIN}\n\n{guide}\n{END}\n");
    if !file.exists() {
        return Ok(part);
    }
    let old = read_text(&file, 1 << 20).map_err(|reason| format!("cannot read `{}`: {reason}", file.display()))?;
    match (old.split_once(BEGIN), old.split_once(END)) {
        (Some((before, _)), Some((_, behind))) => Ok(format!("{before}{}", part.trim_end()) + behind),
        _ => Ok(format!("{}\n\n{part}", old.trim_end())),
    }
}

/// Guide with the commands for the source files of the package, and as many of its nodes as there is room for.
fn guide(folder: &Path, package: &str, checkout: &Path, checker: &mut Checker) -> Result<String, String> {
    let mut text = GUIDE.replace("{name}", package).replace("{checkout}", &checkout.display().to_string());
    text = text.replace("{commands}", &commands(folder));
    let own = Nodes::of(folder, package, checker).own();
    if !own.is_empty() {
        text += "\nThis package has\n\n";
    }
    let rest = "- and more: `apex nodes` lists them\n";
    let most = MOST.saturating_sub(BEGIN.len() + END.len() + rest.len() + 8);
    for (number, line) in own.iter().enumerate() {
        if text.len() + line.len() >= most && number < own.len() {
            text += rest;
            break;
        }
        let _ = writeln!(text, "- {line}");
    }
    Ok(text)
}

/// Commands that check and test the source files of the package.
fn commands(folder: &Path) -> String {
    let mut files: Vec<PathBuf> = texts::named(folder).unwrap_or_default();
    files.retain(|file| file.starts_with(folder));
    let first = files.first().and_then(|file| file.strip_prefix(folder).ok());
    let first = first.map_or("robot.afg".to_owned(), |file| file.display().to_string());
    let lines = [
        (format!("apex check {first}"), "errors and warnings; `-` is standard input"),
        (format!("apex fmt {first}"), "the only style"),
        (format!("apex test {first}"), "the tests, in simulated time"),
        (format!("apex test {first} NAME"), "the tests whose names contain this"),
        (format!("apex explain {first}"), "schedule, activity, claims"),
    ];
    let width = lines.iter().map(|(command, _)| command.len()).max().unwrap_or(0);
    lines.map(|(command, what)| format!("{command:width$}  # {what}")).join("\n")
}
