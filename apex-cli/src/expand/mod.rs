//! `apex expand`.

mod pretty;

use crate::project;
use apex_dsl::passes;
use std::{path::Path, process::ExitCode};

/// Prints the generated Rust. `recordable` if the runtime that it calls can record.
pub fn run(file: &Path, recordable: bool) -> Result<ExitCode, String> {
    let mut checked = project::check_text(file)?;
    let place = |_| proc_macro2::Span::call_site();
    let code = passes::generate(
        &checked.programs,
        &checked.texts.machines,
        &checked.catalog,
        &checked.sources,
        &place,
        recordable,
        &mut checked.diagnostics,
    );
    checked.print_diagnostics();
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    // The graphs of a large program take as much memory as its code.
    drop(checked);
    let text = pretty::print(code).map_err(|e| format!("the generated code is not Rust: {e}; please report this"))?;
    project::print(text.trim_end())?;
    Ok(ExitCode::SUCCESS)
}
