//! What `apex run --params FILE --save-params FILE` does.

use super::{Parameters, load_file, save_file};
use crate::{Clock, Program};
use std::path::Path;

/// Drives `program` as [`drive`](crate::drive) does, with parameters from the file `load`; at the end they are written
/// into the file `save`. Returns the exit code of the program.
///
/// # Errors
/// The first file cannot be loaded, and nothing is run; or the second cannot be written.
pub fn run_with_files<P: Program + Parameters, C: Clock>(
    mut program: P,
    clock: C,
    load: Option<&Path>,
    save: Option<&Path>,
) -> Result<u8, String> {
    if let Some(path) = load {
        load_file(&mut program, path).map_err(|error| error.to_string())?;
    }
    let code = crate::drive(&mut program, clock);
    if let Some(path) = save {
        save_file(&mut program, path).map_err(|error| format!("cannot write `{}`: {error}", path.display()))?;
    }
    Ok(code)
}
