//! MCAP files of other programs, whose messages tests feed.

use crate::{Folder, cut::Small};
use apex_rt::{
    Time,
    record::{replay, tokens},
};
use mcap::{WriteOptions, records::MessageHeader};
use std::{collections::BTreeMap, fs, panic, path::Path, time::Duration};

/// Time of the first message: since 1970, as ROS 2 has it, in ns.
const BEGIN: u64 = 1_700_000_000_000_000_000;

/// Writes a file with two numbers, 0.5 s apart.
fn file(path: &Path, options: WriteOptions, definition: &str, encoding: &str, prefix: [u8; 4]) {
    let mut writer = options.create(fs::File::create(path).expect("a new file")).expect("a file");
    let schema = writer.add_schema("std_msgs/msg/Float64", "ros2msg", definition.as_bytes()).expect("room");
    let channel_id = writer.add_channel(schema, "/warmth", encoding, &BTreeMap::new()).expect("room");
    for (i, number) in [1.5_f64, 2.5].into_iter().enumerate() {
        let time = BEGIN + i as u64 * 500_000_000;
        let header = MessageHeader { channel_id, sequence: i as u32, log_time: time, publish_time: time };
        writer.write_to_known_channel(&header, &[&prefix[..], &number.to_le_bytes()].concat()).expect("room");
    }
    writer.finish().expect("room");
}

fn plain() -> WriteOptions {
    WriteOptions::new().compression(None)
}

const CDR: [u8; 4] = [0, 1, 0, 0];

/// The tokens of a file, or the message of the error.
fn read(path: &Path, channel: &str) -> Result<Vec<(Duration, f64)>, String> {
    let (file, codec) = (path.to_str().expect("text"), apex_rt::__codec!(f64));
    let read = panic::catch_unwind(|| tokens("", file, channel, codec).begun_at(Time::ZERO).to_vec());
    read.map_err(|error| error.downcast::<String>().map_or_else(|_| "?".to_owned(), |text| *text))
}

fn expected() -> Vec<(Duration, f64)> {
    vec![(Duration::ZERO, 1.5), (Duration::from_millis(500), 2.5)]
}

#[test]
fn their_messages_come_from_the_first_one_on() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    file(&path, plain(), "# degrees\nfloat64   data\nfloat64 ZERO=0.0", "cdr", CDR);
    assert_eq!(read(&path, "/warmth"), Ok(expected()));
    let error = read(&path, "/cold").expect_err("there is no such channel");
    assert!(error.ends_with("it has `/warmth`"), "{error}");
}

#[test]
fn a_file_without_summary_or_definitions_is_not_damaged() {
    let folder = Folder::new();
    let (bare, silent) = (folder.file("bare.mcap"), folder.file("silent.mcap"));
    file(&bare, plain().emit_summary_records(false).emit_statistics(false), "float64 data", "cdr", CDR);
    assert_eq!(read(&bare, "/warmth"), Ok(expected()));
    file(&silent, plain(), "", "cdr", CDR);
    assert_eq!(read(&silent, "/warmth"), Ok(expected()));
}

