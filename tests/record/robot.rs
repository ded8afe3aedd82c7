//! A robot whose devices are those of a recording of ROS 2.

use crate::Folder;
use apex_messages::{
    Message,
    geometry_msgs::{Quaternion, Transform, TransformStamped},
    nav_msgs::Odometry,
    sensor_msgs::LaserScan,
    std_msgs::Header,
    tf2_msgs::TFMessage,
};
use apex_nodes::{
    frames::{Pose3, Transforms},
    io::BagTopic,
    lidar::{PACKET, VelodynePacket, VelodynePackets},
    nav::Twist,
    scan::{Pose2, Scan},
};
use apex_rt::{Construct as _, SimClock, drive, prelude::*};
use mcap::{WriteOptions, records::MessageHeader};
use std::{collections::BTreeMap, fs, path::Path, sync::Mutex};

/// Commands that the base of the recorded robot got, with their times.
static COMMANDS: Mutex<Vec<(Time, Twist)>> = Mutex::new(vec![]);

/// Scanner of the robot, which is not here.
#[node]
pub fn scanner() -> Result<Scan, &'static str> {
    Err("there is no scanner")
}

/// Odometry of the robot, which is not here.
#[node]
pub fn wheels() -> Result<Pose2, &'static str> {
    Err("there are no wheels")
}

/// Motors of the robot, which are not here.
#[node]
pub fn motors(_twist: &Twist) -> Result<(), &'static str> {
    Err("there are no motors")
}

/// Takes commands in place of motors.
#[node]
pub fn listen(ctx: &Ctx, twist: &Twist) {
    COMMANDS.lock().expect("no panic").push((ctx.now(), *twist));
}

apex_macros::graph! {
    use apex_nodes::{
        io::BagTopic,
        nav::{MoveRobot, SafetyField, Twist},
        scan::{Pose2, Scan},
    };
    use crate::robot::{listen, motors, scanner, wheels};

    graph Laser {
        out scan: Scan;

        node device = scanner() every 100ms;
        device -> scan;
    }

    graph Base {
        slot twist: Twist;
        out  odometry: Pose2;

        node turned = wheels() every 20ms;
        turned -> odometry;
        twist  -> motors();
    }

    robot Real {
        node laser = Laser();
        node base  = Base();
        node drive = MoveRobot(distance = 1m);
        node field = SafetyField(radius = 20cm);

        start         => drive.enable;
        base.odometry -> drive.pose;
        laser.scan    -> field.scan;
        drive         -> field.twist;
        field         -> base.twist;
        drive.done    => exit;
    }

    graph RecordedLaser {
        out scan: Scan;

        node bag = BagTopic<Scan>(file = "drive.mcap", topic = "/scan") every 1ms;
        bag -> scan;
    }

    graph RecordedBase {
        slot  twist: Twist;
        out   odometry: Pose2;
        event done;

        node bag = BagTopic<Pose2>(file = "drive.mcap", topic = "/odom") every 1ms;
        bag      -> odometry;
        bag.done -> done;
        twist    -> listen();
    }

    robot Replayed = Real {
        node laser = RecordedLaser();
        node base  = RecordedBase();

        base.done -> exit;
    }
}

/// Time of the first message: since 1970, as ROS 2 has it, in ns.
const BEGIN: u64 = 1_700_000_000_000_000_000;

/// Writes a drive of 2 s at 0.4 m/s, with a wall 5 m ahead; at `last`, the scanner falls silent.
fn write(path: &Path, last: u64) {
    let mut writer = WriteOptions::new().create(fs::File::create(path).expect("a new file")).expect("a file");
    let mut channel = |topic, name, definition: &str| {
        let schema = writer.add_schema(name, "ros2msg", definition.as_bytes()).expect("room");
        writer.add_channel(schema, topic, "cdr", &BTreeMap::new()).expect("room")
    };
    let odom = channel("/odom", Odometry::NAME, Odometry::DEFINITION);
    let scan = channel("/scan", LaserScan::NAME, LaserScan::DEFINITION);
    for millis in (0..=2000_u64).step_by(20) {
        let time = BEGIN + millis * 1_000_000;
        let mut put = |channel_id, bytes: &[u8]| {
            let header = MessageHeader { channel_id, sequence: 0, log_time: time, publish_time: time };
            writer.write_to_known_channel(&header, bytes).expect("room");
        };
        let stamp = Time::from_nanos(time as i64 - 3_000_000);
        let x = 0.0004 * millis as f32;
        put(odom, &Odometry { header: Header::new(stamp, "odom"), ..(&Pose2::new(x, 0.0, 0.0)).into() }.to_bytes());
        if millis % 100 == 0 && millis <= last {
            let scan_message = LaserScan {
                header: Header::new(stamp, "laser"),
                angle_min: -0.5,
                angle_increment: 0.01,
                range_min: 0.1,
                range_max: 10.0,
                ranges: vec![5.0 - x; 101],
                ..LaserScan::default()
            };
            put(scan, &scan_message.to_bytes());
        }
    }
    writer.finish().expect("room");
}

