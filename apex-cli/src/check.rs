//! `apex check`.

use crate::{Format, fix, project, texts};
use apex_dsl::report::json;
use std::{path::PathBuf, process::ExitCode};

/// Checks source files and all source files in folders. With `mend` it first applies unambiguous fixes. The exit code
/// is 1 if an error is left.
pub fn run(paths: &[PathBuf], format: Format, mend: bool) -> Result<ExitCode, String> {
    let mut failed = false;
    let mut messages = vec![];
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
        match format {
            Format::Text => checked.print_diagnostics(),
            Format::Json => {
                messages.extend(checked.diagnostics.sorted().into_iter().map(|d| json(d, &checked.sources)))
            }
        }
    }
    if format == Format::Json {
        let text = serde_json::to_string_pretty(&messages).map_err(|e| e.to_string())?;
        project::print(&text)?;
    }
    Ok(if failed { ExitCode::from(1) } else { ExitCode::SUCCESS })
}
