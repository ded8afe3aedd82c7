//! Makes the parser anew: `cargo run -p apex-editors`.

use std::process::ExitCode;

fn main() -> ExitCode {
    match apex_editors::generate(&apex_editors::grammar().join("src")) {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("error: {reason}");
            ExitCode::from(2)
        }
    }
}