/// Runs the robot on a file; returns the commands by time in ms.
fn run(path: &Path) -> Vec<(i64, f32)> {
    let mut robot = Replayed::new();
    for name in ["laser.bag.file", "base.bag.file"] {
        robot.set_param(name, path.to_str().expect("a readable path").to_owned()).expect("a parameter");
    }
    COMMANDS.lock().expect("no panic").clear();
    drive(robot, SimClock::until(Time::from_secs(10)));
    let commands = COMMANDS.lock().expect("no panic");
    commands.iter().map(|(time, twist)| (time.as_nanos() / 1_000_000, twist.velocity().norm())).collect()
}

#[test]
fn a_variant_of_a_robot_drives_on_a_recording() {
    let folder = Folder::new();
    let path = folder.file("drive.mcap");
    write(&path, 2000);
    let commands = run(&path);
    // It sees the wall in time, because stamps are times of the program, and ends with the recording.
    let drives = commands.iter().filter(|(_, speed)| *speed > 0.1).count();
    assert!(drives > 90, "{commands:?}");
    assert!(commands.iter().all(|(millis, _)| *millis <= 2001), "{:?}", commands.last());
    // The scanner of this one falls silent.
    write(&path, 500);
    let commands = run(&path);
    let last = commands.iter().rfind(|(_, speed)| *speed > 0.1);
    assert!(last.is_some_and(|(millis, _)| (900..=1000).contains(millis)), "{last:?}");
}

/// Answers of the first firings of a player, until it has sent nothing three times.
fn play<T: Message>(file: &str, topic: &'static str) -> (Vec<Result<T, String>>, bool) {
    play_in("", file, topic)
}

/// Answers of a player that demands a frame.
fn play_in<T: Message>(frame: &'static str, file: &str, topic: &'static str) -> (Vec<Result<T, String>>, bool) {
    let mut node = BagTopic::<T>::construct((file.to_owned(), topic, false, frame));
    let (mut sent, mut silent, mut ended) = (vec![], 0, None);
    let mut now = Time::ZERO;
    while silent < 3 {
        let answer = node.process(&Ctx::new(now), apex_rt::event(&mut ended));
        now = Time::from_secs(100);
        match answer {
            Ok(None) => silent += 1,
            Ok(Some(token)) => sent.push(Ok(token)),
            Err(error) => sent.push(Err(error.to_string())),
        }
    }
    (sent, ended.is_some())
}

#[test]
fn what_cannot_be_played_is_said_once() {
    let folder = Folder::new();
    let path = folder.file("drive.mcap");
    write(&path, 500);
    let file = path.to_str().expect("a readable path");
    let (scans, ended) = play::<Scan>(file, "/scan");
    let stamps: Vec<_> = scans.iter().map(|scan| scan.as_ref().expect("a scan").stamp.as_nanos() / 1_000_000).collect();
    assert_eq!((stamps, ended), (vec![-3, 97, 197, 297, 397, 497], true));
    let error = |topic, text: String| {
        let (sent, _) = play::<Scan>(file, topic);
        assert_eq!(sent, [Err(format!("{file}: {text}"))]);
    };
    error("/front", "it has no topic `/front`, but `/odom`, `/scan`".to_owned());
    error(
        "/odom",
        "`/odom` is of type `nav_msgs/msg/Odometry`, and the port reads `sensor_msgs/msg/LaserScan`".to_owned(),
    );
    let (sent, ended) = play::<Scan>("/nowhere.mcap", "/scan");
    assert!(sent.len() == 1 && sent[0].as_ref().is_err_and(|why| why.starts_with("/nowhere.mcap: ")) && !ended);
    // Cut off: what is there is played.
    let bytes = fs::read(&path).expect("the file");
    fs::write(&path, &bytes[..bytes.len() / 2]).expect("a shorter file");
    let (poses, ended) = play::<Pose2>(file, "/odom");
    assert!(ended && poses.iter().all(Result::is_ok), "{poses:?}");
}

