//! The program that `apex test` makes of pieces of Rust: it runs tests, and says how they ended.

use crate::{compiled::Compiled, glue::Piece, source::Source, test};
use apex_dsl::codegen::Key;
use std::{
    env,
    panic::{self, AssertUnwindSafe},
    path::Path,
    process::ExitCode,
    sync::{Mutex, PoisonError},
};

/// Beginning of the lines that say what the program does; all others are the output of nodes.
pub const MARK: char = '\u{1e}';

/// The message of the last panic.
static PANIC: Mutex<String> = Mutex::new(String::new());

/// Runs tests: the arguments are the folder and the name of the package, the source file, the folder to which the paths
/// in messages are relative, the folder for caches, and the names of the tests.
pub fn serve(pieces: &'static [(Key, Piece)]) -> ExitCode {
    let args: Vec<String> = env::args().skip(1).collect();
    let served = match args.as_slice() {
        [folder, name, text, root, cache, names @ ..] => {
            let source = Source::load(Path::new(folder), (name, true), Path::new(text), Path::new(cache));
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            source.and_then(|source| run_tests(&source, &names, Path::new(root), pieces))
        }
        _ => Err("arguments are missing".to_owned()),
    };
    match served {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

/// Runs the tests with these names, and prints how they end. The paths in messages are relative to `root`.
///
/// # Errors
/// Returns what the interpreter does not know.
pub fn run_tests(source: &Source, names: &[&str], root: &Path, pieces: &'static [(Key, Piece)]) -> Result<(), String> {
    let pieces = pieces.iter().map(|(key, piece)| (*key, piece)).collect();
    panic::set_hook(Box::new(remember));
    for (program, scripts) in source.tests(names) {
        let boxed = source.boxed(program)?;
        let library = Compiled { boxed: &boxed, pieces: &pieces, catalog: &source.catalog };
        for script in scripts {
            println!("{MARK}begin {}", script.name);
            let run = || test::run(program, script, &library, source, root);
            match panic::catch_unwind(AssertUnwindSafe(run)) {
                Ok(result) => {
                    result?;
                    println!("{MARK}passed");
                }
                Err(_) => {
                    let message = PANIC.lock().unwrap_or_else(PoisonError::into_inner);
                    println!("{MARK}failed\n{message}\n{MARK}end");
                }
            }
        }
    }
    Ok(())
}

/// Keeps the message of a panic: of a test that fails, or of a node.
fn remember(info: &panic::PanicHookInfo<'_>) {
    let payload = info.payload();
    let said = payload.downcast_ref::<String>().map(String::as_str).or_else(|| payload.downcast_ref().copied());
    let said = said.unwrap_or("panicked");
    let place = info.location().filter(|_| !said.starts_with("test `"));
    let place = place.map_or_else(String::new, |at| format!("panicked at {at}:\n"));
    *PANIC.lock().unwrap_or_else(PoisonError::into_inner) = place + said;
}
