//! Recordings of other programs: the Python package `rosbags` writes them, in all compressions.

use crate::Folder;
use apex_macros::graph;
use apex_messages::nav_msgs::Odometry;
use apex_nodes::{
    image::ColorImage,
    nav::{Path as Way, Twist},
    scan::{Pose2, Scan},
};
use apex_rt::{
    prelude::*,
    record::{Codec, tokens},
};
use apex_tests::python;
use std::{panic, path::Path, process::Command, time::Duration};

/// Speed of a robot, in m/s.
#[node]
pub fn speed(odometry: &Odometry) -> f64 {
    odometry.twist.twist.linear.x
}

graph! {
    use apex_messages::nav_msgs::Odometry;
    use crate::bags::speed;

    graph Moving {
        in odometry: Odometry;
        out speed: f64;
        node s = speed();
        odometry -> s -> speed;
    }
}

const WRITE: &str = "import sys
import numpy as np
from pathlib import Path
from rosbags.rosbag1 import Writer as Bag
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
folder = Path(sys.argv[1])
def messages(store, seq):
    t = lambda name: store.types[name]
    time = t('builtin_interfaces/msg/Time')(1700000000, 7)
    header = lambda frame: t('std_msgs/msg/Header')(*seq, time, frame)
    g = lambda name: t('geometry_msgs/msg/' + name)
    quaternion = g('Quaternion')(0.0, 0.0, np.sin(0.25), np.cos(0.25))
    pose = g('Pose')(g('Point')(1.5, -2.0, 0.3), quaternion)
    covered = g('PoseWithCovariance')(pose, np.arange(36.0))
    twist = g('Twist')(g('Vector3')(0.5, 0.0, 0.0), g('Vector3')(0.0, 0.0, -0.25))
    floats = lambda *numbers: np.array(numbers, dtype=np.float32)
    yield '/scan', 'sensor_msgs/msg/LaserScan', lambda k: (
        header('laser'), -1.0, 1.0, 0.5, 0.0, 0.1, 0.05, 30.0, floats(k, np.inf, np.nan), floats(9))
    yield '/odom', 'nav_msgs/msg/Odometry', lambda k: (
        header('odom'), 'base', covered, g('TwistWithCovariance')(twist, np.zeros(36)))
    yield '/amcl', 'geometry_msgs/msg/PoseWithCovarianceStamped', lambda k: (header('map'), covered)
    yield '/speed', 'geometry_msgs/msg/TwistStamped', lambda k: (header('base'), twist)
    transform = lambda a, b, x: g('TransformStamped')(
        header(a), b, g('Transform')(g('Vector3')(x, -2.0, 0.3), quaternion))
    yield '/tf', 'tf2_msgs/msg/TFMessage', lambda k: (
        [transform('map', 'odom', 9.0), transform('odom', 'base', 1.5)],)
    stamped = g('PoseStamped')(header('map'), pose)
    yield '/plan', 'nav_msgs/msg/Path', lambda k: (header('map'), [stamped])
    yield '/image', 'sensor_msgs/msg/Image', lambda k: (
        header('camera'), 1, 2, 'bgr8', 0, 6, np.array([1, 2, 3, 4, 5, 6], dtype=np.uint8))
def write(writer, store, seq, serialize):
    with writer:
        for topic, ty, make in messages(store, seq):
            connection = writer.add_connection(topic, ty, typestore=store)
            for k in range(3):
                data = serialize(store.types[ty](*make(k)), ty)
                writer.write(connection, 1700000000_000000000 + k * 250_000_000, data)
new = get_typestore(Stores.ROS2_JAZZY)
for name, mode in [('plain', None), ('message', CompressionMode.MESSAGE), ('storage', CompressionMode.STORAGE)]:
    writer = Writer(folder / name, version=9, storage_plugin=StoragePlugin.MCAP)
    if mode:
        writer.set_compression(mode, CompressionFormat.ZSTD)
    write(writer, new, (), new.serialize_cdr)
