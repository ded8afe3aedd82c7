//! `apex lsp`.

use std::process::ExitCode;

/// Serves an editor on standard input and output until it leaves.
pub fn run() -> Result<ExitCode, String> {
    let in_good_order = apex_lsp::stdio()?;
    // What the protocol asks for where the editor did not say goodbye.
    Ok(if in_good_order { ExitCode::SUCCESS } else { ExitCode::from(1) })
}
