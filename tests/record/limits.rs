//! Recordings with limits: several files, of which the oldest ones are removed, plain and compressed.

use crate::{Folder, repeat};
use apex_macros::graph;
use apex_rt::{
    Program, drive_with,
    prelude::*,
    record::{Codec, Finished, Message as _, RecordOptions, Recorder, Tap, WhenFull, replay, tokens},
};
use std::{fs, path::Path, time::Duration};

graph! {
    use apex_tests::nodes::{Mean, bits, count, ranges, swallow};

    robot Busy {
        node r = ranges() every 1ms;
        node n = count() every 1ms;
        node sum = bits();
        r -> sum -> swallow();
        n -> swallow();
        record "busy.mcap" { sum.out; n; }
    }

    robot Limited {
        node n = count() every 10ms;
        n -> swallow();
        record "limited.mcap"(limit = 1.5GB, age = 10min, compress = true) {}
    }

    /// A program whose state depends on all that has happened.
    robot Smooth {
        node n = count() every 10ms;
        node mean = Mean();
        n -> apex_nodes::math::scale(factor = 1.0) -> mean -> swallow();
        record "smooth.mcap" { mean.out; }
    }
}

/// Records `seconds` of a program.
fn recorded<P: Program>(program: P, path: &Path, options: RecordOptions, seconds: i64) -> Finished {
    let recorder = Recorder::to_file_with::<P>(path, WhenFull::Wait, options).expect("a new file");
    let mut tap = Tap::Record(recorder);
    drive_with(program, SimClock::until(Time::from_secs(seconds)), &mut tap);
    let Tap::Record(recorder) = tap else { unreachable!("it records") };
    recorder.finish().expect("room for the file")
}

#[test]
fn the_options_of_a_statement_are_in_lines() {
    let text = "limited.mcap\nlimit 1500000000\nage 600000000000\ncompress";
    assert_eq!(Limited::RECORD, Some(text));
    assert_eq!(Smooth::RECORD, Some("smooth.mcap"));
}

/// Sizes of the files that are there, and their names.
fn files(folder: &Folder) -> Vec<(String, u64)> {
    let files = fs::read_dir(&folder.0).expect("a folder").map(|file| file.expect("a file"));
    let file = |f: fs::DirEntry| (f.file_name().into_string().expect("a name"), f.metadata().expect("a size").len());
    let mut files: Vec<_> = files.map(file).collect();
    files.sort();
    files
}

fn limit(bytes: u64, compress: bool) -> RecordOptions {
    RecordOptions { limit: Some(bytes), compress, ..RecordOptions::default() }
}

#[test]
fn all_files_together_are_the_run() {
    for compress in [false, true] {
        let folder = Folder::new();
        let finished = recorded(Busy::new(), &folder.file("a.mcap"), limit(16_000_000, compress), 40);
        assert!(finished.files.len() >= 2, "{finished:?}");
        assert_eq!(finished.path, folder.file("a.0001.mcap"));
        assert_eq!(finished.files.len(), files(&folder).len());
        let report = repeat(Busy::new(), &finished.path);
        assert!(report.is_same() && report.is_whole(), "{report}");
        assert_eq!((report.reactions, report.file, report.compared[0].equal), (40_000, 1, 40_000), "{report}");
    }
}

#[test]
fn the_size_of_all_files_is_bounded() {
    for compress in [false, true] {
        let folder = Folder::new();
        let finished = recorded(Busy::new(), &folder.file("a.mcap"), limit(16_000_000, compress), 200);
        let files = files(&folder);
        let total: u64 = files.iter().map(|(_, size)| size).sum();
        assert!(total <= 16_000_000 && total > 10_000_000, "{total} {files:?}");
        assert!(!files.iter().any(|(name, _)| name == "a.0001.mcap"), "{files:?}");
        assert_eq!(finished.files.iter().map(|path| path.exists()).collect::<Vec<_>>(), vec![true; files.len()]);
        // All that is left is repeated, and equal where it does not depend on what was before.
        let report = repeat(Busy::new(), &finished.path);
        assert!(report.is_same() && report.is_whole() && report.file > 1, "{report}");
        assert!(report.compared[0].equal > 100, "{report}");
        let [.., last] = finished.files.as_slice() else { panic!("there are files") };
        let report = repeat(Busy::new(), last);
        // Where it begins depends on the thread that writes: a moment before the end at the latest.
        assert!(report.is_same() && report.is_whole() && report.compared[0].equal > 0, "{report}");
        assert!(report.to_string().starts_with("the recording begins with file "), "{report}");
        // A file alone does not end as the run did.
        let folder = Folder::new();
        fs::copy(&finished.path, folder.file("alone.mcap")).expect("room");
        let report = repeat(Busy::new(), &folder.file("alone.mcap"));
        assert!(report.is_same() && !report.is_whole(), "{report}");
        assert!(report.to_string().contains("it goes on in `"), "{report}");
    }
}

