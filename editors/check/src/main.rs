//! Writes the parser where editors and packagers look for it: `cargo run [FOLDER]`, without a folder
//! `tree-sitter-afg/src`.

use std::{env, fs, path::PathBuf, process::ExitCode};

fn main() -> ExitCode {
    let folder = env::args_os().nth(1).map_or_else(|| apex_editors::grammar().join("src"), PathBuf::from);
    let written = fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()));
    match written.and_then(|()| apex_editors::generate(&folder)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("error: {reason}");
            ExitCode::from(2)
        }
    }
}
