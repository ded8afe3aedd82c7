//! `apex fmt`.

use crate::{project, replace::replace, texts};
use apex_dsl::{
    report::Diagnostics,
    source::{Sources, World as _},
};
use apex_host::Disk;
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

/// Result of formatting a source file.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    Fine,
    /// The source file has errors, or differs from the style and was only checked.
    Wrong,
    /// The file could not be read or written.
    Failed,
}

/// Formats source files and all source files in folders; with `check` it only compares. `-` is standard input.
pub fn run(paths: &[PathBuf], check: bool) -> Result<ExitCode, String> {
    let mut worst = Outcome::Fine;
    for path in paths {
        if project::is_input(path) {
            worst = worst.max(told(standard_input(check)));
            continue;
        }
        match texts::named(path) {
            Ok(files) => files.iter().for_each(|file| worst = worst.max(told(format_file(file, check)))),
            Err(message) => worst = worst.max(told(Err(message))),
        }
    }
    Ok(ExitCode::from(worst as u8))
}

/// Prints the error of a failed file, so that the next one can be formatted.
fn told(outcome: Result<Outcome, String>) -> Outcome {
    outcome.unwrap_or_else(|message| {
        project::print_error(&format!("error: {message}"));
        Outcome::Failed
    })
}

fn format_file(path: &Path, check: bool) -> Result<Outcome, String> {
    let text = Disk::new(None).read(path).map_err(|reason| format!("cannot read `{}`: {reason}", path.display()))?;
    let Some(formatted) = formatted(path, &text) else { return Ok(Outcome::Wrong) };
    if formatted == *text {
        return Ok(Outcome::Fine);
    }
    if check {
        project::print(&hint(path, &text, &formatted))?;
        return Ok(Outcome::Wrong);
    }
    replace(path, &formatted).map_err(|e| format!("cannot write `{}`: {e}", path.display()))?;
    Ok(Outcome::Fine)
}

fn standard_input(check: bool) -> Result<Outcome, String> {
    let path = Path::new("<stdin>");
    let text = project::read_input()?;
    let Some(formatted) = formatted(path, &text) else { return Ok(Outcome::Wrong) };
    if check && formatted != text {
        project::print(&hint(path, &text, &formatted))?;
        return Ok(Outcome::Wrong);
    }
    if !check {
        project::write(&formatted)?;
    }
    Ok(Outcome::Fine)
}

/// The source file in the style of the language, or `None` if it has errors, which are printed.
fn formatted(path: &Path, text: &str) -> Option<String> {
    let print = |diagnostics: Diagnostics| {
        let mut sources = Sources::default();
        sources.add(path, text);
        project::print_diagnostics(&diagnostics, &sources);
    };
    apex_ide::format(text).map_err(print).ok()
}

/// First difference between a source file and its formatted version.
fn hint(path: &Path, text: &str, formatted: &str) -> String {
    let (mut old, mut new) = (text.split_inclusive('\n'), formatted.split_inclusive('\n'));
    let mut number = 1;
    loop {
        match (old.next(), new.next()) {
            (Some(is), Some(should_be)) if is == should_be => number += 1,
            (is, should_be) => {
                let shown =
                    |sign, line: Option<&str>| line.map_or(String::new(), |l| format!("\n{sign} {}", visible(l)));
                let (is, should_be) = (shown('-', is), shown('+', should_be));
                return format!("{}:{number}: would be changed{is}{should_be}", path.display());
            }
        }
    }
}

/// A line with visible trailing blanks.
fn visible(line: &str) -> String {
    let (line, end) = match line.strip_suffix('\n') {
        Some(line) => (line, ""),
        None => (line, " (without a line end)"),
    };
    let text = line.trim_end();
    let blanks: String = line[text.len()..]
        .chars()
        .map(|c| if c == ' ' { '·'.to_string() } else { c.escape_default().to_string() })
        .collect();
    format!("{text}{blanks}{end}")
}
