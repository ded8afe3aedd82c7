//! What `apex run` does with `--params`, `--save-params` and `--watch`.

use super::{Parameters, keep, load_file, save_file};
use crate::{Clock, Program};
use std::path::Path;

/// Drives `program` as [`drive`](crate::drive) does, with parameters from the file `load`; at the end they are written
/// into the file `save`. In the folder `kept` stands what the program before changed in its own: that is set again where
/// nothing else was said meanwhile, and what this one changes is added. Returns the exit code of the program.
///
/// # Errors
/// The first file cannot be loaded, and nothing is run; or the others cannot be written.
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
