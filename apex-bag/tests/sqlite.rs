//! Databases of rosbag2, as its recorder writes them.

use apex_bag::{Contents, Message, Recording};
use rusqlite::{Connection, params};
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::{self, Command},
};

/// Time of the first message: since 1970, as ROS 2 has it, in ns.
const BEGIN: i64 = 1_700_000_000_000_000_000;
/// Tables since Iron (schema 4), and before.
const NEW: &str = "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
    CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL,
        encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL);
    CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
        serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT NULL);
    INSERT INTO schema VALUES(4, 'jazzy');
    INSERT INTO message_definitions VALUES(1, 'std_msgs/msg/Float64', 'ros2msg', 'float64 data', 'RIHS01_00');
    INSERT INTO topics VALUES(7, '/scan', 'std_msgs/msg/Float64', 'cdr', '', 'RIHS01_00');
    INSERT INTO topics VALUES(3, '/other', 'own_msgs/msg/Own', 'cdr', '', '');";
const OLD: &str = "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
        serialization_format TEXT NOT NULL);
    INSERT INTO topics VALUES(7, '/scan', 'std_msgs/msg/Float64', 'cdr');
    INSERT INTO topics VALUES(3, '/other', 'own_msgs/msg/Own', 'cdr');";
const MESSAGES: &str = "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
        timestamp INTEGER NOT NULL, data BLOB NOT NULL);
    CREATE INDEX timestamp_idx ON messages (timestamp ASC);";

/// Database in the temporary folder, which is removed at the end.
struct Temporary(PathBuf);

