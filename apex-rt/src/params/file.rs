//! Files with parameters.

use super::{LoadError, Parameters, load, save};
use std::{
    ffi::OsString,
    fs,
    io::{self, Write as _},
    path::{Path, PathBuf},
};

/// Maximum length of a file that is loaded, in bytes.
const MAX_BYTES: u64 = 4 << 20;

/// Sets the parameters in the file, as [`load`] does.
///
/// ```
/// use apex_rt::{params::load_file, prelude::*};
///
/// apex_macros::graph!("examples/smooth.afg");
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let file = std::env::temp_dir().join(format!("apex-load-{}.toml", std::process::id()));
/// let mut smooth = Smooth::new();
/// std::fs::write(&file, "[filter]\nweight = 0.25\n")?;
/// load_file(&mut smooth, &file)?;
/// assert_eq!(smooth.param("filter.weight"), Ok(0.25));
/// # std::fs::remove_file(file)?;
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// The file cannot be read, or has errors; then no parameter is changed.
pub fn load_file<P: Parameters>(program: &mut P, path: impl AsRef<Path>) -> Result<(), LoadError> {
    let path = path.as_ref();
    let text = read(path).map_err(|reason| LoadError::Read { path: path.to_owned(), reason })?;
    load(program, &text).map_err(|error| match error {
        LoadError::Text { problems, .. } => LoadError::Text { path: Some(path.to_owned()), problems },
        other => other,
    })
}

/// Writes all parameters into a file, as [`save`] does. An existing file is replaced atomically: concurrent readers see
/// the old file or the new one.
///
/// ```
/// use apex_rt::{params::save_file, prelude::*};
///
/// apex_macros::graph!("examples/smooth.afg");
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let file = std::env::temp_dir().join(format!("apex-save-{}.toml", std::process::id()));
/// let mut smooth = Smooth::new();
/// save_file(&mut smooth, &file)?;
/// assert_eq!(std::fs::read_to_string(&file)?, "[filter]\nweight = 0.5 # 0..=1\n");
/// # std::fs::remove_file(file)?;
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// The file cannot be written, or is not a regular file (a device, a pipe). An existing file is then not changed.
pub fn save_file<P: Parameters>(program: &mut P, path: impl AsRef<Path>) -> io::Result<()> {
    let text = save(program);
    // A link stays; its target is replaced.
    let path = fs::canonicalize(path.as_ref()).unwrap_or_else(|_| path.as_ref().to_owned());
    if fs::metadata(&path).is_ok_and(|old| !old.is_file()) {
        return Err(io::Error::other("it is not a file that can be replaced"));
    }
    let beside = beside(&path)?;
    let result = write(&path, &beside, &text);
    if result.is_err() {
        // The first error is the one to report.
        let _ = fs::remove_file(&beside);
    }
    result
}

fn read(path: &Path) -> Result<String, String> {
    let metadata = fs::metadata(path).map_err(|error| reason(&error))?;
    if metadata.is_dir() {
        return Err("it is a folder".to_owned());
    }
    if !metadata.is_file() {
        return Err("it is not a file".to_owned());
    }
    if metadata.len() > MAX_BYTES {
        return Err(format!("it has {} bytes; at most {MAX_BYTES} are read", metadata.len()));
    }
    let bytes = fs::read(path).map_err(|error| reason(&error))?;
    String::from_utf8(bytes).map_err(|error| format!("byte {} is not UTF-8", error.utf8_error().valid_up_to()))
}

fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        io::ErrorKind::PermissionDenied => "it may not be read".to_owned(),
        _ => error.to_string(),
    }
}

/// Returns the name of a temporary file in the same folder, so that renaming is atomic.
fn beside(path: &Path) -> io::Result<PathBuf> {
    let name = path
        .file_name()
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "this is not the name of a file"))?;
    let mut hidden = OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{}.new", std::process::id()));
    Ok(path.with_file_name(hidden))
}

fn write(path: &Path, beside: &Path, text: &str) -> io::Result<()> {
    let mut file = fs::File::create(beside)?;
    file.write_all(text.as_bytes())?;
    if let Ok(old) = fs::metadata(path) {
        file.set_permissions(old.permissions())?;
    }
    file.sync_all()?;
    fs::rename(beside, path)
}
