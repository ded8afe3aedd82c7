//! Types that have changed between recording and replay: the change is reported with its cause, never a wrong run as
//! correct.

use crate::{Folder, record, round::until};
use apex_macros::graph;
use apex_rt::{
    drive_with,
    prelude::*,
    record::{
        Codec, Message, Reason, Recorder, Report, WhenFull,
        cdr::{Reader, Writer},
        replay, tokens,
    },
};
use mcap::{MessageStream, WriteOptions, records::MessageHeader};
use serde::{Deserialize, Serialize};
use std::{
    borrow::Cow,
    collections::BTreeMap,
    fs, panic,
    path::{Path, PathBuf},
};

/// A measurement, in one of its versions.
pub trait Version: Clone {
    /// Returns what is measured at a time.
    fn at(time: f32) -> Self;
    /// Returns the speed of the left wheel.
    fn left(&self) -> f32;
}

/// A driver.
#[node]
pub fn measure<V: Version>(ctx: &Ctx) -> V {
    V::at(ctx.now().as_secs_f64() as f32)
}

/// The speed of the left wheel.
#[node]
pub fn left_of<V: Version>(measured: &V) -> f32 {
    measured.left()
}

/// Passes a measurement on.
#[node]
pub fn kept<V: Version>(measured: &V) -> V {
    measured.clone()
}

/// The type as it was.
pub mod first {
    use super::*;

    /// A measurement.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct Measured {
        pub left: f32,
        pub right: f32,
        pub charge: f32,
    }

    impl Version for Measured {
        fn at(time: f32) -> Self {
            Self { left: 1.0 + time, right: 2.0, charge: 0.9 }
        }
        fn left(&self) -> f32 {
            self.left
        }
    }

    graph! {
        use crate::types::{kept, left_of, measure, first::Measured};
        use apex_tests::nodes::swallow;

        robot Base {
            node measure = measure<Measured>() every 100ms;
            node kept    = kept();
            node left    = left_of();
            measure -> kept -> left -> swallow();
            record "run.mcap" { kept; left; }
        }
    }
}

/// The type in another module.
pub mod moved {
    use super::*;

    /// A measurement.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct Measured {
        pub left: f32,
        pub right: f32,
        pub charge: f32,
    }

    impl Version for Measured {
        fn at(time: f32) -> Self {
            Self { left: 1.0 + time, right: 2.0, charge: 0.9 }
        }
        fn left(&self) -> f32 {
            self.left
        }
    }

    graph! {
        use crate::types::{kept, left_of, measure, moved::Measured};
        use apex_tests::nodes::swallow;

        robot Base {
            node measure = measure<Measured>() every 100ms;
            node kept    = kept();
            node left    = left_of();
            measure -> kept -> left -> swallow();
            record "run.mcap" { kept; left; }
        }
    }
}

/// The type with its fields in another order.
pub mod swapped {
    use super::*;

    /// A measurement.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct Measured {
        pub right: f32,
        pub left: f32,
        pub charge: f32,
    }

    impl Version for Measured {
        fn at(time: f32) -> Self {
            Self { right: 2.0, left: 1.0 + time, charge: 0.9 }
        }
        fn left(&self) -> f32 {
            self.left
        }
    }

    graph! {
        use crate::types::{kept, left_of, measure, swapped::Measured};
        use apex_tests::nodes::swallow;

        robot Base {
            node measure = measure<Measured>() every 100ms;
            node kept    = kept();
            node left    = left_of();
            measure -> kept -> left -> swallow();
            record "run.mcap" { kept; left; }
        }
    }
}

/// The type with another number type.
pub mod narrower {
    use super::*;

    /// A measurement.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct Measured {
        pub left: f32,
        pub right: [u8; 4],
        pub charge: f32,
    }

    impl Version for Measured {
        fn at(time: f32) -> Self {
            Self { left: 1.0 + time, right: [0; 4], charge: 0.9 }
        }
        fn left(&self) -> f32 {
            self.left
        }
    }

    graph! {
        use crate::types::{kept, left_of, measure, narrower::Measured};
        use apex_tests::nodes::swallow;

        robot Base {
            node measure = measure<Measured>() every 100ms;
            node kept    = kept();
            node left    = left_of();
            measure -> kept -> left -> swallow();
            record "run.mcap" { kept; left; }
        }
    }
}

/// The type without its last field.
pub mod shorter {
    use super::*;

