"""What programs in Python beside the tests have in common: a router, and keys, tokens and attachments of ROS 2.

The address at which the router listens is argv[1]; the further arguments are the hashes of the services. Messages are
those of rosbags. Each line on standard output is one observation.
"""
import struct
import sys
import time

import zenoh
from rosbags.typesys import Stores, get_typestore

ADDRESS, SERVICES = sys.argv[1], dict(pair.split("=") for pair in sys.argv[2:])
STORE = get_typestore(Stores.ROS2_JAZZY)
GID = bytes(range(16))
HEAD = b"\0\1\0\0"


def say(*words):
    # Threads of Zenoh speak, too: a line is written as one.
    sys.stdout.write(" ".join(map(str, words)) + "\n")
    sys.stdout.flush()


def key(name, ty):
    package, kind, short = ty.split("/")
    hash_ = SERVICES.get(ty) or STORE.hash_rihs01(ty)
    return f"0/{name}/{package}::{kind}::dds_::{short}_/{hash_}"


def attachment(number, gid=GID):
    return struct.pack("<qqB16s", number, time.time_ns(), 16, gid)


def answers(session, name, ty, body, number=1, timeout=5.0):
    """The answers of all servers of a service."""
    for answer in session.get(key(name, ty), payload=HEAD + body, attachment=attachment(number), timeout=timeout,
                              target=zenoh.QueryTarget.ALL_COMPLETE):
        yield answer.ok


def open_router():
    config = zenoh.Config()
    for setting, value in [("mode", '"router"'), ("listen/endpoints", f'["{ADDRESS}"]'),
                           ("scouting/multicast/enabled", "false"), ("timestamping/enabled", "true")]:
        config.insert_json5(setting, value)
    return zenoh.open(config)


def node_token(session):
    return session.liveliness().declare_token(f"@ros2_lv/0/{session.info.zid()}/0/0/NN/%/%/peer")


def token(session, number, kind, name, ty, qos="::,10:,:,:,,"):
    _, wire, hash_ = key(name, ty).rsplit("/", 2)
    mangled = "%" + name.replace("/", "%")
    text = f"@ros2_lv/0/{session.info.zid()}/0/{number}/{kind}/%/%/peer/{mangled}/{wire}/{hash_}/{qos}"
    return session.liveliness().declare_token(text)
