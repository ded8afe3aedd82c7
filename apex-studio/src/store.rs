//! A temporary file for the history of robots: pages of equal size, which are used again when they are free.

use std::{
    env,
    fs::{self, File},
    io::{self, Read as _, Seek as _, SeekFrom, Write as _},
    path::PathBuf,
    process,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicU32, Ordering},
    },
};

/// Size of a page in bytes.
pub const PAGE: usize = 64 << 10;
/// Number of pages: 1 GiB.
const MAX_PAGES: u64 = 16 << 10;

/// A temporary file, which is created with its first page.
#[derive(Default)]
pub struct Store(Mutex<State>);

#[derive(Default)]
struct State {
    file: Option<Temporary>,
    /// Number of pages in the file, and those of them that are free.
    end: u64,
    free: Vec<u64>,
    /// `true` if the file could not be created.
    failed: bool,
}

/// A page of the file, which is free again when this is dropped.
pub struct Page {
    store: Arc<Store>,
    number: u64,
    length: usize,
}

impl Store {
    /// Writes a page of at most [`PAGE`] bytes. Returns `None` if there is no room for it.
    pub fn keep(self: &Arc<Self>, bytes: &[u8]) -> Option<Page> {
        let mut state = self.state();
        if state.file.is_none() && !state.failed {
            match Temporary::new() {
                Ok(file) => state.file = Some(file),
                Err(error) => {
                    eprintln!("warning: no history is kept on the disk: {error}");
                    state.failed = true;
                }
            }
        }
        let number = match state.free.pop() {
            Some(number) => number,
            None if state.end < MAX_PAGES => state.end,
            None => return None,
        };
        match state.file.as_mut().map(|file| file.write(number, bytes)) {
            Some(Ok(())) => {
                state.end = state.end.max(number + 1);
                Some(Page { store: Arc::clone(self), number, length: bytes.len() })
            }
            _ => {
                // A page that could not be written, because the disk is full, stays free.
                let is_old = number < state.end;
                state.free.extend(is_old.then_some(number));
                None
            }
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Page {
    /// The bytes of the page; none if they cannot be read.
    pub fn read(&self) -> Vec<u8> {
        let mut state = self.store.state();
        let read = state.file.as_mut().map(|file| file.read(self.number, self.length));
        read.and_then(Result::ok).unwrap_or_default()
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        self.store.state().free.push(self.number);
    }
}

/// A file that nothing is left of at the end, however this process ends.
struct Temporary {
    file: File,
    /// Its path, as long as it has one.
    path: Option<PathBuf>,
}

impl Temporary {
    fn new() -> io::Result<Self> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = env::temp_dir().join(format!("apex-studio-history-{}-{number}", process::id()));
        // One of an earlier process with the same number.
        let _ = fs::remove_file(&path);
        let file = File::options().read(true).write(true).create_new(true).open(&path)?;
        // Unix keeps a file without a name until it is closed.
        let path = if cfg!(unix) && fs::remove_file(&path).is_ok() { None } else { Some(path) };
        Ok(Self { file, path })
    }

    fn write(&mut self, page: u64, bytes: &[u8]) -> io::Result<()> {
        self.file.seek(SeekFrom::Start(page * PAGE as u64))?;
        self.file.write_all(bytes)
    }

    fn read(&mut self, page: u64, length: usize) -> io::Result<Vec<u8>> {
        let mut bytes = vec![0; length];
        self.file.seek(SeekFrom::Start(page * PAGE as u64))?;
        self.file.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        self.path.iter().for_each(|path| drop(fs::remove_file(path)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_are_kept_and_used_again() {
        let store = Arc::new(Store::default());
        let pages = [1, 2, 3].map(|byte| store.keep(&[byte; 10]).unwrap());
        assert_eq!(pages.each_ref().map(|page| page.read()[9]), [1, 2, 3]);
        let [_, two, _] = pages;
        assert_eq!(two.number, 1);
        drop(two);
        let all = [store.keep(&[7; PAGE]).unwrap(), store.keep(&[8; 1]).unwrap()];
        assert_eq!(all.each_ref().map(|page| page.number), [1, 3]);
        assert_eq!(all[0].read(), [7; PAGE]);
    }
}
