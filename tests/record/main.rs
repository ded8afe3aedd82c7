//! Recordings: a run that is repeated from its file is bitwise the same run.

mod bags;
mod cut;
mod damage;
mod feed;
mod foreign;
mod full;
mod limits;
mod python;
mod robot;
mod round;
mod stamps;
mod threads;
mod types;

use apex_rt::{
    Program, StdErr,
    record::{Finished, Recorder, Report, Tap, WhenFull, replay},
};
use std::{
    env, fs,
    path::{Path, PathBuf},
    sync::atomic::{AtomicU32, Ordering},
};

/// A folder of a test, which is removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let folder = env::temp_dir().join(format!("apex-record-{}-{number}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder for temporary files");
        Self(folder)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Records a run that `drive` makes.
fn record<P: Program>(path: &Path, mut drive: impl FnMut(&mut Tap)) -> Finished {
    let mut tap = Tap::Record(Recorder::to_file::<P>(path, WhenFull::Wait).expect("a new file"));
    drive(&mut tap);
    let Tap::Record(recorder) = tap else { unreachable!("it records") };
    recorder.finish().expect("room for the file")
}

fn repeat<P: Program>(program: P, path: &Path) -> Report {
    replay(program, path, StdErr(const { &P::INFO })).expect("a recording")
}
