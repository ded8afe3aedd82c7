//! Stamps in the headers of recordings of other programs: a feed moves them with the times at which tokens arrive.

use crate::Folder;
use apex_messages::{
    Message,
    geometry_msgs::TransformStamped,
    nav_msgs::Odometry,
    sensor_msgs::{Image, JointState, LaserScan},
    std_msgs::Header,
    tf2_msgs::TFMessage,
};
use apex_nodes::{
    frames::{JointPositions, Transforms},
    image::{ColorImage, GrayImage},
    scan::Scan,
};
use apex_rt::{
    prelude::*,
    record::{Codec, tokens},
};
use mcap::{WriteOptions, records::MessageHeader};
use std::{collections::BTreeMap, env, fs, path::Path};

/// Time between the start of a reaction and the stamp of a scan, in s.
#[node]
pub fn age(ctx: &Ctx, scan: &Scan) -> f64 {
    ctx.now().as_secs_f64() - scan.stamp.as_secs_f64()
}

apex_macros::graph! {
    use apex_nodes::scan::Scan;
    use crate::stamps::age;

    graph Aged {
        in  scan: Scan;
        out age: f64;

        node a = age();
        scan -> a -> age;
    }

    // The scans are 3 ms old, at whatever time the recording starts.
    test scans_that_are_fed_are_fresh: Aged {
        never age < 0.0029;
        never age > 0.0031;
        feed scan = recording("scans.mcap", "/scan");
        expect age > 0 within 0s;
        wait 1s;
        feed scan = recording("scans.mcap", "/scan");
        expect age > 0 within 0s;
        wait 150ms;
        feed scan = recording("scans.mcap", "/scan");
        expect age > 0 within 0s;
        wait 1s;
    }
}

/// Time of the first message: since 1970, as ROS 2 has it, in ns.
const BEGIN: u64 = 1_700_000_000_000_000_000;
/// Time from the stamp of a message until it is recorded, in ns.
const DELAY: u64 = 3_000_000;

/// Writes the message that `message` makes of a header, at 0, 100 and 200 ms.
fn write<M: Message>(path: &Path, topic: &str, message: fn(Header) -> M) {
    let mut writer = WriteOptions::new().create(fs::File::create(path).expect("a new file")).expect("a file");
    let schema = writer.add_schema(M::NAME, "ros2msg", M::DEFINITION.as_bytes()).expect("room");
    let channel_id = writer.add_channel(schema, topic, "cdr", &BTreeMap::new()).expect("room");
    for time in [0, 100_000_000, 200_000_000].map(|time| BEGIN + time) {
        let header = MessageHeader { channel_id, sequence: 0, log_time: time, publish_time: time };
        let stamp = Time::from_nanos((time - DELAY) as i64);
        writer.write_to_known_channel(&header, &message(Header::new(stamp, "robot")).to_bytes()).expect("room");
    }
    writer.finish().expect("room");
}

fn scan(header: Header) -> LaserScan {
    LaserScan { header, angle_increment: 0.1, range_max: 10.0, ranges: vec![1.0; 3], ..LaserScan::default() }
}

fn image(header: Header, encoding: &str, step: u32) -> Image {
    let data = vec![7; step as usize];
    Image { header, height: 1, width: 1, encoding: encoding.to_owned(), step, data, ..Image::default() }
}

fn transforms(header: Header) -> TFMessage {
    let mut transform = TransformStamped { header, child_frame_id: "laser".to_owned(), ..TransformStamped::default() };
    transform.transform.rotation.w = 1.0;
    TFMessage { transforms: vec![transform] }
}

/// Checks the stamps of the tokens that a feed reads in messages `M`.
fn are_moved<T, M: Message>(codec: Option<Codec<T>>, message: fn(Header) -> M, stamp: fn(&T) -> Time) {
    let folder = Folder::new();
    let path = folder.file("stamped.mcap");
    write(&path, "/stamped", message);
    for begun in [Time::ZERO, Time::from_millis(1500)] {
        let fed = tokens("", path.to_str().expect("a readable path"), "/stamped", codec).begun_at(begun);
        let ages: Vec<_> = fed.iter().map(|(time, token)| (begun + *time).since(stamp(token)).as_nanos()).collect();
        assert_eq!(ages, [u128::from(DELAY); 3], "{} at {begun}", M::NAME);
    }
}

#[test]
fn the_stamps_of_all_messages_move_with_their_times() {
    are_moved(apex_rt::__codec!(Scan), scan, |scan| scan.stamp);
    are_moved(apex_rt::__codec!(ColorImage), |header| image(header, "rgb8", 3), |image| image.stamp);
    are_moved(apex_rt::__codec!(GrayImage), |header| image(header, "mono8", 1), |image| image.stamp);
    let joints = |header| JointState { header, ..JointState::default() };
    are_moved(apex_rt::__codec!(JointPositions), joints, |joints| joints.stamp);
    are_moved(apex_rt::__codec!(Transforms), transforms, |all| all.transforms[0].stamp);
    // Of another message than that of the type.
    let one = |header| transforms(header).transforms.remove(0);
    are_moved(apex_rt::__codec!(Transforms), one, |all| all.transforms[0].stamp);
    // The message itself.
    let odometry = |header| Odometry { header, ..Odometry::default() };
    are_moved(apex_rt::__codec!(Odometry), odometry, |message| Time::from_nanos(message.header.stamp.as_nanos()));
}

#[test]
fn the_scans_of_the_text_are_those_that_are_written_here() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("record/scans.mcap");
    if env::var_os("APEX_UPDATE_EXPECTATIONS").is_some() {
        write(&path, "/scan", scan);
    }
    let fed = tokens("", path.to_str().expect("a readable path"), "/scan", apex_rt::__codec!(Scan));
    let stamps: Vec<_> = fed.begun_at(Time::ZERO).iter().map(|(_, scan)| scan.stamp.as_nanos() / 1_000_000).collect();
    assert_eq!(stamps, [-3, 97, 197]);
}