old = get_typestore(Stores.ROS1_NOETIC)
old.register(get_types_from_msg('geometry_msgs/TransformStamped[] transforms', 'tf2_msgs/msg/TFMessage'))
for name, how in [('none', None), ('bz2', Bag.CompressionFormat.BZ2), ('lz4', Bag.CompressionFormat.LZ4)]:
    writer = Bag(folder / (name + '.bag'))
    if how:
        writer.set_compression(how)
    write(writer, old, (4,), old.serialize_ros1)
";

/// Tokens of a channel, or the message of the error.
fn read<T: Clone>(file: &Path, channel: &str, codec: Option<Codec<T>>) -> Result<Vec<(Duration, T)>, String> {
    let file = file.to_str().expect("text");
    let read = panic::catch_unwind(|| tokens("", file, channel, codec).begun_at(Time::ZERO).to_vec());
    read.map_err(|error| error.downcast::<String>().map_or_else(|_| "?".to_owned(), |text| *text))
}

/// Checks the first of three tokens, 250 ms apart.
fn first<T: Clone>(file: &Path, channel: &str, codec: Option<Codec<T>>) -> T {
    let tokens = read(file, channel, codec).unwrap_or_else(|error| panic!("{error}"));
    let times: Vec<_> = tokens.iter().map(|(time, _)| time.as_millis()).collect();
    assert_eq!(times, [0, 250, 500], "{}: {channel}", file.display());
    tokens.into_iter().next().expect("a token").1
}

fn is_there(pose: Pose2) {
    assert!(pose.x == 1.5 && pose.y == -2.0 && (pose.theta - 0.5).abs() < 1e-6, "{pose:?}");
}

#[test]
fn bags_of_python_are_read() {
    let folder = Folder::new();
    let Some(python) = python(Path::new(env!("CARGO_TARGET_TMPDIR")), "rosbags", "rosbags") else { return };
    let written = Command::new(python).args(["-c", WRITE]).arg(folder.file("")).output().expect("python runs");
    assert!(written.status.success(), "{}", String::from_utf8_lossy(&written.stderr));
    for name in ["plain", "message", "storage", "none.bag", "bz2.bag", "lz4.bag"] {
        let file =
            if name.ends_with(".bag") { folder.file(name) } else { folder.file(name).join(format!("{name}.mcap")) };
        let scan = first(&file, "/scan", apex_rt::__codec!(Scan));
        assert_eq!((scan.angle_min, scan.angle_increment, scan.range_max), (-1.0, 0.5, 30.0), "{name}");
        assert!(scan.ranges[0] == 0.0 && scan.ranges[1] == f32::INFINITY && scan.ranges[2].is_nan(), "{name}");
        assert_eq!(scan.stamp, Time::from_nanos(7), "after the start of the recording");
        for topic in ["/odom", "/amcl", "/tf: odom -> base"] {
            is_there(first(&file, topic, apex_rt::__codec!(Pose2)));
        }
        // Messages themselves can be tokens.
        let odometry = first(&file, "/odom", apex_rt::__codec!(Odometry));
        assert_eq!((&*odometry.child_frame_id, odometry.pose.covariance[35]), ("base", 35.0), "{name}");
        let mut program = Moving::new();
        program.inputs().odometry.put(odometry).expect("room");
        program.react(Time::ZERO);
        assert_eq!(program.outputs().speed, Some(0.5), "{name}");
        for topic in ["/odom", "/speed"] {
            assert_eq!(first(&file, topic, apex_rt::__codec!(Twist)), Twist::new(0.5, 0.0, -0.25), "{name}");
        }
        let plan = first(&file, "/plan", apex_rt::__codec!(Way));
        assert!(plan.points.len() == 1 && (plan.heading - 0.5).abs() < 1e-6, "{name}: {plan:?}");
        assert_eq!(first(&file, "/image", apex_rt::__codec!(ColorImage)).pixels.as_raw(), &[3, 2, 1, 6, 5, 4]);
        let which = read(&file, "/tf", apex_rt::__codec!(Pose2)).expect_err("two transforms");
        assert!(which.ends_with("name one behind the topic, as `: map -> odom`"), "{which}");
        let other = read(&file, "/tf: map -> base", apex_rt::__codec!(Pose2)).expect_err("none");
        assert!(other.starts_with("no message of `/tf` in") && other.ends_with("has `map -> base`"), "{other}");
    }
}
