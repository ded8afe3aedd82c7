"""The other side of tests/frames.rs: a base that turns while it drives, with a scanner.

Publishes /tf_static once, /tf 50 times in a second, and between two of them a scan of one beam, which so comes before
the transform with its time. What comes on /robot/placed is compared with products of matrices; what comes on /tf from
others is said. Arguments and output are those of wire.py.
"""
import math
import threading
import time

import numpy
import zenoh
from wire import STORE, attachment, key, node_token, open_router, say, token

TF, SCAN, ODOM = "tf2_msgs/msg/TFMessage", "sensor_msgs/msg/LaserScan", "nav_msgs/msg/Odometry"
Time, Header = STORE.types["builtin_interfaces/msg/Time"], STORE.types["std_msgs/msg/Header"]
Stamped, Transform = STORE.types["geometry_msgs/msg/TransformStamped"], STORE.types["geometry_msgs/msg/Transform"]
Vector, Quaternion = STORE.types["geometry_msgs/msg/Vector3"], STORE.types["geometry_msgs/msg/Quaternion"]
# The scanner is tilted by nothing, 1 m up, and looks to the left.
MOUNT = (0.2, -0.1, 1.0, math.pi / 2)


def place(t):
    """x, y, z, yaw of the base at a time in s."""
    return 0.5 * t, 1.0 - 0.25 * t, 0.0, 0.8 * t


def matrix(x, y, z, yaw):
    c, s = math.cos(yaw), math.sin(yaw)
    return numpy.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, z], [0, 0, 0, 1]])


def header(nanos, frame):
    return Header(Time(nanos // 10**9, nanos % 10**9), frame)


def transform(nanos, parent, child, x, y, z, yaw):
    rotation = Quaternion(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))
    return Stamped(header(nanos, parent), child, Transform(Vector(x, y, z), rotation))


session = open_router()
kept = [node_token(session)]
fixed = zenoh.ext.declare_advanced_publisher(session, key("tf_static", TF), cache=zenoh.ext.CacheConfig(max_samples=1),
                                             publisher_detection=True)
message = STORE.types[TF]([transform(1, "base_link", "laser", *MOUNT)])
fixed.put(bytes(STORE.serialize_cdr(message, TF)), attachment=attachment(1))
moving, scans = session.declare_publisher(key("tf", TF)), session.declare_publisher(key("scan", SCAN))
kept += [token(session, 1, "MP", "tf_static", TF), token(session, 2, "MP", "tf", TF), token(session, 3, "MP", "scan", SCAN)]
BEGIN = time.time_ns()


def on_tf(sample):
    # Its own come back, too.
    for found in STORE.deserialize_cdr(sample.payload.to_bytes(), TF).transforms:
        if found.child_frame_id != "base_link":
            at, turned = found.transform.translation, found.transform.rotation
            stamp = found.header.stamp.sec + found.header.stamp.nanosec / 1e9
            age = "now" if abs(time.time() - stamp) < 60 else "WRONG"
            say("tf", found.header.frame_id, found.child_frame_id, at.x, at.y, at.z, turned.x, turned.w, age)


def on_placed(sample):
    scan = STORE.deserialize_cdr(sample.payload.to_bytes(), SCAN)
    nanos = scan.header.stamp.sec * 10**9 + scan.header.stamp.nanosec
    t = (nanos - BEGIN) / 1e9
    x, y, z, _ = matrix(*place(t)) @ matrix(*MOUNT) @ numpy.array([1.0, 0.0, 0.0, 1.0])
    ranges = scan.ranges[numpy.isfinite(scan.ranges)]
    right = len(ranges) == 1 and abs(ranges[0] - math.hypot(x, y)) < 1e-5
    say("placed", scan.header.frame_id, "right" if right else f"WRONG {ranges} {x} {y} {t}")


kept += [session.declare_subscriber(key("tf", TF), on_tf), session.declare_subscriber(key("robot/placed", SCAN), on_placed)]
kept += [token(session, 4, "MS", "tf", TF), token(session, 5, "MS", "robot/placed", SCAN)]


def drive():
    number = 0
    while True:
        number += 1
        nanos = time.time_ns()
        message = STORE.types[TF]([transform(nanos, "odom", "base_link", *place((nanos - BEGIN) / 1e9))])
        moving.put(bytes(STORE.serialize_cdr(message, TF)), attachment=attachment(number))
        time.sleep(0.01)
        floats = [numpy.array([1.0], dtype=numpy.float32), numpy.array([], dtype=numpy.float32)]
        scan = STORE.types[SCAN](header(time.time_ns(), "laser"), 0.0, 0.0, 0.1, 0.0, 0.0, 0.1, 10.0, *floats)
        scans.put(bytes(STORE.serialize_cdr(scan, SCAN)), attachment=attachment(number))
        time.sleep(0.01)


threading.Thread(target=drive, daemon=True).start()
say("ready")
# Until it is killed.
threading.Event().wait()
