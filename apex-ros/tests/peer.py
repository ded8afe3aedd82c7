"""The other side of tests/peers.rs: keys, tokens and attachments as rmw_zenoh documents them, messages by rosbags.

A node `peer` that sends back on /pong_N what comes on /ping_N, decoded and encoded again, serves /flip, and calls
/robot/shout. Arguments and output are those of wire.py.
"""
import struct
import sys
import time

import numpy
import zenoh
from wire import GID, HEAD, STORE, answers, attachment, key, node_token, open_router, say, token


def read(sample):
    raw = sample.attachment.to_bytes()
    number, stamp, length, gid = struct.unpack("<qqB16s", raw)
    right = len(raw) == 33 and length == 16 and any(gid) and abs(time.time_ns() - stamp) < 60e9
    return number, gid, right


session = open_router()
kept = [node_token(session)]

TYPES = ["sensor_msgs/msg/LaserScan", "geometry_msgs/msg/Twist", "nav_msgs/msg/Odometry", "nav_msgs/msg/OccupancyGrid",
         "tf2_msgs/msg/TFMessage", "sensor_msgs/msg/Image", "std_msgs/msg/String", "sensor_msgs/msg/PointCloud2",
         "diagnostic_msgs/msg/DiagnosticArray", "std_msgs/msg/Empty"]
counts = {}


def echo(index, ty):
    pong = session.declare_publisher(key(f"pong_{index}", ty))

    def on(sample):
        number, _, right = read(sample)
        before = counts.get(ty, 0)
        counts[ty] = number
        raw = sample.payload.to_bytes()
        again = bytes(STORE.serialize_cdr(STORE.deserialize_cdr(raw, ty), ty))
        say("ping", ty, "right" if right and number > before else "WRONG")
        pong.put(again, attachment=attachment(number))

    kept.extend([pong, session.declare_subscriber(key(f"ping_{index}", ty), on),
                 token(session, 2 * index + 1, "MS", f"ping_{index}", ty),
                 token(session, 2 * index + 2, "MP", f"pong_{index}", ty)])


for index, ty in enumerate(TYPES):
    echo(index, ty)

# Maps for those who are late, both ways.
grid = "nav_msgs/msg/OccupancyGrid"
late = zenoh.ext.declare_advanced_publisher(session, key("map_of_peer", grid), cache=zenoh.ext.CacheConfig(max_samples=1),
                                            publisher_detection=True)
Grid, Meta = STORE.types[grid], STORE.types["nav_msgs/msg/MapMetaData"]
Time, Header = STORE.types["builtin_interfaces/msg/Time"], STORE.types["std_msgs/msg/Header"]
Pose, Point = STORE.types["geometry_msgs/msg/Pose"], STORE.types["geometry_msgs/msg/Point"]
origin = Pose(Point(0.0, 0.0, 0.0), STORE.types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0))
meta = Meta(Time(0, 0), 0.5, 2, 1, origin)
message = Grid(Header(Time(1, 2), "map"), meta, numpy.array([100, 0], dtype=numpy.int8))
late.put(bytes(STORE.serialize_cdr(message, grid)), attachment=attachment(1))
kept.append(token(session, 100, "MP", "map_of_peer", grid))


def on_map(sample):
    read_map = STORE.deserialize_cdr(sample.payload.to_bytes(), grid)
    say("map", read_map.header.frame_id, *read_map.data)


kept.append(zenoh.ext.declare_advanced_subscriber(
    session, key("map_of_robot", grid), on_map,
    history=zenoh.ext.HistoryConfig(detect_late_publishers=True, max_samples=1),
    recovery=zenoh.ext.RecoveryConfig(heartbeat=True)))

# A service, std_srvs/srv/SetBool, whose CDR is short: answers the contrary.
flip = key("flip", "std_srvs/srv/SetBool")


def on_query(query):
    number, stamp, length, gid = struct.unpack("<qqB16s", query.attachment.to_bytes())
    data = query.payload.to_bytes()[4]
    say("request", data, number)
    text = b"flipped\0"
    body = struct.pack("<B3xI", 1 - data, len(text)) + text
    query.reply(flip, HEAD + body, attachment=attachment(number, gid))


kept.extend([session.declare_queryable(flip, on_query, complete=True),
             token(session, 101, "SS", "flip", "std_srvs/srv/SetBool")])
say("ready")

for line in sys.stdin:
    word = line.strip()
    if word == "tokens":
        for reply in session.liveliness().get("@ros2_lv/**"):
            say("token", reply.ok.key_expr)
    elif word == "call":
        for reply in answers(session, "robot/shout", "std_srvs/srv/SetBool", b"\1", number=7):
            number, _, _, gid = struct.unpack("<qqB16s", reply.attachment.to_bytes())
            raw = reply.payload.to_bytes()
            length, = struct.unpack_from("<I", raw, 8)
            say("response", raw[4], raw[12:12 + length - 1].decode(), number, "same" if gid == GID else "WRONG")
    elif word == "end":
        break
    say("done", word)
