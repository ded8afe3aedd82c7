"""The other side of the tests of actions with Python: `/py_fibonacci` as rclpy serves it, and a client of `/fibonacci`.

Messages of services are written by hand, as rosbags has none. Arguments and output are those of wire.py.
"""
import struct
import sys
import threading
import time

import numpy
import wire
import zenoh
from rosbags.typesys import get_types_from_msg
from wire import HEAD, STORE, attachment, key, say

ACTION = "example_interfaces/action/Fibonacci"
STORE.register(get_types_from_msg("int32[] sequence", f"{ACTION}_Feedback"))
STORE.register(get_types_from_msg(f"unique_identifier_msgs/UUID goal_id\n{ACTION}_Feedback feedback",
                                  f"{ACTION}_FeedbackMessage"))
STATUS = "action_msgs/msg/GoalStatusArray"


def numbers(sequence):
    return struct.pack(f"<I{len(sequence)}i", len(sequence), *sequence)


session = wire.open_router()
kept = [wire.node_token(session)]


# The server. A goal of 66 is refused, one of 99 is counted until it is called off.
AT = "py_fibonacci/_action/"
UUID, Info = STORE.types["unique_identifier_msgs/msg/UUID"], STORE.types["action_msgs/msg/GoalInfo"]
Status, Array = STORE.types["action_msgs/msg/GoalStatus"], STORE.types[STATUS]
Time = STORE.types["builtin_interfaces/msg/Time"]

feedback = session.declare_publisher(key(AT + "feedback", f"{ACTION}_FeedbackMessage"))
status = zenoh.ext.declare_advanced_publisher(session, key(AT + "status", STATUS), cache=zenoh.ext.CacheConfig(max_samples=1),
                                              publisher_detection=True)
goals, lock = {}, threading.Lock()


class Goal:
    def __init__(self):
        self.state, self.sequence, self.waiting = 2, [0, 1], []


def reply(query, name, body):
    number, _, _, gid = struct.unpack("<qqB16s", query.attachment.to_bytes())
    query.reply(name, HEAD + body, attachment=attachment(number, gid))
    query.drop()


def finish(goal):
    for query in goal.waiting:
        reply(query, key(AT + "get_result", f"{ACTION}_GetResult"), struct.pack("<b3x", goal.state) + numbers(goal.sequence))
    goal.waiting = []


def publish_status():
    array = Array([Status(Info(UUID(numpy.frombuffer(id_, dtype=numpy.uint8)), Time(0, 0)), goal.state)
                   for id_, goal in goals.items()])
    status.put(bytes(STORE.serialize_cdr(array, STATUS)), attachment=attachment(1))


def work(id_, goal, order):
    Message, Feedback = STORE.types[f"{ACTION}_FeedbackMessage"], STORE.types[f"{ACTION}_Feedback"]
    while True:
        time.sleep(0.02)
        with lock:
            if goal.state == 3:
                goal.state = 5
            elif len(goal.sequence) >= order and order != 99:
                goal.state = 4
            else:
                goal.sequence.append((goal.sequence[-1] + goal.sequence[-2]) % 1000)
                message = Message(UUID(numpy.frombuffer(id_, dtype=numpy.uint8)),
                                  Feedback(numpy.array(goal.sequence, dtype=numpy.int32)))
                feedback.put(bytes(STORE.serialize_cdr(message, f"{ACTION}_FeedbackMessage")), attachment=attachment(1))
                continue
            finish(goal)
            publish_status()
            say("ended", goal.state)
            return


def on_goal(query):
    data = query.payload.to_bytes()[4:]
    id_, order = data[:16], struct.unpack("<i", data[16:20])[0]
    say("goal", order, "v4" if id_[6] >> 4 == 4 and id_[8] >> 6 == 2 else "WRONG")
    accepted = order != 66
    if accepted:
        with lock:
            goals[id_] = Goal()
            publish_status()
        threading.Thread(target=work, args=(id_, goals[id_], order), daemon=True).start()
    reply(query, key(AT + "send_goal", f"{ACTION}_SendGoal"), struct.pack("<B3xiI", accepted, 1, 2))


def on_result(query):
    goal = goals[query.payload.to_bytes()[4:20]]
    with lock:
        goal.waiting.append(query)
        if goal.state > 3:
            finish(goal)


def on_cancel(query):
    data = query.payload.to_bytes()[4:]
    id_, stamp = data[:16], struct.unpack("<iI", data[16:24])
    with lock:
        goals[id_].state = 3
        publish_status()
    say("cancel", *stamp)
    reply(query, key(AT + "cancel_goal", "action_msgs/srv/CancelGoal"), struct.pack("<b3xI", 0, 1) + id_ + struct.pack("<iI", 0, 0))


for number, (part, ty, answer) in enumerate([("send_goal", f"{ACTION}_SendGoal", on_goal),
                                             ("get_result", f"{ACTION}_GetResult", on_result),
                                             ("cancel_goal", "action_msgs/srv/CancelGoal", on_cancel)]):
    kept.append(session.declare_queryable(key(AT + part, ty), answer, complete=True))
    kept.append(wire.token(session, number + 10, "SS", AT + part, ty))
kept.append(wire.token(session, 20, "MP", AT + "feedback", f"{ACTION}_FeedbackMessage"))
kept.append(wire.token(session, 21, "MP", AT + "status", STATUS, ":1:,1:,:,:,,"))

# The client.
OF = "fibonacci/_action/"
kept.append(zenoh.ext.declare_advanced_subscriber(
    session, key(OF + "status", STATUS),
    lambda sample: say("states", *[it.status for it in STORE.deserialize_cdr(sample.payload.to_bytes(), STATUS).status_list]),
    history=zenoh.ext.HistoryConfig(detect_late_publishers=True, max_samples=1),
    recovery=zenoh.ext.RecoveryConfig(heartbeat=True)))
kept.append(session.declare_subscriber(
    key(OF + "feedback", f"{ACTION}_FeedbackMessage"),
    lambda sample: say("feedback", *STORE.deserialize_cdr(sample.payload.to_bytes(), f"{ACTION}_FeedbackMessage").feedback.sequence)))


def ask(part, ty, body, then):
    """Asks without waiting, as clients of ROS do."""
    def run():
        for answer in wire.answers(session, OF + part, ty, body, timeout=30.0):
            then(answer.payload.to_bytes()[4:])
    threading.Thread(target=run, daemon=True).start()


def result(data):
    count, = struct.unpack_from("<I", data, 4)
    say("result", data[0], *struct.unpack_from(f"<{count}i", data, 8))


say("ready")
for line in sys.stdin:
    words = line.split()
    if words[0] == "goal":
        goal_id = bytes([int(words[1])] * 16)
        ask("send_goal", f"{ACTION}_SendGoal", goal_id + struct.pack("<i", int(words[2])),
            lambda data: say("accepted" if data[0] else "refused"))
    elif words[0] == "result":
        ask("get_result", f"{ACTION}_GetResult", bytes([int(words[1])] * 16), result)
    elif words[0] == "cancel":
        ask("cancel_goal", "action_msgs/srv/CancelGoal", bytes([int(words[1])] * 16) + struct.pack("<iI", 0, 0),
            lambda data: say("canceling", data[0], struct.unpack_from("<I", data, 4)[0]))
    elif words[0] == "end":
        break
    say("done", line.strip())
