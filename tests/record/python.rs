//! Recordings can be read by other software: the Python packages `mcap` and `mcap-ros2-support`.

use crate::{Folder, record};
use apex_macros::graph;
use apex_rt::{drive_with, prelude::*};
use apex_tests::python;
use std::{path::Path, process::Command};

graph! {
    use apex_tests::nodes::{chart, count, eyes, heights, pose, swallow, twist, way, word};

    robot Shown {
        node number = count() every 1ms;
        node eyes = eyes() every 1ms;
        node pose = pose() every 1ms;
        node word = word() every 1ms;
        number -> swallow();
        eyes -> swallow();
        pose -> swallow();
        word -> swallow();
    }

    robot Navigator {
        node chart = chart() every 1ms;
        node heights = heights() every 1ms;
        node way = way() every 1ms;
        node twist = twist() every 1ms;
        chart -> swallow();
        heights -> swallow();
        way -> swallow();
        twist -> swallow();
    }
}

const READ: &str = "import math, struct, sys
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
with open(sys.argv[1], 'rb') as file:
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    for schema, channel, message, m in reader.iter_decoded_messages():
        if channel.topic == '/apex/reaction':
            print(channel.topic, m.group, m.nanoseconds)
        elif channel.topic == '/eyes/out':
            print(schema.name, m.header.stamp.nanosec, ['%.2f' % r for r in m.ranges], '%.2f' % m.angle_max)
        elif channel.topic == '/pose/out':
            q = m.pose.orientation
            print(schema.name, m.pose.position.x, m.pose.position.y, '%.3f' % (2 * math.atan2(q.z, q.w)))
        elif channel.topic in ('/number/out', '/word/out'):
            print(schema.name, message.log_time, m.data)
        elif channel.topic == '/chart/map':
            print(schema.name, m.info.width, m.info.height, m.info.resolution, m.info.origin.position.x, list(m.data))
        elif channel.topic == '/heights/map':
            field, = m.fields
            cells = struct.unpack('<6f', bytes(m.data))
            print(schema.name, m.column_count, m.cell_size.x, m.pose.position.y, field.name, field.type, cells)
        elif channel.topic == '/way/path':
            angle = lambda q: '%.2f' % (2 * math.atan2(q.z, q.w))
            print(schema.name, *((p.pose.position.x, p.pose.position.y, angle(p.pose.orientation)) for p in m.poses))
        elif channel.topic == '/twist/out':
            print(schema.name, m.linear.x, m.linear.y, m.angular.z)
";

/// Output of Python for a recording, or `None` without Python.
fn read(path: &Path) -> Option<String> {
    let packages = "mcap mcap-ros2-support";
    let python = python(Path::new(env!("CARGO_TARGET_TMPDIR")), "mcap_ros2", packages)?;
    let output = Command::new(&python).args(["-c", READ]).arg(path).output().expect("python runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
fn numbers_texts_scans_and_poses_are_read_by_python() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    record::<Shown>(&path, |tap| {
        drive_with(Shown::new(), SimClock::until(Time::from_millis(2)), tap);
    });
    let Some(found) = read(&path) else { return };
    let moment = |ms: i64| {
        let ns = ms * 1_000_000;
        format!(
            "/apex/reaction 0 {ns}\nstd_msgs/msg/Float64 {ns} {}\nsensor_msgs/msg/LaserScan {ns} ['1.00', 'nan', 'inf'] 0.20\ngeometry_msgs/msg/PoseStamped 1.5 -2.0 0.500\nstd_msgs/msg/String {ns} zwölf\n",
            ms as f64 + 0.5
        )
    };
    assert_eq!(found, format!("{}{}", moment(0), moment(1)));
}

#[test]
fn maps_paths_and_twists_are_read_by_python() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    record::<Navigator>(&path, |tap| {
        drive_with(Navigator::new(), SimClock::until(Time::from_millis(1)), tap);
    });
    let Some(found) = read(&path) else { return };
    let expected = "\
/apex/reaction 0 0
nav_msgs/msg/OccupancyGrid 3 2 0.5 -1.5 [0, 100, -1, 0, 0, 100]
foxglove_msgs/msg/Grid 3 0.5 0.25 value 7 (0.0, nan, inf, -0.0, 0.0, 0.0)
nav_msgs/msg/Path (0.0, 0.5, '0.00') (2.0, 0.5, '1.57') (2.0, 1.5, '1.57') (2.0, 1.5, '-0.25')
geometry_msgs/msg/Twist 0.5 -0.25 1.5
";
    assert_eq!(found, expected);
}
