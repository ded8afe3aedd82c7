use std::{fs, path::PathBuf};

/// A file with a change, which is undone when the value is dropped.
pub struct Edited {
    path: PathBuf,
    original: String,
}

impl Edited {
    /// Edits a file.
    pub fn new(path: PathBuf, edit: impl Fn(&str) -> String) -> Result<Self, String> {
        let failed = |e| format!("cannot edit `{}`: {e}", path.display());
        let original = fs::read_to_string(&path).map_err(failed)?;
        fs::write(&path, edit(&original)).map_err(failed)?;
        Ok(Self { path, original })
    }
}

impl Drop for Edited {
    fn drop(&mut self) {
        if let Err(e) = fs::write(&self.path, &self.original) {
            eprintln!("error: cannot restore `{}`: {e}", self.path.display());
        }
    }
}
