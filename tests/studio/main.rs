//! Running programs as viewers and as pages of the studio see them.

mod activity;
mod blobs;
mod browser;
mod bytes;
mod checkpoints;
mod figures;
mod foxglove;
mod hands;
mod hostile;
mod measure;
mod page;
mod pictures;
mod several;
mod shadow;
mod space;
mod steady;
mod stream;
mod study;
mod text;

use apex_macros::graph;
use apex_rt::{
    Clock as _, Next,
    prelude::*,
    studio::{StreamedTime, Studio},
};
use std::{env, path::PathBuf};

graph!("studio/counts.afg");
graph!("studio/counts_moment.afg");
graph!("studio/pump.afg");
graph!("studio/tends.afg");

/// A socket for the program of a test.
fn socket(name: &str) -> PathBuf {
    env::temp_dir().join(format!("apex-studio-{}-{name}", std::process::id()))
}

/// Opens a socket for viewers of a program.
fn open<P: Program>(name: &str, time: StreamedTime) -> Studio {
    Studio::open::<P>(socket(name).to_str().expect("UTF-8"), time).expect("a new socket")
}

/// Runs the program for `seconds` of simulated time.
fn drive(studio: &Studio, seconds: i64) {
    drive_of(studio, Counts::new(), seconds);
}

/// Runs a program for `seconds` of simulated time.
fn drive_of(studio: &Studio, mut program: impl Program, seconds: i64) {
    let mut clock = SimClock::until(Time::from_secs(seconds));
    let mut stream = studio.stream(0);
    loop {
        let now = clock.now();
        stream.before_reaction(now, &mut program);
        let next = program.react_with(now, &mut stream);
        if !matches!(next, Next::At(time) if clock.wait_until(time)) {
            return;
        }
    }
}
