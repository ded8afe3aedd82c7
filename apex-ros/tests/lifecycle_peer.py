"""A manager of `/robot` in Python, as that of Nav2: it calls `change_state` and `get_state`, and hears the transitions.

Messages of services are written by hand, as rosbags has none. Arguments and output are those of wire.py.
"""
import struct
import sys

from wire import STORE, answers, key, open_router, say

EVENT = "lifecycle_msgs/msg/TransitionEvent"
session = open_router()


def on_event(sample):
    event = STORE.deserialize_cdr(sample.payload.to_bytes(), EVENT)
    say("event", event.transition.id, event.start_state.label, event.goal_state.label)


kept = session.declare_subscriber(key("robot/transition_event", EVENT), on_event)
say("ready")
for line in sys.stdin:
    words = line.split()
    if words[0] == "change":
        # By the number, as Nav2 does; the label is empty.
        body = struct.pack("<B3xIB", int(words[1]), 1, 0)
        answer = next(answers(session, "robot/change_state", "lifecycle_msgs/srv/ChangeState", body), None)
        say("changed", answer and answer.payload.to_bytes()[4])
    elif words[0] == "state":
        answer = next(answers(session, "robot/get_state", "lifecycle_msgs/srv/GetState", b"\0"), None)
        if answer:
            raw = answer.payload.to_bytes()
            length, = struct.unpack_from("<I", raw, 8)
            say("state", raw[4], raw[12:12 + length - 1].decode())
    say("done", line.strip())
