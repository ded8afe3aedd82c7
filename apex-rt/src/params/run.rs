//! Implementation of `--params`, `--save-params` and `--watch` of `apex run`.

use super::{Parameters, keep, load_file, save_file};
use crate::{Clock, Program};
use std::path::Path;

/// Drives `program` as [`drive`](crate::drive) does, with parameters from the file `load`, and saves them in the file
/// `save` at the end. The folder `kept` has the parameters that the previous run changed. They are set again unless
/// their declarations have changed, and the changes of this run are added. Returns the exit code of the program.
///
/// # Errors
/// The file `load` cannot be loaded or the folder `kept` cannot be written: nothing is run. Or `kept` or `save` cannot
/// be written after the run.
pub fn run_with_files<P: Program + Parameters, C: Clock>(
    mut program: P,
    clock: C,
    load: Option<&Path>,
    save: Option<&Path>,
    kept: Option<&Path>,
) -> Result<u8, String> {
    if let Some(path) = load {
        load_file(&mut program, path).map_err(|error| error.to_string())?;
    }
    if let Some(folder) = kept {
        keep::resume(&mut program, folder)?;
    }
    let code = crate::drive(&mut program, clock);
    if let Some(folder) = kept {
        keep::keep(&mut program, folder)?;
    }
    if let Some(path) = save {
        save_file(&mut program, path).map_err(|error| format!("cannot write `{}`: {error}", path.display()))?;
    }
    Ok(code)
}
