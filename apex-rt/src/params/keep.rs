//! What a program changed while it ran is kept for the next one, which may be another: `apex run --watch`.

use super::{Parameters, load, save};
use std::{collections::BTreeMap, format, fs, path::Path, string::String};

/// The parameters as the texts and files said them, and as they were at the end.
const SAID: &str = "said.toml";
const LAST: &str = "last.toml";

/// Sets what the program before changed, except where the text now says something else than it said then.
pub fn resume<P: Parameters>(program: &mut P, folder: &Path) -> Result<(), String> {
    let now = save(program);
    let read = |name| fs::read_to_string(folder.join(name)).unwrap_or_default();
    let (said, last) = (read(SAID), read(LAST));
    let (said, last, same) = (lines(&said), lines(&last), lines(&now));
    for (at, line) in last {
        let was = said.get(&at);
        if was.is_some_and(|was| *was != line) && was == same.get(&at) {
            // The name, the type and the range are what they were: it is taken again.
            let _ = load(program, &format!("{}\n{line}\n", at.0));
        }
    }
    write(folder, SAID, &now)?;
    keep(program, folder)
}

/// Remembers all parameters for the program after this one.
pub fn keep<P: Parameters>(program: &mut P, folder: &Path) -> Result<(), String> {
    write(folder, LAST, &save(program))
}

/// The lines of a saved text, by their table and the name of the parameter.
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