/// Transform with a quaternion of this length about the vertical axis.
fn transform(parent: &str, child: &str, length: f64) -> TransformStamped {
    TransformStamped {
        header: Header::new(Time::ZERO, parent),
        child_frame_id: child.to_owned(),
        transform: Transform { rotation: Quaternion { w: length, ..ZERO }, ..Transform::default() },
    }
}

/// Quaternion that a program has not set.
const ZERO: Quaternion = Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 0.0 };

/// Writes a bag with one message of `/tf` every 10 ms, each with these transforms.
fn write_transforms(path: &Path, messages: &[Vec<TransformStamped>]) {
    let mut writer = WriteOptions::new().create(fs::File::create(path).expect("room")).expect("a file");
    let schema = writer.add_schema(TFMessage::NAME, "ros2msg", TFMessage::DEFINITION.as_bytes()).expect("room");
    let channel_id = writer.add_channel(schema, "/tf", "cdr", &BTreeMap::new()).expect("room");
    for (transforms, time) in messages.iter().zip((0..).step_by(10_000_000)) {
        let header = MessageHeader { channel_id, sequence: 0, log_time: time, publish_time: time };
        let message = TFMessage { transforms: transforms.clone() };
        writer.write_to_known_channel(&header, &message.to_bytes()).expect("room");
    }
    writer.finish().expect("room");
}

#[test]
fn each_message_with_what_is_not_a_rotation_is_named() {
    let folder = Folder::new();
    let path = folder.file("tf.mcap");
    let good = || vec![transform("map", "odom", 1.0), transform("odom", "base", 1.0)];
    write_transforms(
        &path,
        &[
            good(),
            vec![transform("map", "odom", 1.0), transform("odom", "base", 0.5)],
            vec![transform("map", "odom", 0.0), transform("odom", "base", 1.0)],
            good(),
        ],
    );
    let file = path.to_str().expect("a readable path");
    let wrong = |frames: &str, why: &str| {
        format!("{file}: `/tf`: a message cannot be read: `{frames}`: the length of a quaternion is {why}")
    };
    let half = || wrong("odom -> base", "0.500: that of a rotation is 1");
    let unset = || wrong("map -> odom", "0.000: its sender has not set it");
    let (messages, ended) = play::<Transforms>(file, "/tf");
    let counts: Vec<_> = messages.into_iter().map(|it| it.map(|it| it.transforms.len())).collect();
    assert_eq!((counts, ended), (vec![Ok(2), Err(half()), Err(unset()), Ok(2)], true));
    // What is not asked for may be wrong.
    let (poses, ended) = play::<Pose2>(file, "/tf: odom -> base");
    let poses: Vec<_> = poses.into_iter().map(|it| it.map(|pose| pose.theta)).collect();
    assert_eq!((poses, ended), (vec![Ok(0.0), Err(half()), Ok(0.0), Ok(0.0)], true));
    let (poses, ended) = play::<Pose3>(file, "/tf: map -> odom");
    let poses: Vec<_> = poses.into_iter().map(|it| it.map(|pose| pose.x)).collect();
    assert_eq!((poses, ended), (vec![Ok(0.0), Ok(0.0), Err(unset()), Ok(0.0)], true));
}

/// A result, or the message of its panic.
fn message_of<T>(result: std::thread::Result<T>) -> Result<T, String> {
    result.map_err(|error| error.downcast::<String>().map_or_else(|_| "?".to_owned(), |it| *it))
}

#[test]
fn frames_of_messages_are_compared() {
    let folder = Folder::new();
    let path = folder.file("drive.mcap");
    write(&path, 0);
    let file = path.to_str().expect("a readable path");
    let first = |frame, topic| play_in::<Pose2>(frame, file, topic).0.swap_remove(0).map(|pose| pose.x);
    let wrong = |found: &str, wanted: &str| {
        let why = format!("it is in the frame `{found}`, and not in `{wanted}`");
        Err(format!("{file}: `/odom`: a message cannot be read: {why}"))
    };
    assert_eq!(first("odom", "/odom"), Ok(0.0));
    assert_eq!(first("/odom", "/odom"), Ok(0.0));
    assert_eq!(first("map", "/odom"), wrong("odom", "map"));
    // The twist of odometry is in the frame of the robot.
    let twist = play_in::<Twist>("odom", file, "/odom").0.swap_remove(0).map(|twist| twist.x);
    assert_eq!(twist, wrong("base_link", "odom"));

    let fed = |frame: &'static str| {
        let codec = apex_rt::__codec!(Scan);
        let read = || apex_rt::record::tokens("", file, "/scan", codec).in_frame(frame).begun_at(Time::ZERO).len();
        message_of(std::panic::catch_unwind(read))
    };
    assert_eq!(fed("laser"), Ok(1));
    let why = fed("base").expect_err("another frame");
    assert!(why.ends_with("it is in the frame `laser`, and not in `base`"), "{why}");
}

