//! `apex check`.

use crate::{answer::Answer, fix, project, texts};
use serde_json::json;
use std::{path::PathBuf, process::ExitCode};

/// Checks source files and all source files in folders. With `mend` it first applies unambiguous fixes. The exit code
/// is 1 if an error is left.
pub fn run(paths: &[PathBuf], mend: bool, answer: &mut Answer) -> Result<ExitCode, String> {
    let mut failed = false;
    let files: Vec<Vec<PathBuf>> = paths.iter().map(|path| texts::named(path)).collect::<Result<_, _>>()?;
    for file in files.iter().flatten() {
        if mend && project::is_input(file) {
            return Err("standard input cannot be changed: leave out `--fix`, or name a file".to_owned());
        }
        if mend {
            fix::file(file)?.iter().for_each(|change| project::print_error(change));
        }
        let checked = project::check_text(file)?;
        failed |= checked.diagnostics.has_errors();
        answer.messages(&checked.diagnostics, &checked.sources);
    }
    if answer.is_json() {
        let files: Vec<String> = files.iter().flatten().map(|file| file.display().to_string()).collect();
        answer.give(String::new, || json!({ "files": files }))?;
    }
    Ok(if failed { ExitCode::from(1) } else { ExitCode::SUCCESS })
}