    /// A measurement.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct Measured {
        pub left: f32,
        pub right: f32,
    }

    impl Version for Measured {
        fn at(time: f32) -> Self {
            Self { left: 1.0 + time, right: 2.0 }
        }
        fn left(&self) -> f32 {
            self.left
        }
    }

    graph! {
        use crate::types::{kept, left_of, measure, shorter::Measured};
        use apex_tests::nodes::swallow;

        robot Base {
            node measure = measure<Measured>() every 100ms;
            node kept    = kept();
            node left    = left_of();
            measure -> kept -> left -> swallow();
            record "run.mcap" { kept; left; }
        }
    }
}

/// The type as it was, and a recorded port that has become another one.
pub mod rewired {
    use super::*;

    graph! {
        use crate::types::{left_of, measure, first::Measured};
        use apex_tests::nodes::swallow;

        robot Base {
            node measure = measure<Measured>() every 100ms;
            node kept    = left_of();
            node left    = left_of();
            measure -> [kept, left];
            kept    -> swallow();
            left    -> swallow();
            record "run.mcap" { kept; left; }
        }
    }
}

/// A message with the definition `float32 celsius  # degrees`.
pub mod celsius {
    use super::*;

    /// A temperature.
    #[derive(Debug, Clone)]
    pub struct Warmth(f32);

    impl Message for Warmth {
        const NAME: &'static str = "sensor_msgs/msg/Temperature";
        const DEFINITION: &'static str = "float32 celsius  # degrees";
        fn write(&self, message: &mut Writer<'_>) {
            message.f32(self.0);
        }
        fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
            message.f32().map(Self)
        }
    }

    impl Version for Warmth {
        fn at(time: f32) -> Self {
            Self(time)
        }
        fn left(&self) -> f32 {
            self.0
        }
    }

    graph! {
        use crate::types::{left_of, measure, celsius::Warmth};
        use apex_tests::nodes::swallow;

        robot Stove {
            node measure = measure<Warmth>() every 100ms;
            node left    = left_of();
            measure -> left -> swallow();
            record "stove.mcap" { left; }
        }
    }
}

/// A message with the definition `float32 celsius  # degrees Celsius`.
pub mod commented {
    use super::*;

    /// A temperature.
    #[derive(Debug, Clone)]
    pub struct Warmth(f32);

    impl Message for Warmth {
        const NAME: &'static str = "sensor_msgs/msg/Temperature";
        const DEFINITION: &'static str = "float32 celsius  # degrees Celsius";
        fn write(&self, message: &mut Writer<'_>) {
            message.f32(self.0);
        }
        fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
            message.f32().map(Self)
        }
    }

    impl Version for Warmth {
        fn at(time: f32) -> Self {
            Self(time)
        }
        fn left(&self) -> f32 {
            self.0
        }
    }

    graph! {
        use crate::types::{left_of, measure, commented::Warmth};
        use apex_tests::nodes::swallow;

        robot Stove {
            node measure = measure<Warmth>() every 100ms;
            node left    = left_of();
            measure -> left -> swallow();
            record "stove.mcap" { left; }
        }
    }
}

/// A message with the definition `float32 kelvin`.
pub mod kelvin {
    use super::*;

    /// A temperature.
    #[derive(Debug, Clone)]
    pub struct Warmth(f32);

    impl Message for Warmth {
        const NAME: &'static str = "sensor_msgs/msg/Temperature";
        const DEFINITION: &'static str = "float32 kelvin";
        fn write(&self, message: &mut Writer<'_>) {
            message.f32(self.0);
        }
        fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
            message.f32().map(Self)
        }
    }

    impl Version for Warmth {
        fn at(time: f32) -> Self {
            Self(time)
        }
        fn left(&self) -> f32 {
            self.0
        }
    }

    graph! {
        use crate::types::{left_of, measure, kelvin::Warmth};
        use apex_tests::nodes::swallow;

        robot Stove {
            node measure = measure<Warmth>() every 100ms;
            node left    = left_of();
            measure -> left -> swallow();
            record "stove.mcap" { left; }
        }
    }
}

/// Replays a recording, and returns the report or the error as text.
fn replayed<P: Program>(program: P, path: &Path) -> Result<Report, String> {
    replay(program, path, ()).map_err(|error| error.to_string())
}

fn recorded() -> (Folder, PathBuf) {
    let folder = Folder::new();
    let path = folder.file("run.mcap");
    record::<first::Base>(&path, |tap| {
        drive_with(first::Base::new(), until(250), tap);
    });
    (folder, path)
}

