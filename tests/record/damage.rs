//! Damaged files: each change is detected, wherever it is. A replay repeats the whole run, or it reports that the file
//! is incomplete and where it ended. It never reports a wrong run as correct.

use crate::{Folder, cut::Small};
use apex_rt::{
    drive_with,
    prelude::*,
    record::{RecordOptions, Recorder, Report, Tap, WhenFull, replay},
};
use std::{fs, ops::Range, path::PathBuf};

/// Kind of a chunk record.
const CHUNK: u8 = 6;
/// Number of bytes of a record before its body: kind and length.
const HEAD: usize = 9;
/// Number of bytes before the first record.
const MAGIC: usize = 8;

/// Length of the run in milliseconds, and number of its reactions.
const TIME: i64 = 12;

/// A recording, and a folder for damaged copies.
struct Files {
    folder: Folder,
    bytes: Vec<u8>,
}

impl Files {
    /// Recordings of the same run, plain and compressed.
    fn all() -> [Self; 2] {
        [false, true].map(Self::new)
    }

    fn new(compress: bool) -> Self {
        let folder = Folder::new();
        let options = RecordOptions { compress, ..RecordOptions::default() };
        let recorder = Recorder::to_file_with::<Small>(&folder.file("whole.mcap"), WhenFull::Wait, options);
        let mut tap = Tap::Record(recorder.expect("a new file"));
        drive_with(Small::new(), SimClock::until(Time::from_millis(TIME)), &mut tap);
        let Tap::Record(recorder) = tap else { unreachable!("it records") };
        recorder.finish().expect("room for the file");
        let bytes = fs::read(folder.file("whole.mcap")).expect("it was written");
        Self { folder, bytes }
    }

    fn other(&self) -> PathBuf {
        self.folder.file("other.mcap")
    }

    /// Report of a replay of other bytes, or `None` if they are rejected.
    fn replayed(&self, bytes: &[u8]) -> Option<Report> {
        fs::write(self.other(), bytes).expect("room for it");
        replay(Small::new(), &self.other(), ()).ok()
    }

    /// `true` if other bytes are accepted as the whole run.
    fn pass(&self, bytes: &[u8], what: &str) -> bool {
        let Some(report) = self.replayed(bytes) else { return false };
        assert!(report.reactions > 0, "{what}: nothing is no replay");
        assert!(report.reactions <= TIME as u64, "{what}: {report}");
        if report.is_whole() {
            assert!(report.is_same() && report.reactions == TIME as u64, "{what}: it misses something: {report}");
            assert_eq!(report.compared[0].equal, TIME as u64, "{what}: {report}");
            return true;
        }
        let text = report.to_string();
        assert!(text.contains("incomplete") || text.contains("missing"), "{what}: it says nothing of it: {text}");
        false
    }

    /// Positions of the records.
    fn records(&self) -> Vec<Range<usize>> {
        let mut records = vec![];
        let mut at = MAGIC;
        while let Some(length) = self.bytes.get(at + 1..at + HEAD) {
            let length = u64::from_le_bytes(length.try_into().expect("eight bytes")) as usize;
            records.push(at..at + HEAD + length);
            at += HEAD + length;
        }
        records
    }
}

#[test]
fn every_bit_counts() {
    for files in Files::all() {
        assert!(files.pass(&files.bytes, "the file as it is"));
        for at in 0..files.bytes.len() {
            // One bit of each byte, in turn one of its eight bits.
            let mut bytes = files.bytes.clone();
            bytes[at] ^= 1 << (at % 8);
            assert!(!files.pass(&bytes, &format!("bit {} of byte {at}", at % 8)), "byte {at} does not count");
        }
    }
}

#[test]
fn every_bit_of_the_kind_and_the_length_of_a_record_counts() {
    for files in Files::all() {
        for record in files.records() {
            for bit in 0..8 * HEAD {
                let mut bytes = files.bytes.clone();
                bytes[record.start + bit / 8] ^= 1 << (bit % 8);
                let what = format!("bit {bit} of the record at {}", record.start);
                assert!(!files.pass(&bytes, &what), "{what} does not count");
            }
        }
    }
}

#[test]
fn a_file_that_ends_anywhere_else_is_not_whole() {
    for files in Files::all() {
        for length in 0..files.bytes.len() {
            assert!(!files.pass(&files.bytes[..length], &format!("{length} bytes")), "{length} bytes are enough");
        }
        let mut longer = files.bytes.clone();
        longer.push(0);
        assert!(!files.pass(&longer, "a byte more"));
    }
}

#[test]
fn every_record_has_its_place() {
    for files in Files::all() {
        let records = files.records();
        let chunks = records.iter().filter(|r| files.bytes[r.start] == CHUNK).count();
        assert!(chunks >= 1, "{chunks} chunks");
        for (number, record) in records.iter().enumerate() {
            let without = [&files.bytes[..record.start], &files.bytes[record.end..]].concat();
            assert!(!files.pass(&without, &format!("without record {number}")), "nobody misses record {number}");
            let twice = [&files.bytes[..record.end], &files.bytes[record.start..]].concat();
            assert!(!files.pass(&twice, &format!("record {number} twice")), "record {number} may come twice");
            for other in &records[number + 1..] {
                let (a, b) = (&files.bytes[record.clone()], &files.bytes[other.clone()]);
                let between = &files.bytes[record.end..other.start];
                let swapped = [&files.bytes[..record.start], b, between, a, &files.bytes[other.end..]].concat();
                let what = format!("record {number} in place of the one at {}", other.start);
                assert!(a == b || !files.pass(&swapped, &what), "{what}: nobody minds");
            }
        }
    }
}

#[test]
fn what_is_said_of_a_file_of_which_nothing_is_left_names_the_reason() {
    for files in Files::all() {
        let first = files.records().into_iter().find(|r| files.bytes[r.start] == CHUNK).expect("there is a chunk");
        let mut bytes = files.bytes.clone();
        bytes[first.start] ^= 1;
        fs::write(files.other(), &bytes).expect("room for it");
        let error = replay(Small::new(), &files.other(), ()).expect_err("nothing is left").to_string();
        assert!(error.contains("damaged"), "{error}");
    }
}
