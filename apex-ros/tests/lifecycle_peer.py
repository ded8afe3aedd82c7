"""A manager of `/robot` in Python, as that of Nav2: it calls `change_state` and `get_state`, and hears the transitions.

A router that listens at the address in argv[1]; the further arguments are the hashes of the services. Messages are
those of rosbags, or written by hand where rosbags has no services. Each line on standard output is one observation.
"""
import struct
import sys
import time

import zenoh
from rosbags.typesys import Stores, get_typestore

ADDRESS, SERVICES = sys.argv[1], dict(pair.split("=") for pair in sys.argv[2:])
STORE = get_typestore(Stores.ROS2_JAZZY)
EVENT = "lifecycle_msgs/msg/TransitionEvent"


def say(*words):
    # Threads of Zenoh speak, too: a line is written as one.
    sys.stdout.write(" ".join(map(str, words)) + "\n")
    sys.stdout.flush()


def key(name, ty):
    package, kind, short = ty.split("/")
    hash_ = SERVICES.get(ty) or STORE.hash_rihs01(ty)
    return f"0/robot/{name}/{package}::{kind}::dds_::{short}_/{hash_}"


def ask(name, ty, body):
    attachment = struct.pack("<qqB16s", 1, time.time_ns(), 16, bytes(range(16)))
    for answer in session.get(key(name, ty), payload=b"\0\1\0\0" + body, attachment=attachment, timeout=5.0,
                              target=zenoh.QueryTarget.ALL_COMPLETE):
        return answer.ok.payload.to_bytes()[4:]
    return None


config = zenoh.Config()
for setting, value in [("mode", '"router"'), ("listen/endpoints", f'["{ADDRESS}"]'), ("scouting/multicast/enabled", "false"),
                       ("timestamping/enabled", "true")]:
    config.insert_json5(setting, value)
session = zenoh.open(config)


def on_event(sample):
    event = STORE.deserialize_cdr(sample.payload.to_bytes(), EVENT)
    say("event", event.transition.id, event.start_state.label, event.goal_state.label)


kept = session.declare_subscriber(key("transition_event", EVENT), on_event)
say("ready")
for line in sys.stdin:
    words = line.split()
    if words[0] == "change":
        # By the number, as Nav2 does; the label is empty.
        answer = ask("change_state", "lifecycle_msgs/srv/ChangeState", struct.pack("<B3xIB", int(words[1]), 1, 0))
        say("changed", answer and answer[0])
    elif words[0] == "state":
        answer = ask("get_state", "lifecycle_msgs/srv/GetState", b"\0")
        if answer:
            length, = struct.unpack_from("<I", answer, 4)
            say("state", answer[0], answer[8:8 + length - 1].decode())
    say("done", line.strip())