#[test]
fn a_changed_type_is_an_error_that_names_the_change() {
    let (_folder, path) = recorded();
    let check = |result: Result<Report, String>, module: &str, was: &str, is: &str| {
        let text = result.expect_err(module);
        let name = "record::types";
        let expected = format!(
            "the type of `measure.out` was `{name}::first::Measured` and is `{name}::{module}::Measured`; the first \
             difference:\n    recorded: {was}\n    now:      {is}"
        );
        assert!(text.contains(&expected), "{text}");
        assert!(text.contains("run.mcap` cannot be replayed"), "{text}");
    };
    check(replayed(swapped::Base::new(), &path), "swapped", "left: f32", "right: f32");
    check(replayed(narrower::Base::new(), &path), "narrower", "right: f32", "right: 4 of u8");
    check(replayed(shorter::Base::new(), &path), "shorter", "charge: f32", "nothing");
}

#[test]
fn a_port_of_another_type_is_not_compared() {
    let (_folder, path) = recorded();
    let report = replayed(rewired::Base::new(), &path).expect("the sources are the same");
    assert!(!report.is_same(), "{report}");
    let text = report.to_string();
    assert!(text.contains("cannot compare: the type of `kept.out` was `record::types::first::Measured`"), "{text}");
    assert!(text.contains("`left.out`: 3 of 3 tokens the same"), "{text}");
}

#[test]
fn a_type_that_was_only_moved_is_the_same() {
    let (_folder, path) = recorded();
    let report = replayed(moved::Base::new(), &path).expect("the same type");
    assert!(report.is_same() && report.is_whole() && report.missing.is_empty(), "{report}");
    assert_eq!(report.compared.iter().map(|c| c.equal).collect::<Vec<_>>(), [3, 3], "{report}");
}

#[test]
fn a_test_is_not_fed_with_another_type() {
    let (folder, path) = recorded();
    fn codec<T: Serialize + serde::de::DeserializeOwned>() -> Option<Codec<T>> {
        use apex_rt::record::{BySerde as _, Kind};
        (&Kind::<T>::NEW).codec()
    }
    let file = path.to_str().unwrap();
    assert_eq!(tokens::<first::Measured>("", file, "measure.out", codec()).begun_at(Time::ZERO).len(), 3);
    assert_eq!(tokens::<moved::Measured>("", file, "measure.out", codec()).begun_at(Time::ZERO).len(), 3);
    let error = panic::catch_unwind(|| {
        tokens::<shorter::Measured>("", file, "measure.out", codec()).begun_at(Time::ZERO).len()
    });
    let text = *error.expect_err("another type").downcast::<String>().unwrap();
    assert!(text.contains("the type of `measure.out` was") && text.contains("recorded: charge: f32"), "{text}");
    // The bytes of an old recording: three numbers, where two are taken.
    let old = folder.file("old.mcap");
    rewritten(&path, &old, true);
    let file = old.to_str().unwrap();
    assert_eq!(tokens::<first::Measured>("", file, "measure.out", codec()).begun_at(Time::ZERO).len(), 3);
}

#[test]
fn a_changed_message_is_noticed() {
    let folder = Folder::new();
    let path = folder.file("stove.mcap");
    record::<celsius::Stove>(&path, |tap| {
        drive_with(celsius::Stove::new(), until(250), tap);
    });
    let report = replayed(commented::Stove::new(), &path).expect("only a comment differs");
    assert!(report.is_same(), "{report}");
    let text = replayed(kelvin::Stove::new(), &path).expect_err("another definition");
    assert!(text.contains("recorded: float32 celsius\n    now:      float32 kelvin"), "{text}");
}