impl Temporary {
    /// A database with these tables and these messages: topic, time after the beginning in ms, and data.
    fn new(name: &str, tables: &str, messages: &[(i64, i64, Vec<u8>)]) -> Self {
        let path = env::temp_dir().join(format!("apex-sqlite-{}-{name}.db3", process::id()));
        let _ = fs::remove_file(&path);
        let database = Connection::open(&path).expect("room");
        database.execute_batch(tables).expect("tables");
        for (topic, ms, data) in messages {
            let insert = "INSERT INTO messages(topic_id, timestamp, data) VALUES(?1, ?2, ?3)";
            database.execute(insert, params![topic, BEGIN + ms * 1_000_000, data]).expect("room");
        }
        Self(path)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

/// Messages of a file, and the reason for their end.
fn read(path: &Path) -> (Vec<Message>, Option<String>) {
    let mut recording = Recording::open(path).expect("a recording");
    let mut messages = vec![];
    while let Some(message) = recording.next_message().expect("a readable file") {
        messages.push(message);
    }
    (messages, recording.cut().map(str::to_owned))
}

/// Messages of 10,000 bytes, which fill pages of their own.
fn many(count: i64) -> Vec<(i64, i64, Vec<u8>)> {
    (0..count).map(|i| (if i % 3 == 0 { 3 } else { 7 }, i * 10, vec![i as u8; 10_000])).collect()
}

#[test]
fn messages_come_in_the_order_of_their_times() {
    for (name, tables) in [("new", NEW), ("old", OLD)] {
        let messages = [(7, 20, vec![2; 12]), (3, 10, vec![1; 4]), (7, 30, vec![]), (7, 0, vec![0; 12])];
        let file = Temporary::new(name, &format!("{tables}{MESSAGES}"), &messages);
        let (found, cut) = read(&file.0);
        let found: Vec<_> = found.iter().map(|it| (it.time as i64 - BEGIN, it.channel, it.data.as_slice())).collect();
        let ms = 1_000_000;
        let [zero, one, two]: [&[u8]; 3] = [&[0; 12], &[1; 4], &[2; 12]];
        assert_eq!(found, [(0, 1, zero), (10 * ms, 0, one), (20 * ms, 1, two), (30 * ms, 1, &[][..])], "{name}");
        assert_eq!(cut, None);
        let contents = Contents::read(&file.0).expect("a recording");
        let topics: Vec<_> = contents.topics.iter().map(|it| (&*it.channel.topic, it.count, it.bytes)).collect();
        assert_eq!(topics, [("/other", 1, 4), ("/scan", 3, 24)]);
        let scan = &contents.topics[1].channel;
        assert_eq!((&*scan.schema, &*scan.encoding), ("std_msgs/msg/Float64", "cdr"));
        assert_eq!(scan.shape.as_deref(), (name == "new").then_some("float64 data"));
        assert_eq!(contents.topics[0].channel.shape, None);
    }
}

#[test]
fn a_database_that_was_cut_off_is_read_up_to_there() {
    let file = Temporary::new("cut", &format!("{NEW}{MESSAGES}"), &many(60));
    let (all, bytes) = (read(&file.0).0, fs::read(&file.0).expect("it is there"));
    assert_eq!(all.len(), 60);
    let mut counts = vec![];
    for length in (40_000..bytes.len()).step_by(20_000) {
        fs::write(&file.0, &bytes[..length]).expect("room");
        let (part, cut) = read(&file.0);
        assert!(all.starts_with(&part), "{length}");
        assert!(cut.is_some_and(|cut| cut.starts_with("it is damaged: ")), "{length}");
        counts.push(part.len());
    }
    assert!(counts.is_sorted() && counts.last() > Some(&50), "{counts:?}");
}

#[test]
fn damage_is_no_panic() {
    let file = Temporary::new("damage", &format!("{NEW}{MESSAGES}"), &many(12));
    let bytes = fs::read(&file.0).expect("it is there");
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let mut refused = 0;
    for _ in 0..1000 {
        let mut bytes = bytes.clone();
        for _ in 0..=random(8) {
            // Half of them in the first pages, which say how the others are read.
            let place = if random(2) == 0 { bytes.len() } else { 8192 };
            let at = 16 + random(place - 16);
            bytes[at] = random(256) as u8;
        }
        fs::write(&file.0, &bytes).expect("room");
        let Ok(mut recording) = Recording::open(&file.0) else {
            refused += 1;
            continue;
        };
        let most = 2 * bytes.len();
        let mut read = 0;
        while let Some(message) = recording.next_message().expect("it is there") {
            read += message.data.len();
            assert!(read <= most, "more than the file has");
        }
    }
    assert!((1..950).contains(&refused), "{refused}");
}

#[test]
fn what_is_wrong_is_named() {
    let refusal = |tables: &str| {
        let file = Temporary::new("wrong", tables, &[]);
        Recording::open(&file.0).map(|_| ()).expect_err("it is none").to_string()
    };
    let other = refusal("CREATE TABLE songs(id INTEGER)");
    assert!(other.starts_with("it is not a database of rosbag2") && other.contains("no such table: topics"), "{other}");
    let cut = |name: &str, message: (i64, i64, Vec<u8>)| {
        let file = Temporary::new(name, &format!("{NEW}{MESSAGES}"), &[(7, 0, vec![1; 4]), message]);
        let (messages, cut) = read(&file.0);
        (messages.len(), cut.unwrap_or_default())
    };
    let (count, why) = cut("topic", (9, 1, vec![]));
    assert_eq!((count, &*why), (1, "it is damaged: message 2 belongs to topic 9, which is not in the table `topics`"));
    let (count, why) = cut("time", (7, -2 * BEGIN / 1_000_000, vec![]));
    assert_eq!((count, &*why), (1, "it is damaged: message 2 has the time -1700000000000000000 ns"));
}

#[test]
fn messages_beside_the_database_are_not_left_out() {
    let file = Temporary::new("journal", &format!("{NEW}{MESSAGES}"), &[(7, 0, vec![1; 4])]);
    let recorder = Connection::open(&file.0).expect("it is there");
    recorder.execute_batch("PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0").expect("a journal");
    recorder.execute("INSERT INTO messages VALUES(2, 7, ?1, x'0102')", [BEGIN + 1]).expect("room");
    assert_eq!(read(&file.0).0.len(), 2, "one of them is in the journal alone");
}

/// The same messages in an MCAP file and in databases of two versions of the recorder.
const WRITE: &str = "import sys
from pathlib import Path
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore
store = get_typestore(Stores.ROS2_HUMBLE)
types = ['std_msgs/msg/String', 'std_msgs/msg/Float64']
for name, version, plugin, mode in [
        ('mcap', 9, StoragePlugin.MCAP, None), ('new', 9, StoragePlugin.SQLITE3, None),
        ('old', 8, StoragePlugin.SQLITE3, None), ('packed', 9, StoragePlugin.SQLITE3, CompressionMode.MESSAGE)]:
    writer = Writer(Path(sys.argv[1]) / name, version=version, storage_plugin=plugin)
    if mode:
        writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        connections = [writer.add_connection('/' + ty[-4:], ty, typestore=store) for ty in types]
        for k in range(300):
            ty = types[k % 2]
            message = store.types[ty]('x' * k if k % 2 == 0 else float(k))
            data = store.serialize_cdr(message, ty)
            writer.write(connections[k % 2], 1700000000_000000000 + k * 1_000_000, data)
";

/// Topic, time and bytes of each message in a file.
fn sent(path: &Path) -> Vec<(String, u64, Vec<u8>)> {
    let (messages, cut) = read(path);
    assert_eq!(cut, None, "{}", path.display());
    let channels = Recording::open(path).map(|recording| recording.channels().clone()).expect("a recording");
    let topic = |number: u16| channels.get(&number).map_or_else(|| number.to_string(), |it| it.topic.clone());
    let plain = |data: &[u8]| apex_bag::message(data).expect("plain or packed").into_owned();
    messages.iter().map(|it| (topic(it.channel), it.time, plain(&it.data))).collect()
}

#[test]
fn databases_of_python_have_the_same_messages_as_its_files() {
    let environment = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("python").join("bin/python3");
    let has = |python: &PathBuf| {
        let import = Command::new(python).args(["-c", "import rosbags"]).output();
        import.is_ok_and(|output| output.status.success())
    };
    let Some(python) = [environment, "python3".into()].into_iter().find(has) else {
        assert!(env::var_os("CI").is_none(), "no Python has `rosbags`");
        return println!("skipped: no Python has `rosbags`");
    };
    let folder = env::temp_dir().join(format!("apex-sqlite-{}", process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("room");
    let written = Command::new(python).args(["-c", WRITE]).arg(&folder).output().expect("python runs");
    assert!(written.status.success(), "{}", String::from_utf8_lossy(&written.stderr));
    let mut recording = Recording::open(&folder.join("mcap/mcap.mcap")).expect("a recording");
    let mut expected = vec![];
    while let Some(message) = recording.next_message().expect("a readable file") {
        expected.push((recording.channels()[&message.channel].topic.clone(), message.time, message.data));
    }
    assert_eq!(expected.len(), 300);
    for name in ["new", "old", "packed"] {
        assert!(sent(&folder.join(name).join(format!("{name}.db3"))) == expected, "{name}");
    }
    let _ = fs::remove_dir_all(&folder);
}