#[test]
fn what_cannot_be_read_is_said() {
    let folder = Folder::new();
    for (definition, encoding, prefix, message) in [
        ("float32 data", "cdr", CDR, "recorded: float32 data\n    now:      float64 data"),
        ("float64 data", "json", CDR, "recorded: encoding json\n    now:      encoding cdr"),
        (
            "float64 data",
            "cdr",
            [0, 7, 0, 0],
            "is not one of `std_msgs/msg/Float64`: it is encoded in a version of CDR",
        ),
        ("float64 data", "cdr", [0x28, 0xb5, 0x2f, 0xfd], "it is compressed with zstd, and cannot be decompressed"),
    ] {
        let path = folder.file("other.mcap");
        file(&path, plain(), definition, encoding, prefix);
        let error = read(&path, "/warmth").expect_err(message);
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn a_compression_that_is_not_known_is_named() {
    let folder = Folder::new();
    let path = folder.file("packed.mcap");
    file(&path, plain(), "float64 data", "cdr", CDR);
    let mut bytes = fs::read(&path).expect("it was written");
    // The name of the compression follows the checksum of the chunk; there is none, so that there is room for one.
    let chunk = bytes.windows(9).position(|part| part[0] == 6 && part[3..9] == [0; 6]).expect("a chunk");
    let name = chunk + 9 + 28;
    assert_eq!(bytes[name..name + 4], [0; 4]);
    bytes.splice(name..name + 4, *b"\x04\0\0\0gzip");
    let length = u64::from_le_bytes(bytes[chunk + 1..chunk + 9].try_into().expect("eight bytes")) + 4;
    bytes[chunk + 1..chunk + 9].copy_from_slice(&length.to_le_bytes());
    fs::write(&path, bytes).expect("room");
    let error = read(&path, "/warmth").expect_err("it is compressed");
    assert!(error.contains("is incomplete: it is compressed with `gzip`"), "{error}");
}

#[test]
fn a_file_that_was_cut_off_is_read_up_to_there() {
    let folder = Folder::new();
    let (whole, cut) = (folder.file("whole.mcap"), folder.file("cut.mcap"));
    file(&whole, plain(), "float64 data", "cdr", CDR);
    let bytes = fs::read(&whole).expect("it was written");
    // The summary is missing, and then the whole end.
    for length in [bytes.len() - 1, bytes.len() / 2] {
        fs::write(&cut, &bytes[..length]).expect("room");
        assert_eq!(read(&cut, "/warmth"), Ok(expected()), "{length} of {} bytes", bytes.len());
    }
    let mut damaged = bytes;
    let number = damaged.windows(8).position(|part| part == 2.5_f64.to_le_bytes()).expect("a number");
    damaged[number - 40] ^= 1;
    fs::write(&cut, &damaged).expect("room");
    assert!(read(&cut, "/warmth").is_err_and(|error| error.contains("is incomplete: it is damaged")));
}

#[test]
fn numbers_are_read_from_messages_of_smaller_ones() {
    let folder = Folder::new();
    let path = folder.file("small.mcap");
    let mut writer = plain().create(fs::File::create(&path).expect("a new file")).expect("a file");
    for (topic, ty, definition) in [
        ("/small", "std_msgs/msg/Float32", "float32 data"),
        ("/changed", "std_msgs/msg/Float32", "int32 data"),
        ("/text", "std_msgs/msg/String", "string data"),
    ] {
        let schema = writer.add_schema(ty, "ros2msg", definition.as_bytes()).expect("room");
        let channel_id = writer.add_channel(schema, topic, "cdr", &BTreeMap::new()).expect("room");
        let header = MessageHeader { channel_id, sequence: 0, log_time: BEGIN, publish_time: BEGIN };
        writer.write_to_known_channel(&header, &[&CDR[..], &0.1_f32.to_le_bytes()].concat()).expect("room");
    }
    writer.finish().expect("room");
    assert_eq!(read(&path, "/small"), Ok(vec![(Duration::ZERO, f64::from(0.1_f32))]));
    let error = read(&path, "/changed").expect_err("another message");
    assert!(error.ends_with("recorded: int32 data\n    known:    float32 data"), "{error}");
    let error = read(&path, "/text").expect_err("a text");
    assert!(error.contains("is of type `std_msgs/msg/String`; the port reads `std_msgs/msg/Float64`, `"), "{error}");
}

#[test]
fn recordings_of_others_are_not_replayed_and_it_is_said_what_can_be_done_with_them() {
    let folder = Folder::new();
    let (mcap, bag) = (folder.file("other.mcap"), folder.file("other.bag"));
    file(&mcap, plain(), "float64 data", "cdr", CDR);
    fs::write(&bag, "#ROSBAG V2.0\n").expect("room");
    for path in [mcap, bag] {
        let error = replay(Small::new(), &path, ()).map(|_| ()).expect_err("it is another program's").to_string();
        let [what, feed, list] = error.lines().collect::<Vec<_>>()[..] else { panic!("{error}") };
        assert!(what.ends_with("is a recording, but not of a program of Apex: it has no reactions"), "{error}");
        assert!(feed.contains("feed its topics to a test instead") && list.contains("`apex bag FILE`"), "{error}");
    }
}
