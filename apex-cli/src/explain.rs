//! `apex explain`.

use crate::{Format, project};
use apex_dsl::{
    petri,
    report::{explain, explain_json},
};
use std::{path::Path, process::ExitCode};

/// Prints what was decided about each program of a text.
pub fn run(file: &Path, format: Format) -> Result<ExitCode, String> {
    let checked = project::check(file)?;
    checked.print_diagnostics();
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    match format {
        Format::Text => checked.programs.iter().for_each(|p| project::print(&explain(p, &checked.catalog))),
        Format::Json => {
            let programs: Vec<_> = checked.programs.iter().map(|p| explain_json(p, &checked.catalog)).collect();
            project::print(&serde_json::to_string_pretty(&programs).map_err(|e| e.to_string())?);
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Prints the Petri net of each program of a text.
pub fn pnml(file: &Path) -> Result<ExitCode, String> {
    let checked = project::check(file)?;
    checked.print_diagnostics();
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    for program in &checked.programs {
        let net = petri::net(&program.graph, &checked.catalog).map_err(|e| e.to_string())?;
        project::print(&petri::pnml(&net));
    }
    Ok(ExitCode::SUCCESS)
}
