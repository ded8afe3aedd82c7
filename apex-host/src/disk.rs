use apex_dsl::{
    catalog::{Item, RustFiles, read_items},
    source::World,
    syntax::MAX_BYTES,
};
use serde::{Deserialize, Serialize};
use std::{
    collections::BTreeMap,
    fs,
    io::{self, Read},
    mem,
    path::{Path, PathBuf},
    sync::Arc,
    time::UNIX_EPOCH,
};

/// Version of the cached items: increment it whenever their format changes.
const VERSION: u32 = 17;

#[derive(Serialize, Deserialize, Default)]
struct Cache {
    version: u32,
    files: BTreeMap<PathBuf, Entry>,
}

#[derive(Serialize, Deserialize)]
struct Entry {
    modified: u128,
    length: u64,
    items: Arc<[Item]>,
}

/// Stamp that identifies the state of a file: its time of modification, in ns since the Unix epoch, and its length in
/// bytes; `None` if there is no such file.
pub(crate) type Stamp = Option<(u128, u64)>;

/// The file system, with a cache of the items in Rust files by path, time and length.
pub struct Disk {
    file: Option<PathBuf>,
    /// The cache, once it was needed.
    cache: Option<Cache>,
    changed: bool,
    /// The files on which the answers since the last [`Disk::take_asked`] depend.
    asked: BTreeMap<PathBuf, Stamp>,
    /// Items of Rust files that need not exist.
    given: BTreeMap<PathBuf, Arc<[Item]>>,
}

impl Disk {
    /// Returns the file system with the cache in `folder`, or without a cache. A cache that cannot be read is replaced.
    pub fn new(folder: Option<&Path>) -> Self {
        let file = folder.map(|f| f.join("catalog.json"));
        Self { file, cache: None, changed: false, asked: BTreeMap::new(), given: BTreeMap::new() }
    }

    /// Adds the items of Rust files, which need not exist.
    pub fn with_items(mut self, given: impl IntoIterator<Item = (PathBuf, Arc<[Item]>)>) -> Self {
        self.given.extend(given);
        self
    }

    fn cache(&mut self) -> &mut Cache {
        self.cache.get_or_insert_with(|| {
            let bytes = self.file.as_ref().and_then(|f| fs::read(f).ok());
            let cache = bytes.and_then(|bytes| serde_json::from_slice::<Cache>(&bytes).ok());
            cache.filter(|c| c.version == VERSION).unwrap_or(Cache { version: VERSION, files: BTreeMap::new() })
        })
    }

    /// Takes the files that were requested since the last call, with their stamps at that time.
    pub(crate) fn take_asked(&mut self) -> BTreeMap<PathBuf, Stamp> {
        mem::take(&mut self.asked)
    }

    /// Returns `true` if the items of a file were requested.
    #[cfg(test)]
    pub(crate) fn has_read_items(&self) -> bool {
        self.cache.is_some()
    }

    /// Writes the cache if it changed. Errors are ignored, because the cache only saves time.
    pub fn save(&mut self) {
        let Some(file) = self.file.as_ref().filter(|_| self.changed) else { return };
        if let Some(cache) = &self.cache {
            let _ = write_whole(file, cache);
        }
        self.changed = false;
    }
}

/// Writes `value` atomically: other processes see the old file or the new one, never a part.
pub(crate) fn write_whole(file: &Path, value: &impl Serialize) -> io::Result<()> {
    let folder = file.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let temporary = file.with_extension(format!("{}.tmp", std::process::id()));
    fs::write(&temporary, serde_json::to_vec(value)?)?;
    fs::rename(&temporary, file)
}

pub(crate) fn stamp(path: &Path) -> Stamp {
    let metadata = fs::metadata(path).ok()?;
    let modified = metadata.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
    Some((modified.as_nanos(), metadata.len()))
}

/// Returns the text in the file `path`.
///
/// # Errors
/// The file cannot be read, has more than `most` bytes, or is not UTF-8.
pub fn read_text(path: &Path, most: usize) -> Result<String, String> {
    let metadata = fs::metadata(path).map_err(|e| reason(&e))?;
    if metadata.is_dir() {
        return Err("it is a folder".to_owned());
    }
    if metadata.len() > most as u64 {
        return Err(format!("it has {} bytes; at most {most} are read", metadata.len()));
    }
    read_from(fs::File::open(path).map_err(|e| reason(&e))?, most)
}

/// Returns the text of `source`. Its length is not known in advance: a file that looks empty may have no end.
///
/// # Errors
/// `source` cannot be read, has more than `most` bytes, or is not UTF-8.
pub fn read_from(source: impl Read, most: usize) -> Result<String, String> {
    let mut bytes = vec![];
    // One byte more than allowed is enough to detect a longer text.
    source.take(most as u64 + 1).read_to_end(&mut bytes).map_err(|e| reason(&e))?;
    if bytes.len() > most {
        return Err(format!("at most {most} bytes are read"));
    }
    String::from_utf8(bytes).map_err(|e| format!("byte {} is not UTF-8", e.utf8_error().valid_up_to()))
}

impl World for Disk {
    fn read(&mut self, path: &Path) -> Result<Arc<str>, String> {
        Ok(read_text(path, MAX_BYTES)?.into())
    }

    fn exists(&mut self, path: &Path) -> bool {
        self.asked.insert(path.to_owned(), stamp(path));
        self.given.contains_key(path) || path.is_file()
    }
}

impl RustFiles for Disk {
    fn items(&mut self, path: &Path) -> Result<Arc<[Item]>, String> {
        if let Some(items) = self.given.get(path) {
            return Ok(items.clone());
        }
        let stamp = stamp(path);
        self.asked.insert(path.to_owned(), stamp);
        if let (Some(entry), Some(stamp)) = (self.cache().files.get(path), stamp)
            && (entry.modified, entry.length) == stamp
        {
            return Ok(entry.items.clone());
        }
        let text = self.read(path)?;
        let items: Arc<[Item]> = read_items(&text).into();
        if let Some((modified, length)) = stamp {
            self.cache().files.insert(path.to_owned(), Entry { modified, length, items: items.clone() });
            self.changed = true;
        }
        Ok(items)
    }
}

fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        io::ErrorKind::PermissionDenied => "it may not be read".to_owned(),
        _ => error.to_string(),
    }
}
