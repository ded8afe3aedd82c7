use std::{fs, path::Path};

/// Writes a text to a file, and creates the folder of the file.
///
/// # Errors
/// If one of them cannot be written.
pub fn write_file(path: &Path, text: &str) -> Result<(), String> {
    let written = path.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| fs::write(path, text));
    written.map_err(|e| format!("cannot write {}: {e}", path.display()))
}
