//! What `apex run --params FILE --save-params FILE` does.

use super::{Parameters, load_file, save_file};
use crate::{Clock, Program};
use std::path::Path;

/// Drives `program` as [`run`](crate::run()) does, with parameters from the file `load`; at the end they are written into
/// the file `save`.
///
/// # Errors
/// The first file cannot be loaded, and nothing is run; or the second cannot be written.
pub fn run_with_files<P: Program + Parameters, C: Clock>(
    mut program: P,
    clock: C,
    load: Option<&Path>,
    save: Option<&Path>,
) -> Result<(), String> {
    if let Some(path) = load {
        load_file(&mut program, path).map_err(|error| error.to_string())?;
    }
    crate::run(&mut program, clock);
    match save {
        Some(path) => {
            save_file(&mut program, path).map_err(|error| format!("cannot write `{}`: {error}", path.display()))
        }
        None => Ok(()),
    }
}
