//! Replays of recordings.

use crate::{
    mutate::{Dice, bytes},
    worker::Target,
};
use apex_macros::graph;
use apex_rt::{
    drive_with,
    prelude::*,
    record::{Recorder, Tap, WhenFull, replay},
};
use std::{env, fs, path::PathBuf, process};

graph! {
    use apex_tests::nodes::{Mean, Moody, bits, noise, ranges, same, swallow};

    /// Sources of some kinds, and ports.
    robot Restless {
        node a = noise() every 3ms;
        node r = ranges() every 4ms;
        node m = Moody() every 2ms;
        node mean = Mean();
        node sum = bits();

        a -> mean;
        r -> sum -> m.ask;
        mean -> same() -> swallow();

        record "restless.mcap" {
            mean.out;
            sum.out;
        }
    }
}

struct Recordings {
    whole: Vec<Vec<u8>>,
    file: PathBuf,
}

/// The target with recordings.
pub fn recordings() -> Box<dyn Target> {
    let file = env::temp_dir().join(format!("apex-fuzz-{}.mcap", process::id()));
    let whole = [1, 12, 60].map(|ms| recorded(&file, ms)).into();
    Box::new(Recordings { whole, file })
}

fn recorded(file: &PathBuf, ms: i64) -> Vec<u8> {
    let _ = fs::remove_file(file);
    let mut tap = Tap::Record(Recorder::to_file::<Restless>(file, WhenFull::Wait).expect("a new file"));
    drive_with(Restless::new(), SimClock::until(Time::from_millis(ms)), &mut tap);
    let Tap::Record(recorder) = tap else { unreachable!("it records") };
    recorder.finish().expect("room for the file");
    fs::read(file).expect("it was written")
}

impl Target for Recordings {
    fn make(&mut self, dice: &mut Dice) -> Vec<u8> {
        let whole = dice.of(&self.whole).clone();
        bytes(&whole, dice)
    }

    fn run(&mut self, input: &[u8]) {
        fs::write(&self.file, input).expect("room for the file");
        // Any result is valid, as long as it can be printed.
        let _ = replay(Restless::new(), &self.file, ()).map(|report| report.to_string()).map_err(|e| e.to_string());
    }
}

impl Drop for Recordings {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.file);
    }
}
