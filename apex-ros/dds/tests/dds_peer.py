"""The other side of peers.rs: topics, services and nodes over Cyclone DDS, as `rmw_cyclonedds` has them.

Sends back on /pong_N what comes on /ping_N, keeps a text for those who are late, serves /flip, and calls /robot/shout.
The domain is argv[1]. Each line on standard output is one observation.
"""
import sys
import threading
import time
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final
from cyclonedds.idl.types import array, float32, float64, int32, int64, sequence, uint8, uint32, uint64
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration


def say(*words):
    sys.stdout.write(" ".join(map(str, words)) + "\n")
    sys.stdout.flush()


@dataclass
@final
class String(IdlStruct, typename="std_msgs.msg.dds_.String_"):
    data: str


@dataclass
@final
class Vector3(IdlStruct, typename="geometry_msgs.msg.dds_.Vector3_"):
    x: float64
    y: float64
    z: float64


@dataclass
@final
class Twist(IdlStruct, typename="geometry_msgs.msg.dds_.Twist_"):
    linear: Vector3
    angular: Vector3


@dataclass
@final
class Time(IdlStruct, typename="builtin_interfaces.msg.dds_.Time_"):
    sec: int32
    nanosec: uint32


@dataclass
@final
class Header(IdlStruct, typename="std_msgs.msg.dds_.Header_"):
    stamp: Time
    frame_id: str


@dataclass
@final
class LaserScan(IdlStruct, typename="sensor_msgs.msg.dds_.LaserScan_"):
    header: Header
    angle_min: float32
    angle_max: float32
    angle_increment: float32
    time_increment: float32
    scan_time: float32
    range_min: float32
    range_max: float32
    ranges: sequence[float32]
    intensities: sequence[float32]


@dataclass
@final
class Image(IdlStruct, typename="sensor_msgs.msg.dds_.Image_"):
    header: Header
    height: uint32
    width: uint32
    encoding: str
    is_bigendian: uint8
    step: uint32
    data: sequence[uint8]


@dataclass
@final
class FlipRequest(IdlStruct, typename="std_srvs.srv.dds_.SetBool_Request_"):
    guid: uint64
    number: int64
    data: bool


@dataclass
@final
class FlipResponse(IdlStruct, typename="std_srvs.srv.dds_.SetBool_Response_"):
    guid: uint64
    number: int64
    success: bool
    message: str


@dataclass
@final
class Gid(IdlStruct, typename="rmw_dds_common.msg.dds_.Gid_"):
    data: array[uint8, 16]


@dataclass
@final
class NodeInfo(IdlStruct, typename="rmw_dds_common.msg.dds_.NodeEntitiesInfo_"):
    node_namespace: str
    node_name: str
    reader_gid_seq: sequence[Gid]
    writer_gid_seq: sequence[Gid]


@dataclass
@final
class Info(IdlStruct, typename="rmw_dds_common.msg.dds_.ParticipantEntitiesInfo_"):
    gid: Gid
    node_entities_info_seq: sequence[NodeInfo]


RELIABLE = Qos(Policy.Reliability.Reliable(duration(milliseconds=100)), Policy.History.KeepLast(100),
               Policy.DataRepresentation(use_cdrv0_representation=True))
KEPT = Qos(Policy.Reliability.Reliable(duration(milliseconds=100)), Policy.History.KeepLast(1),
           Policy.Durability.TransientLocal, Policy.DataRepresentation(use_cdrv0_representation=True))
BEST = Qos(Policy.Reliability.BestEffort, Policy.History.KeepLast(10),
           Policy.DataRepresentation(use_cdrv0_representation=True))

participant = DomainParticipant(int(sys.argv[1]))
kept = []


def reader(name, ty, qos, hear):
    it = DataReader(participant, Topic(participant, name, ty), qos=qos)

    def take():
        while True:
            for sample in it.take(20):
                hear(sample)
            time.sleep(0.005)

    threading.Thread(target=take, daemon=True).start()
    kept.append(it)
    return it


def writer(name, ty, qos):
    it = DataWriter(participant, Topic(participant, name, ty), qos=qos)
    kept.append(it)
    return it


def echo(index, ty):
    pong = writer(f"rt/pong_{index}", ty, RELIABLE)
    reader(f"rt/ping_{index}", ty, RELIABLE, pong.write)
    return pong


pongs = [echo(index, ty) for index, ty in enumerate([LaserScan, Twist, Image, String])]
writer("rt/map_of_peer", String, KEPT).write(String("grün"))
reader("rt/map_of_robot", String, KEPT, lambda text: say("map", text.data))
best = writer("rt/best", String, BEST)

# A service that answers the contrary, and a client of one.
replies = writer("rr/flipReply", FlipResponse, RELIABLE)


def on_request(request):
    say("request", request.data, request.number)
    replies.write(FlipResponse(request.guid, request.number, not request.data, "flipped"))


reader("rq/flipRequest", FlipRequest, RELIABLE, on_request)
shout = writer("rq/robot/shoutRequest", FlipRequest, RELIABLE)
reader("rr/robot/shoutReply", FlipResponse, RELIABLE,
       lambda it: say("response", it.success, it.message, it.number, hex(it.guid)))


def gid(entity):
    return Gid(list(entity.guid.bytes))


def on_nodes(info):
    for node in info.node_entities_info_seq:
        counts = len(node.reader_gid_seq), len(node.writer_gid_seq)
        say("node", node.node_namespace, node.node_name, *counts)


info = writer("ros_discovery_info", Info, KEPT)
reader("ros_discovery_info", Info, KEPT, on_nodes)
readers = [gid(it) for it in kept if isinstance(it, DataReader)]
writers = [gid(it) for it in kept if isinstance(it, DataWriter)]
info.write(Info(gid(participant), [NodeInfo("/", "peer", readers, writers)]))
say("ready")

for line in sys.stdin:
    word = line.strip()
    if word == "call":
        shout.write(FlipRequest(0x0102030405060708, 7, True))
    say("done", word)
