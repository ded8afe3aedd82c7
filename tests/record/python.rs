//! Others read what was recorded: the Python packages `mcap` and `mcap-ros2-support`, from `target/mcap` or from the
//! system's Python.

use crate::{Folder, record};
use apex_rt::{drive_with, prelude::*};
use std::{path::Path, process::Command};

graph! {
    use apex_tests::nodes::{count, eyes, pose, swallow, word};

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
}

const READ: &str = "import sys, math
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
with open(sys.argv[1], 'rb') as file:
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    for schema, channel, message, m in reader.iter_decoded_messages():
        if channel.topic == 'apex/reaction':
            print(channel.topic, m.group, m.nanoseconds)
        elif channel.topic == 'eyes.out':
            print(schema.name, m.header.stamp.nanosec, ['%.2f' % r for r in m.ranges], '%.2f' % m.angle_max)
        elif channel.topic == 'pose.out':
            q = m.pose.orientation
            print(schema.name, m.pose.position.x, m.pose.position.y, '%.3f' % (2 * math.atan2(q.z, q.w)))
        elif channel.topic in ('number.out', 'word.out'):
            print(schema.name, message.log_time, m.data)
";

/// A Python that has the packages.
fn python() -> Option<String> {
    let own = Path::new(env!("CARGO_TARGET_TMPDIR")).join("../mcap/bin/python3").display().to_string();
    let has = |p: &String| Command::new(p).args(["-c", "import mcap_ros2"]).output().is_ok_and(|o| o.status.success());
    [own, "python3".to_owned()].into_iter().find(has)
}

#[test]
fn numbers_texts_scans_and_poses_are_read_by_python() {
    let Some(python) = python() else {
        println!(
            "skipped: no Python with mcap; `python3 -m venv target/mcap && target/mcap/bin/pip install mcap mcap-ros2-support`"
        );
        return;
    };
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    record::<Shown>(&path, |tap| {
        drive_with(Shown::new(), SimClock::until(Time::from_millis(2)), tap);
    });
    let output = Command::new(&python).args(["-c", READ]).arg(&path).output().expect("python runs");
    let found = String::from_utf8_lossy(&output.stdout);
    let moment = |ms: i64| {
        let ns = ms * 1_000_000;
        format!(
            "apex/reaction 0 {ns}\nstd_msgs/msg/Float64 {ns} {}\nsensor_msgs/msg/LaserScan {ns} ['1.00', 'nan', 'inf'] 0.20\ngeometry_msgs/msg/PoseStamped 1.5 -2.0 0.500\nstd_msgs/msg/String {ns} zwölf\n",
            ms as f64 + 0.5
        )
    };
    assert_eq!(found, format!("{}{}", moment(0), moment(1)), "{}", String::from_utf8_lossy(&output.stderr));
}
