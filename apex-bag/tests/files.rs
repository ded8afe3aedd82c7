//! MCAP files as other programs write them: compressed chunks, no index, no statistics, cut off. And their contents.

use apex_bag::{CUT, Contents, Message, Recording};
use mcap::{WriteOptions, records::MessageHeader};
use ruzstd::encoding::{CompressionLevel, compress_to_vec};
use std::{
    collections::BTreeMap,
    fs,
    io::{self, Write as _},
    path::PathBuf,
    process::Command,
    time::Duration,
};

/// Time of the first message: since 1970, as ROS 2 has it, in ns.
const BEGIN: u64 = 1_700_000_000_000_000_000;
/// Number of bytes of a record before its body, and of a chunk before its checksum.
const HEAD: usize = 9;
const TIMES_AND_SIZE: usize = 24;

/// File in the temporary folder, which is removed at the end.
struct Temporary(PathBuf);

impl Temporary {
    fn new(name: &str, bytes: &[u8]) -> Self {
        let path = std::env::temp_dir().join(format!("apex-mcap-{}-{name}", std::process::id()));
        fs::write(&path, bytes).expect("room");
        Self(path)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

/// File with `count` messages of a scanner, every 100 ms with a pause of a second in the middle, and one of another
/// topic.
fn file(count: u32, options: WriteOptions) -> Vec<u8> {
    let mut writer = options.compression(None).create(io::Cursor::new(vec![])).expect("a file");
    let schema = writer.add_schema("std_msgs/msg/Float64", "ros2msg", b"float64 data").expect("room");
    let none = BTreeMap::new();
    let [scan, other] = ["/scan", "/other"].map(|topic| writer.add_channel(schema, topic, "cdr", &none).expect("room"));
    let mut write = |channel_id, sequence: u32, time: u64| {
        let header = MessageHeader { channel_id, sequence, log_time: time, publish_time: time };
        writer.write_to_known_channel(&header, &[7; 12]).expect("room");
    };
    for i in 0..count {
        let pause = if i < count / 2 { 0 } else { 900_000_000 };
        write(scan, i, BEGIN + u64::from(i) * 100_000_000 + pause);
    }
    write(other, 0, BEGIN + 1);
    writer.finish().expect("room");
    writer.into_inner().into_inner()
}

/// The same file with its chunk compressed, and without checksums and everything behind the chunk.
fn packed(plain: &[u8], name: &str, pack: impl Fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let chunk = (8..plain.len()).find(|at| plain[*at] == 6 && plain[at + 1 + 8 + 28..].starts_with(&[0; 4]));
    let chunk = chunk.expect("a chunk");
    let length = u64::from_le_bytes(plain[chunk + 1..chunk + HEAD].try_into().expect("eight bytes")) as usize;
    let body = &plain[chunk + HEAD..chunk + HEAD + length];
    let records = pack(&body[TIMES_AND_SIZE + 4 + 4 + 8..]);
    let body = [
        &body[..TIMES_AND_SIZE],
        &[0; 4],
        &(name.len() as u32).to_le_bytes(),
        name.as_bytes(),
        &(records.len() as u64).to_le_bytes(),
        &records,
    ]
    .concat();
    [&plain[..chunk], &[6], &(body.len() as u64).to_le_bytes(), &body].concat()
}

fn zstd(bytes: &[u8]) -> Vec<u8> {
    compress_to_vec(bytes, CompressionLevel::Fastest)
}

fn lz4(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = lz4_flex::frame::FrameEncoder::new(vec![]);
    encoder.write_all(bytes).expect("room");
    encoder.finish().expect("room")
}

/// Messages of a file, and the reason for their end.
fn read(name: &str, bytes: &[u8]) -> (Vec<Message>, Option<String>) {
    let file = Temporary::new(name, bytes);
    let mut recording = Recording::open(&file.0).expect("a recording");
    let mut messages = vec![];
    while let Some(message) = recording.next_message().expect("a readable file") {
        messages.push(message);
    }
    (messages, recording.cut().map(str::to_owned))
}

#[test]
fn compressed_chunks_have_the_same_messages() {
    let plain = file(500, WriteOptions::new());
    let (messages, cut) = read("plain.mcap", &plain);
    assert_eq!((messages.len(), cut), (501, None));
    for (name, bytes) in [("zstd", packed(&plain, "zstd", zstd)), ("lz4", packed(&plain, "lz4", lz4))] {
        // A recorder that loses its power writes nothing behind the last chunk.
        assert_eq!(read(name, &bytes), (messages.clone(), Some(CUT.to_owned())), "{name}");
        for length in (100..bytes.len()).step_by(7) {
            let (part, cut) = read(name, &bytes[..length]);
            assert!(messages.starts_with(&part) && cut.as_deref() == Some(CUT), "{name} {length}: {cut:?}");
        }
    }
    let damaged = packed(&plain, "zstd", |bytes| zstd(&bytes[1..]));
    assert!(read("bad", &damaged).1.is_some_and(|why| why == "it is damaged: a chunk cannot be decompressed"));
}

#[test]
fn a_file_without_index_and_statistics_is_whole() {
    let bare = WriteOptions::new().emit_statistics(false).emit_summary_records(false).use_chunks(false);
    let (messages, cut) = read("bare.mcap", &file(10, bare));
    assert_eq!((messages.len(), cut), (11, None));
}

#[test]
fn contents_are_counted() {
    let file = Temporary::new("contents.mcap", &file(10, WriteOptions::new()));
    let contents = Contents::read(&file.0).expect("a recording");
    assert_eq!((contents.program, contents.cut), (None, None));
    assert_eq!(contents.times, Some((BEGIN, BEGIN + 1_800_000_000)));
    let [other, scan] = contents.topics.as_slice() else { panic!("two topics") };
    assert_eq!((other.count, other.gap, other.period, other.rate()), (1, None, None, None));
    assert_eq!((&*scan.channel.topic, scan.count, scan.bytes), ("/scan", 10, 120));
    assert_eq!(scan.gap, Some((Duration::from_secs(1), BEGIN + 400_000_000)));
    assert_eq!((scan.period, scan.rate()), (Some(Duration::from_millis(100)), Some(5.0)));
}

#[test]
fn a_topic_that_ends_before_the_others_or_begins_after_them_has_a_gap() {
    let mut writer = WriteOptions::new().create(io::Cursor::new(vec![])).expect("room");
    for (topic, seconds) in [("/a", 0..30), ("/b", 0..10), ("/c", 25..30)] {
        let channel_id = writer.add_channel(0, topic, "cdr", &BTreeMap::new()).expect("room");
        for second in seconds {
            let time = BEGIN + second * 1_000_000_000;
            let header = MessageHeader { channel_id, sequence: 0, log_time: time, publish_time: time };
            writer.write_to_known_channel(&header, &[0; 8]).expect("room");
        }
    }
    writer.finish().expect("room");
    let file = Temporary::new("ends.mcap", &writer.into_inner().into_inner());
    let gaps = Contents::read(&file.0).expect("a recording").topics.into_iter().map(|topic| topic.gap.expect("a gap"));
    let gaps: Vec<_> = gaps.map(|(gap, at)| (gap.as_secs(), (at - BEGIN) / 1_000_000_000)).collect();
    assert_eq!(gaps, [(1, 0), (20, 9), (25, 0)]);
}

#[test]
fn what_is_not_a_recording_is_named() {
    let database = if cfg!(feature = "sqlite") { "not a database of rosbag2" } else { "the feature `sqlite`" };
    for (bytes, why) in [
        (&b"SQLite format 3\0"[..], database),
        (&[0x28, 0xb5, 0x2f, 0xfd, 0], "`zstd -d`"),
        (&[0x1f, 0x8b, 8, 0], "`gunzip`"),
        (b"#ROSBAG V1.2\n", "rosbag fix"),
        (b"time,x\n", "not an MCAP file"),
    ] {
        let file = Temporary::new("other", bytes);
        let error = Recording::open(&file.0).map(|_| ()).expect_err(why);
        assert!(error.to_string().contains(why), "{error}");
    }
}

/// Bag of rosbag2 with these files.
fn bag(name: &str, files: &[(&str, &[u8])]) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("apex-bag-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("room");
    let mut metadata = "rosbag2_bagfile_information:\n  relative_file_paths:\n".to_owned();
    for (name, bytes) in files {
        fs::write(folder.join(name), bytes).expect("room");
        metadata.push_str(&format!("    - {name}\n"));
    }
    fs::write(folder.join("metadata.yaml"), metadata).expect("room");
    folder
}

#[test]
fn a_folder_is_read_file_by_file() {
    let whole = file(10, WriteOptions::new());
    let none = BTreeMap::new();
    // The other file numbers its channels in another order, and has one more.
    let mut writer = WriteOptions::new().compression(None).create(io::Cursor::new(vec![])).expect("a file");
    let schema = writer.add_schema("std_msgs/msg/Float64", "ros2msg", b"float64 data").expect("room");
    for (i, topic) in (0..).zip(["/new", "/other", "/scan"]) {
        let channel_id = writer.add_channel(schema, topic, "cdr", &none).expect("room");
        let time = BEGIN + 10_000_000_000 + i;
        let header = MessageHeader { channel_id, sequence: 0, log_time: time, publish_time: time };
        writer.write_to_known_channel(&header, &[7; 12]).expect("room");
    }
    writer.finish().expect("room");
    let later = writer.into_inner().into_inner();

    let folder = bag("split", &[("b.mcap", &whole), ("a.mcap", &later)]);
    let contents = Contents::read(&folder).expect("a bag");
    let counts: Vec<_> = contents.topics.iter().map(|topic| (&*topic.channel.topic, topic.count)).collect();
    assert_eq!((counts, contents.cut), (vec![("/new", 1), ("/other", 2), ("/scan", 11)], None));
    assert_eq!(contents.times, Some((BEGIN, BEGIN + 10_000_000_002)));

    // A file that is cut off ends the bag.
    let folder = bag("cut", &[("b.mcap", &whole[..whole.len() / 2]), ("a.mcap", &later)]);
    let contents = Contents::read(&folder).expect("a bag");
    assert_eq!(contents.cut.as_deref(), Some(CUT));
    // One file is that file.
    let folder = bag("one", &[("b.mcap", &whole)]);
    assert!(matches!(Recording::open(&folder), Ok(Recording::Mcap(_))));

    let why = |folder: &PathBuf| Recording::open(folder).map(|_| ()).map_err(|error| error.to_string());
    fs::remove_file(folder.join("b.mcap")).expect("it is there");
    assert!(why(&folder).is_err_and(|why| why.starts_with("its file `b.mcap`: ")));
    assert!(why(&bag("none", &[])).is_err_and(|why| why == "its `metadata.yaml` names no file"));
    fs::remove_file(folder.join("metadata.yaml")).expect("it is there");
    assert!(why(&folder).is_err_and(|why| why.starts_with("it is a folder without `metadata.yaml`: name one")));
    for name in ["split", "cut", "one", "none"] {
        drop(fs::remove_dir_all(bag(name, &[])));
    }
}

#[test]
fn without_the_feature_sqlite_is_not_built() {
    // Not offline: crates of a feature that is off may not have been downloaded.
    for (package, features, has) in
        [("apex-cli", "", false), ("apex-nodes", "record", false), ("apex-bag", "sqlite", true)]
    {
        let tree = Command::new(env!("CARGO"))
            .args([
                "tree",
                "--package",
                package,
                "--features",
                features,
                "--edges",
                "normal",
                "--prefix",
                "none",
                "--locked",
            ])
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .expect("cargo runs");
        let problem = String::from_utf8_lossy(&tree.stderr).into_owned();
        let tree = String::from_utf8_lossy(&tree.stdout).into_owned();
        assert!(tree.contains("ruzstd"), "{package}: {tree}{problem}");
        assert_eq!(tree.contains("sqlite"), has, "{package}");
    }
}
