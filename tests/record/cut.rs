//! Truncated files, and files that are not recordings.

use crate::{Folder, record, repeat};
use apex_macros::graph;
use apex_rt::{drive_with, prelude::*, record::replay};
use std::fs;

graph! {
    use apex_tests::nodes::{Mean, noise, swallow};

    robot Small {
        node a = noise() every 1ms;
        node mean = Mean();
        a -> mean -> swallow();
        record "small.mcap" { mean.out; }
    }
}

/// Records a run of `ms` milliseconds.
pub fn run(path: &std::path::Path, ms: i64) {
    record::<Small>(path, |tap| {
        drive_with(Small::new(), SimClock::until(Time::from_millis(ms)), tap);
    });
}

#[test]
fn a_file_that_was_cut_anywhere_is_read_up_to_the_cut() {
    let folder = Folder::new();
    let (whole, cut) = (folder.file("whole.mcap"), folder.file("cut.mcap"));
    run(&whole, 12);
    let bytes = fs::read(&whole).expect("it was written");
    let (mut last, mut most) = (0, 0);
    for length in 0..bytes.len() {
        fs::write(&cut, &bytes[..length]).expect("room for it");
        match replay(Small::new(), &cut, ()) {
            Ok(report) => {
                assert!(report.is_same(), "{length}: {report}");
                assert!(report.reactions >= last, "{length}: {report}");
                assert!(report.cut.is_some() || report.reactions == 12, "{length}: {report}");
                (last, most) = (report.reactions, most.max(report.reactions));
            }
            // The header is not complete.
            Err(error) => assert!(last == 0, "{length}: {error}"),
        }
    }
    // A last reaction is known to be complete only if the end of the file confirms it.
    assert_eq!(most, 11);
}

#[test]
fn a_file_with_other_bits_never_panics() {
    let folder = Folder::new();
    let (whole, bad) = (folder.file("whole.mcap"), folder.file("bad.mcap"));
    run(&whole, 10);
    let bytes = fs::read(&whole).expect("it was written");
    for at in 0..bytes.len() {
        let mut bytes = bytes.clone();
        bytes[at] ^= 0x55;
        fs::write(&bad, &bytes).expect("room for it");
        // Any result is valid, as long as there is one.
        let _ = replay(Small::new(), &bad, ());
    }
}

#[test]
fn what_is_no_recording_is_said_so() {
    let folder = Folder::new();
    let message = |name: &str| replay(Small::new(), &folder.file(name), ()).expect_err("no recording").to_string();
    fs::write(folder.file("text"), "Hello, this is no recording at all").expect("room for it");
    fs::write(folder.file("empty"), "").expect("room for it");
    assert!(message("text").ends_with("it is not an MCAP file, or its beginning is damaged"), "{}", message("text"));
    assert!(message("empty").contains("it is empty"), "{}", message("empty"));
    assert!(message("missing").starts_with("cannot read `"), "{}", message("missing"));
    let error = replay(Small::new(), &folder.0, ()).expect_err("a folder").to_string();
    assert!(error.contains("it is a folder without `metadata.yaml`: name one of its files"), "{error}");
}

#[test]
fn a_whole_file_says_nothing_of_a_cut() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    run(&path, 20);
    let report = repeat(Small::new(), &path);
    assert_eq!((report.cut, report.reactions), (None, 20));
}
