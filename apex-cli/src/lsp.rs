//! `apex lsp`.

use std::process::ExitCode;

/// Serves an editor on standard input and output until the editor disconnects.
pub fn run() -> Result<ExitCode, String> {
    let in_good_order = apex_lsp::stdio()?;
    // The protocol requires exit code 1 if the editor did not send `shutdown` first.
    Ok(if in_good_order { ExitCode::SUCCESS } else { ExitCode::from(1) })
}
