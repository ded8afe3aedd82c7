//! Tokens that arrive faster than they can be written.

use crate::{Folder, repeat};
use apex_macros::graph;
use apex_rt::{
    drive_with,
    prelude::*,
    record::{Recorder, Tap, WhenFull},
};

graph! {
    use apex_tests::nodes::{bits, ranges, swallow};

    robot Fast {
        node r = ranges() every 1ms;
        node sum = bits();
        r -> sum -> swallow();
        record "fast.mcap" { sum.out; }
    }
}

/// Runs with a buffer of `room` bytes. Returns the numbers of lost messages and the report of the replay.
fn lost(when_full: WhenFull, room: usize) -> (Vec<(String, u64)>, apex_rt::record::Report) {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    let recorder = Recorder::with_room::<Fast>(&path, when_full, room).expect("a new file");
    let mut tap = Tap::Record(recorder);
    drive_with(Fast::new(), SimClock::until(Time::from_secs(20)), &mut tap);
    let Tap::Record(recorder) = tap else { unreachable!("it records") };
    let finished = recorder.finish().expect("room for the file");
    (finished.dropped, repeat(Fast::new(), &path))
}

#[test]
fn what_does_not_fit_is_counted_and_reported() {
    let (dropped, report) = lost(WhenFull::Drop, 4096);
    let sum: u64 = dropped.iter().map(|(_, count)| count).sum();
    assert!(sum > 0, "20000 reactions fit into 4 kB");
    assert_eq!(report.dropped, dropped, "the file says the same");
    assert!(report.to_string().contains("were lost during the recording"), "{report}");
    let reactions = dropped.iter().find(|(name, _)| name == "apex/reaction").map_or(0, |(_, count)| *count);
    assert_eq!(report.reactions + reactions, 20_000, "what is there and what was lost is all");
}

#[test]
fn where_time_is_simulated_nothing_is_lost() {
    let (dropped, report) = lost(WhenFull::Wait, 4096);
    assert!(dropped.is_empty() && report.is_same() && report.reactions == 20_000, "{dropped:?} {report}");
}
