//! Builds the book: `cargo run [FOLDER]`, by default into the folder in `docs/book.toml`.

use std::{env, path::PathBuf, process::ExitCode};

fn main() -> ExitCode {
    let folder = env::args_os().nth(1).map(PathBuf::from);
    match apex_book::build(folder.as_deref()) {
        Ok(folder) => {
            println!("wrote {}", folder.join("index.html").display());
            ExitCode::SUCCESS
        }
        Err(reason) => {
            eprintln!("error: {reason}");
            ExitCode::from(2)
        }
    }
}
