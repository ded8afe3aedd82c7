//! Parameters that a program changed while it ran, for its next run. The program may have been changed in between: see
//! `apex run --watch`.

use super::{Parameters, load, save};
use std::{collections::BTreeMap, format, fs, path::Path, string::String};

/// Files with the parameters at the start, as declared in source files and parameter files, and at the end.
const SAID: &str = "said.toml";
const LAST: &str = "last.toml";

/// Sets the parameters that the previous run changed, except where a source file or parameter file has changed since.
pub fn resume<P: Parameters>(program: &mut P, folder: &Path) -> Result<(), String> {
    let now = save(program);
    let read = |name| fs::read_to_string(folder.join(name)).unwrap_or_default();
    let (said, last) = (read(SAID), read(LAST));
    let (said, last, same) = (lines(&said), lines(&last), lines(&now));
    for (at, line) in last {
        let was = said.get(&at);
        if was.is_some_and(|was| *was != line) && was == same.get(&at) {
            // Name, type and range are the same, so that the value of the previous run is set again.
            let _ = load(program, &format!("{}\n{line}\n", at.0));
        }
    }
    write(folder, SAID, &now)?;
    keep(program, folder)
}

/// Saves all parameters for the next run.
pub fn keep<P: Parameters>(program: &mut P, folder: &Path) -> Result<(), String> {
    write(folder, LAST, &save(program))
}

/// Returns the lines of a saved text by table and parameter name.
fn lines(text: &str) -> BTreeMap<(&str, &str), &str> {
    let mut table = "";
    let mut lines = BTreeMap::new();
    for line in text.lines() {
        match line.split_once(" = ") {
            _ if line.starts_with('[') => table = line,
            Some((name, _)) if !line.starts_with('#') => drop(lines.insert((table, name), line)),
            _ => {}
        }
    }
    lines
}

fn write(folder: &Path, name: &str, text: &str) -> Result<(), String> {
    let file = folder.join(name);
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(&file, text))
        .map_err(|error| format!("cannot write `{}`: {error}", file.display()))
}
