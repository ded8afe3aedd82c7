//! The documentation as a book of HTML pages, made with mdBook as a library, so that it need not be installed.

use mdbook_driver::MDBook;
use std::path::{Path, PathBuf};

/// Folder of the pages.
pub fn pages() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

/// Builds the book into `folder`, or into the folder in `book.toml`.
///
/// # Errors
/// Fails if a page is missing, or cannot be read or written.
pub fn build(folder: Option<&Path>) -> Result<PathBuf, String> {
    let mut book = MDBook::load(pages()).map_err(|e| format!("{e:#}"))?;
    if let Some(folder) = folder {
        book.config.build.build_dir = folder.to_owned();
    }
    book.build().map_err(|e| format!("{e:#}"))?;
    Ok(book.build_dir_for("html"))
}
