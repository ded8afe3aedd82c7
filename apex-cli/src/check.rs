//! `apex check`.

use crate::{Format, project};
use apex_dsl::report::json;
use std::{path::PathBuf, process::ExitCode};

/// Checks each file; 1 if one has errors.
pub fn run(files: &[PathBuf], format: Format) -> Result<ExitCode, String> {
    let mut failed = false;
    let mut messages = vec![];
    for file in files {
        let checked = project::check(file)?;
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
        project::print(&text);
    }
    Ok(if failed { ExitCode::from(1) } else { ExitCode::SUCCESS })
}