#[test]
fn a_transform_that_is_not_there_is_missed() {
    let folder = Folder::new();
    let path = folder.file("tf.mcap");
    write_transforms(&path, &[vec![transform("map", "odom", 1.0), transform("odom", "base", 1.0)]]);
    let file = path.to_str().expect("a readable path");
    let (poses, ended) = play::<Pose2>(file, "/tf: map -> base");
    assert_eq!((poses, ended), (vec![Err(format!("{file}: no message of `/tf` has `map -> base`"))], true));
    let codec = apex_rt::__codec!(Pose2);
    let read = || apex_rt::record::tokens("", file, "/tf: map -> base", codec).begun_at(Time::ZERO).len();
    let why = message_of(std::panic::catch_unwind(read));
    assert_eq!(why, Err(format!("no message of `/tf` in `{file}` has `map -> base`")));
    // Each transform is in the frame of its own header.
    assert!(play_in::<Pose2>("odom", file, "/tf: odom -> base").0[0].is_ok());
    assert!(play_in::<Pose2>("map", file, "/tf: odom -> base").0[0].is_err());
}

#[test]
fn packets_of_a_scanner_are_played() {
    let mut bytes = vec![0; PACKET];
    bytes.chunks_exact_mut(100).for_each(|block| block[..2].copy_from_slice(&[0xff, 0xee]));
    bytes[PACKET - 2..].copy_from_slice(&[0x37, 0x22]);
    let folder = Folder::new();
    let path = folder.file("packets.mcap");
    let mut writer = WriteOptions::new().create(fs::File::create(&path).expect("room")).expect("a file");
    let definition = VelodynePackets::DEFINITION.as_bytes();
    let schema = writer.add_schema("velodyne_msgs/msg/VelodyneScan", "ros2msg", definition).expect("room");
    let channel_id = writer.add_channel(schema, "/packets", "cdr", &BTreeMap::new()).expect("room");
    for millis in [0, 100] {
        let time = BEGIN + millis * 1_000_000;
        let header = MessageHeader { channel_id, sequence: 0, log_time: time, publish_time: time };
        let packet = VelodynePacket::new(Time::from_nanos(time as i64), &bytes).expect("a packet");
        writer.write_to_known_channel(&header, &VelodynePackets { packets: vec![packet; 3] }.to_bytes()).expect("room");
    }
    writer.finish().expect("room");
    let (sent, ended) = play::<VelodynePackets>(path.to_str().expect("a readable path"), "/packets");
    let stamps: Vec<Time> = sent.into_iter().map(|token| token.expect("packets").stamp()).collect();
    assert_eq!((stamps, ended), (vec![Time::ZERO, Time::from_millis(100)], true));
}

#[test]
fn a_message_of_the_same_name_with_another_definition_is_refused() {
    let folder = Folder::new();
    let path = folder.file("old.mcap");
    let mut writer = WriteOptions::new().create(fs::File::create(&path).expect("room")).expect("a file");
    let turned = Twist::DEFINITION.replacen("linear", "angle", 1);
    for (topic, definition) in [("/is", Twist::DEFINITION), ("/was", &turned)] {
        let schema = writer.add_schema(Twist::NAME, "ros2msg", definition.as_bytes()).expect("room");
        let channel_id = writer.add_channel(schema, topic, "cdr", &BTreeMap::new()).expect("room");
        let header = MessageHeader { channel_id, sequence: 0, log_time: BEGIN, publish_time: BEGIN };
        writer.write_to_known_channel(&header, &Twist::ZERO.to_bytes()).expect("room");
    }
    writer.finish().expect("room");
    let file = path.to_str().expect("a readable path");
    assert_eq!(play::<Twist>(file, "/is"), (vec![Ok(Twist::ZERO)], true));
    let (sent, _) = play::<Twist>(file, "/was");
    let difference = "recorded: float64 angle.x\n    known:    float64 linear.x";
    assert_eq!(
        sent,
        [Err(format!(
            "{file}: `/was` has another message `geometry_msgs/msg/Twist` than is known here; the first difference:\n    \
             {difference}"
        ))]
    );
}
