//! Output folder of the pages. Other files in it are not changed.

use super::{html::SIGNATURE, names::is_page};
use crate::replace::put;
use apex_host::read_text;
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::Display,
    fs,
    io::{self, ErrorKind, Read as _, Seek as _, SeekFrom},
    path::{Path, PathBuf},
};

/// File with the names of the pages in a folder.
const LIST: &str = ".apex-doc";
/// First line of that file.
const HEAD: &str = "Made by `apex doc`, which writes and removes the files that are named here.";

/// Maximum size of the list in bytes.
const MAX_BYTES: usize = 16 << 20;

/// A folder that was empty, or was created for pages.
pub struct Folder {
    path: PathBuf,
    /// Names of the pages in it.
    pages: BTreeSet<String>,
}

impl Folder {
    /// Opens a folder, which need not exist. A folder that has other contents and no list of pages is refused.
    pub fn open(path: PathBuf) -> Result<Self, String> {
        let failed = |e: &dyn Display| format!("cannot write pages to `{}`: {e}", path.display());
        let list = path.join(LIST);
        let list = match list.symlink_metadata() {
            Ok(_) => Some(read_text(&list, MAX_BYTES).map_err(|reason| failed(&format!("`{LIST}`: {reason}")))?),
            Err(e) if e.kind() == ErrorKind::NotFound => None,
            Err(e) => return Err(failed(&e)),
        };
        let is_empty = match fs::read_dir(&path) {
            Ok(mut entries) => entries.next().is_none(),
            Err(e) if e.kind() == ErrorKind::NotFound => true,
            Err(e) => return Err(failed(&e)),
        };
        if list.is_none() && !is_empty {
            return Err(format!(
                "`{}` contains files that `apex doc` did not write: choose another folder with `--output`",
                path.display()
            ));
        }
        let lines = list.iter().flat_map(|list| list.lines().skip(1));
        // The list may come from a third party: a listed file is a page only if its name and its end are those of a
        // page.
        let is_ours = |name: &&str| is_page(name) && is_signed(&path.join(name));
        let pages = lines.filter(is_ours).map(str::to_owned).collect();
        Ok(Self { path, pages })
    }

    /// Writes `pages` and removes earlier pages. Files that were not made by `apex doc` are kept.
    pub fn write(&self, pages: &BTreeMap<String, String>) -> Result<(), String> {
        let others = |name: &&String| !self.pages.contains(*name) && self.path.join(name).symlink_metadata().is_ok();
        if let Some(other) = pages.keys().find(others) {
            let path = self.path.join(other);
            return Err(format!("`{}` was not written by `apex doc`: move it elsewhere", path.display()));
        }
        fs::create_dir_all(&self.path).map_err(|e| failed("make", &self.path, &e))?;
        // If writing is interrupted, the list still contains all pages, so that the next run recognises them.
        self.list(self.pages.iter().chain(pages.keys()).collect())?;
        for (name, text) in pages {
            let path = self.path.join(name);
            put(&path, text, None).map_err(|e| failed("write", &path, &e))?;
        }
        for name in self.pages.iter().filter(|name| !pages.contains_key(*name)) {
            let path = self.path.join(name);
            match fs::remove_file(&path) {
                Err(e) if e.kind() != ErrorKind::NotFound => return Err(failed("remove", &path, &e)),
                _ => {}
            }
        }
        self.list(pages.keys().collect())
    }

    /// Writes the list of pages.
    fn list(&self, names: BTreeSet<&String>) -> Result<(), String> {
        let text: String =
            [HEAD].into_iter().chain(names.into_iter().map(String::as_str)).flat_map(|l| [l, "\n"]).collect();
        let path = self.path.join(LIST);
        put(&path, &text, None).map_err(|e| failed("write", &path, &e))
    }

    /// Path of the start page.
    pub fn index(&self) -> PathBuf {
        self.path.join(super::names::Names::INDEX)
    }
}

/// `true` for a regular file, not a link, that ends as pages do.
fn is_signed(path: &Path) -> bool {
    let end = || {
        if !path.symlink_metadata()?.is_file() {
            return Err(ErrorKind::InvalidInput.into());
        }
        let mut file = fs::File::open(path)?;
        file.seek(SeekFrom::End(-(SIGNATURE.len() as i64)))?;
        let mut end = vec![];
        file.take(SIGNATURE.len() as u64).read_to_end(&mut end)?;
        Ok::<_, io::Error>(end)
    };
    end().is_ok_and(|end| end == SIGNATURE.as_bytes())
}

fn failed(what: &str, path: &Path, error: &io::Error) -> String {
    format!("cannot {what} `{}`: {error}", path.display())
}