#[test]
fn what_is_too_old_is_removed() {
    let folder = Folder::new();
    let options = RecordOptions { age: Some(Duration::from_secs(80)), ..RecordOptions::default() };
    let finished = recorded(Smooth::new(), &folder.file("a.mcap"), options, 1000);
    let report = repeat(Smooth::new(), &finished.path);
    assert!(report.is_whole() && report.file > 50, "{report}");
    let seconds = report.reactions / 100;
    assert!((80..=110).contains(&seconds), "{seconds} s are left");
    // The mean of a later file is not the same: it depends on all that was before.
    assert!(!report.is_same(), "{report}");
}

#[test]
fn a_test_is_fed_from_the_beginning_of_a_later_file() {
    let folder = Folder::new();
    let finished = recorded(Busy::new(), &folder.file("a.mcap"), limit(16_000_000, true), 200);
    let codec = || -> Option<Codec<f64>> {
        use apex_rt::record::{ByMessage as _, Kind};
        (&&Kind::<f64>::NEW).codec()
    };
    assert_eq!(f64::NAME, "std_msgs/msg/Float64");
    let tokens = tokens::<f64>("", finished.path.to_str().expect("a name"), "n.out", codec()).begun_at(Time::ZERO);
    assert_eq!(tokens[0].0, Duration::ZERO);
    assert!(tokens[0].1 > 1000.0, "{} ms", tokens[0].1);
}

#[test]
fn nothing_is_overwritten() {
    let folder = Folder::new();
    let path = |name: &str| folder.file(name);
    let first = recorded(Smooth::new(), &path("a.mcap"), limit(16_000_000, false), 1);
    fs::rename(first.path, path("a.0007.mcap")).expect("it is there");
    let second = recorded(Smooth::new(), &path("a.mcap"), limit(16_000_000, false), 1);
    assert_eq!(second.path, path("a-2.0001.mcap"));
    let error = Recorder::to_file_with::<Smooth>(&path("b.mcap"), WhenFull::Wait, limit(1_000_000, false));
    let error = error.err().expect("too small").to_string();
    assert_eq!(error, "a limit of 1000000 bytes is too small: give it at least 16MB");
}

#[test]
fn a_compressed_recording_is_the_same_run_in_less_space() {
    let folder = Folder::new();
    let plain = recorded(Busy::new(), &folder.file("plain.mcap"), RecordOptions::default(), 10);
    let options = RecordOptions { compress: true, ..RecordOptions::default() };
    let small = recorded(Busy::new(), &folder.file("small.mcap"), options, 10);
    let size = |path: &Path| fs::metadata(path).expect("it is there").len();
    assert!(size(&small.path) * 3 < size(&plain.path) * 2, "{} {}", size(&small.path), size(&plain.path));
    let report = replay(Busy::new(), &small.path, ()).expect("a recording");
    assert!(report.is_same() && report.is_whole() && report.reactions == 10_000, "{report}");
}

graph! {
    use apex_tests::nodes::{Mean, noise, pose, same, swallow, twist};

    /// A small robot: a pose, a measured and a commanded twist, a number, and what is made of it.
    robot Kilohertz {
        node odometry = pose() every 1ms;
        node measured = twist() every 1ms;
        node level    = noise() every 1ms;
        node filtered = Mean();
        node command  = same();
        odometry -> swallow();
        measured -> command -> swallow();
        level    -> filtered -> swallow();
        record "kilohertz.mcap" { command; filtered.out; }
    }
}

/// Processor time of this thread, in ns.
fn spent() -> f64 {
    let text = fs::read_to_string("/proc/thread-self/schedstat").expect("Linux");
    text.split(' ').next().and_then(|word| word.parse().ok()).expect("a number")
}

#[test]
#[ignore = "measures: cargo test --release -p apex-tests --test record -- --ignored --nocapture figures"]
fn figures_of_an_hour_at_1_khz() {
    const SECONDS: i64 = 600;
    let none = {
        let begin = spent();
        drive_with(Kilohertz::new(), SimClock::until(Time::from_secs(SECONDS)), ());
        spent() - begin
    };
    for compress in [false, true] {
        let folder = Folder::new();
        let options = RecordOptions { compress, ..RecordOptions::default() };
        let recorder = Recorder::to_file_with::<Kilohertz>(&folder.file("a.mcap"), WhenFull::Wait, options);
        let mut tap = Tap::Record(recorder.expect("a new file"));
        let begin = spent();
        drive_with(Kilohertz::new(), SimClock::until(Time::from_secs(SECONDS)), &mut tap);
        let control = spent() - begin - none;
        let Tap::Record(recorder) = tap else { unreachable!("it records") };
        let size = fs::metadata(recorder.finish().expect("room").path).expect("it is there").len() as f64;
        let (hours, reactions) = (SECONDS as f64 / 3600.0, SECONDS as f64 * 1e3);
        let (per_hour, per_reaction) = (size / hours / 1e9, control / reactions);
        println!(
            "compressed: {compress}: {per_hour:.2} GB per hour, {per_reaction:.0} ns per reaction in the control thread"
        );
    }
}
