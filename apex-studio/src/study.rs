//! Studies of `apex tune`, of which a page shows the candidates while they run.

mod page;

pub use page::{Asked, Page, Told};

use crate::robot::locked;
use apex_tune::{Follower, Journal, Seen};
use std::{
    collections::VecDeque,
    fs,
    path::PathBuf,
    sync::{
        Arc, Mutex, MutexGuard,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::{Duration, Instant, SystemTime},
};

/// Interval at which a journal is looked at.
const INTERVAL: Duration = Duration::from_millis(200);
/// Time over which the rate of the runs is measured.
const SPAN: Duration = Duration::from_secs(60);

/// A study to be shown.
#[derive(Debug, Clone)]
pub struct Study {
    /// Name that distinguishes it from others.
    pub name: String,
    /// Folder with its journal.
    pub folder: PathBuf,
}

/// A study whose journal is read once a page shows it.
pub struct Followed {
    pub name: String,
    journal: PathBuf,
    has_begun: AtomicBool,
    reading: Mutex<Reading>,
}

/// The journal as far as it has been read.
pub struct Reading {
    follower: Follower,
    /// Error of the journal, at which reading has halted.
    error: Option<String>,
    /// Time of the last change of the file.
    changed: Option<SystemTime>,
    /// Numbers of runs at times of the last minute.
    rate: VecDeque<(Instant, u64)>,
}

impl Followed {
    pub fn new(study: Study) -> Self {
        let journal = study.folder.join(Journal::FILE);
        let follower = Follower::new(journal.clone());
        let reading = Reading { follower, error: None, changed: None, rate: VecDeque::new() };
        Self { name: study.name, journal, has_begun: AtomicBool::new(false), reading: Mutex::new(reading) }
    }

    /// Reads the journal from now on, until the end of the studio.
    pub fn begin(self: &Arc<Self>) {
        if self.has_begun.swap(true, Ordering::Relaxed) {
            return;
        }
        let study = Arc::downgrade(self);
        let follow = move || {
            while let Some(study) = study.upgrade() {
                if !study.read() {
                    drop(study);
                    thread::sleep(INTERVAL);
                }
            }
        };
        if let Err(error) = thread::Builder::new().name("study".to_owned()).spawn(follow) {
            self.reading().error = Some(format!("cannot start a thread: {error}"));
        }
    }

    fn reading(&self) -> MutexGuard<'_, Reading> {
        locked(&self.reading)
    }

    /// Reads the next part of the journal. Returns `false` if there is none for now.
    fn read(&self) -> bool {
        let mut reading = self.reading();
        let read = reading.follower.read();
        let has_read = matches!(read, Ok(true));
        reading.error = read.err().map(|error| error.to_string());
        if !has_read {
            reading.changed = fs::metadata(&self.journal).and_then(|file| file.modified()).ok();
            reading.count();
        }
        has_read
    }
}

impl Reading {
    /// Returns `true` once the file has been looked at.
    fn has_begun(&self) -> bool {
        self.changed.is_some() || self.error.is_some() || self.follower.seen().is_some()
    }

    /// Notes the number of runs, unless the last note is young.
    fn count(&mut self) {
        let (now, runs) = (Instant::now(), self.follower.seen().map_or(0, Seen::runs));
        if self.rate.back().is_some_and(|(_, before)| runs < *before) {
            self.rate.clear();
        }
        if self.rate.back().is_none_or(|(at, _)| now - *at >= Duration::from_secs(1)) {
            self.rate.push_back((now, runs));
        }
        while self.rate.front().is_some_and(|(at, _)| now - *at > SPAN) {
            self.rate.pop_front();
        }
    }

    /// Time in s until all searches end, if the rest of the candidates need as many runs as those before.
    fn left(&self, seen: &Seen) -> Option<f64> {
        let ((first, before), (last, after)) = (self.rate.front()?, self.rate.back()?);
        let rate = (after - before) as f64 / (*last - *first).as_secs_f64();
        let found = || seen.trails().map(|(_, trail)| trail.found());
        let ended: usize = seen.trails().map(|(_, trail)| trail.ended()).sum();
        let each = found().map(|found| found.runs).sum::<u64>() as f64 / ended as f64;
        let total = seen.study().searches as f64 * seen.study().candidates as f64;
        let left = (total * each - seen.runs() as f64).max(0.0) / rate;
        left.is_finite().then_some(left)
    }
}
