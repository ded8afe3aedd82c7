//! Writes files.

use std::{
    fs::{self, Permissions},
    io::{self, ErrorKind, Write as _},
    path::Path,
    process,
};

/// Writes a file that is new or can be generated again.
pub fn write(path: &Path, text: &str) -> Result<(), String> {
    fs::write(path, text).map_err(|e| {
        let shown = path.display();
        match path.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.exists()) {
            Some(folder) => format!("cannot write `{shown}`: there is no folder `{}`", folder.display()),
            None => format!("cannot write `{shown}`: {e}"),
        }
    })
}

/// `true` if both paths exist and lead to the same file.
pub fn is_same(a: &Path, b: &Path) -> bool {
    fs::canonicalize(a).is_ok_and(|a| fs::canonicalize(b).is_ok_and(|b| a == b))
}

/// Replaces the content of the file `path`. The file is complete at all times.
pub fn replace(path: &Path, text: &str) -> io::Result<()> {
    // Follows links, so that the target is replaced and not the link.
    let path = fs::canonicalize(path)?;
    let metadata = fs::metadata(&path)?;
    if !metadata.is_file() {
        return Err(io::Error::new(ErrorKind::InvalidInput, "it is a device or a pipe, which cannot be replaced"));
    }
    let permissions = metadata.permissions();
    if permissions.readonly() {
        return Err(io::Error::new(ErrorKind::PermissionDenied, "it is read-only"));
    }
    put(&path, text, Some(permissions))
}

/// Writes a temporary file beside `path` and renames it to `path`, whether or not `path` exists.
pub fn put(path: &Path, text: &str, permissions: Option<Permissions>) -> io::Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let temporary = path.with_file_name(format!(".{name}.{}", process::id()));
    let written = fs::File::create_new(&temporary).and_then(|mut file| {
        file.write_all(text.as_bytes())?;
        permissions.map_or(Ok(()), |permissions| file.set_permissions(permissions))?;
        file.sync_all()
    });
    let result = written.and_then(|()| fs::rename(&temporary, path));
    if result.is_err() {
        let _ = fs::remove_file(&temporary);
    }
    result
}