/// Writes a recording again as earlier versions did: without descriptions of types that are not messages. If it is not
/// `right`, tokens of these types have bytes left over.
fn rewritten(from: &Path, to: &Path, right: bool) {
    let bytes = fs::read(from).expect("it was written");
    let (mut writer, mut ids) = (
        WriteOptions::new().compression(None).create(fs::File::create(to).expect("a new file")).expect("a file"),
        BTreeMap::new(),
    );
    let about = BTreeMap::from([("name".to_owned(), "Base".to_owned())]);
    let about = mcap::records::Metadata { name: "apex/program".to_owned(), metadata: about };
    writer.write_metadata(&about).expect("room");
    let summary = mcap::Summary::read(&bytes).expect("a recording").expect("an end");
    for channel in summary.channels.values() {
        let schema = channel.schema.as_ref().expect("all have one");
        let is_message = channel.message_encoding == "cdr";
        let (encoding, data) = if is_message { ("ros2msg", &*schema.data) } else { ("", &[][..]) };
        let schema = writer.add_schema(&schema.name, encoding, data).expect("room");
        let name = &channel.metadata["apex/name"];
        let id = writer.add_channel(schema, name, &channel.message_encoding, &BTreeMap::new());
        ids.insert(channel.topic.clone(), id.expect("room"));
    }
    for message in MessageStream::new(&bytes).expect("a recording") {
        let message = message.expect("a message");
        let (channel_id, time) = (ids[&message.channel.topic], message.log_time);
        let header = MessageHeader { channel_id, sequence: message.sequence, log_time: time, publish_time: time };
        let mut data = message.data.to_vec();
        if !right && message.channel.message_encoding != "cdr" {
            data.extend_from_slice(&[0; 4]);
        }
        writer.write_to_known_channel(&header, &data).expect("room");
    }
    writer.finish().expect("room");
}

#[test]
fn an_older_recording_can_be_read_with_a_warning() {
    let (folder, path) = recorded();
    let old = folder.file("old.mcap");
    rewritten(&path, &old, true);
    let report = replayed(first::Base::new(), &old).expect("it can be read");
    assert!(report.is_same() && report.is_whole(), "{report}");
    let text = report.to_string();
    assert!(text.contains("warning: the recording does not describe the types of `measure.out`, `kept.out`"), "{text}");
    let text = replayed(shorter::Base::new(), &old).expect_err("another name");
    assert!(text.contains("was `record::types::first::Measured` and is `record::types::shorter::Measured`"), "{text}");
}

#[test]
fn bytes_that_are_left_over_are_an_error() {
    let (folder, path) = recorded();
    let old = folder.file("old.mcap");
    rewritten(&path, &old, false);
    let report = replayed(first::Base::new(), &old).expect("it can be read");
    assert!(!report.is_whole(), "{report}");
    let text = report.to_string();
    assert!(
        text.contains("3 recorded tokens of `measure.out` are not values of its type: bytes are left over"),
        "{text}"
    );
}

/// Sends a word that lives as long as the program.
#[node]
pub fn constant_word(ctx: &Ctx) -> &'static str {
    if ctx.now() < Time::from_millis(150) { "begins" } else { "goes on" }
}

/// Sends the same, borrowed or not.
#[node]
pub fn borrowed_word(ctx: &Ctx) -> Cow<'static, str> {
    if ctx.now() < Time::from_millis(150) { "begins".into() } else { "goes on".to_owned().into() }
}

/// Number of letters of two words.
#[node]
pub fn letters(constant: &&'static str, borrowed: &Cow<'static, str>) -> u64 {
    (constant.len() + borrowed.len()) as u64
}

mod words {
    use super::graph;

    graph! {
        use crate::types::{borrowed_word, constant_word, letters};
        use apex_tests::nodes::swallow;

        robot Words {
            node constant = constant_word() every 100ms;
            node borrowed = borrowed_word() every 100ms;
            node letters  = letters();
            constant -> letters.constant;
            borrowed -> letters.borrowed;
            letters  -> swallow();
        }

        robot Borrowed {
            node borrowed = borrowed_word() every 100ms;
            borrowed -> swallow();
        }
    }
}

#[test]
fn what_a_reference_leads_to_cannot_be_recorded() {
    let folder = Folder::new();
    let mut program = words::Words::new();
    drive_with(&mut program, until(150), ());
    let refused = Recorder::to_file::<words::Words>(&folder.file("words.mcap"), WhenFull::Wait);
    let why = refused.err().map(|e| e.to_string()).unwrap_or_default();
    assert!(why.contains("constant") && !why.contains("borrowed"), "{why}");
    // What may be owned can be read back.
    let path = folder.file("borrowed.mcap");
    record::<words::Borrowed>(&path, |tap| {
        drive_with(&mut words::Borrowed::new(), until(250), tap);
    });
    let file = path.to_str().expect("a name in UTF-8");
    let read = tokens("", file, "borrowed.out", apex_rt::__codec!(Cow<'static, str>)).begun_at(Time::ZERO);
    assert_eq!(read.iter().map(|(_, token)| &**token).collect::<Vec<_>>(), ["begins", "begins", "goes on"]);
}
