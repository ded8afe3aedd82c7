"""The other side of a test of tests/node.rs: a node `peer` that reads and sets the parameters of /robot, and has some of
its own, which others read. Arguments and output are those of wire.py.
"""
import struct
import sys

import numpy
from rosbags.typesys import get_types_from_msg
from wire import STORE, answers, attachment, key, node_token, open_router, say, token

# The messages of the services, which rosbags does not know.
for name, text in [("Names", "string[] names"), ("Values", "rcl_interfaces/ParameterValue[] values"),
                   ("Parameters", "rcl_interfaces/Parameter[] parameters"),
                   ("Results", "rcl_interfaces/SetParametersResult[] results")]:
    STORE.register(get_types_from_msg(text, f"peer/msg/{name}"))
GET, SET = "rcl_interfaces/srv/GetParameters", "rcl_interfaces/srv/SetParameters"
Value = STORE.types["rcl_interfaces/msg/ParameterValue"]
Parameter = STORE.types["rcl_interfaces/msg/Parameter"]


def value(ty, number=0.0, numbers=()):
    none = [numpy.array([], dtype=kind) for kind in (numpy.uint8, numpy.bool_, numpy.int64)]
    return Value(ty, False, 0, number, "", *none, numpy.array(numbers, dtype=numpy.float64), [])


def asked(name, ty, request, response, field):
    request, response = f"peer/msg/{request}", f"peer/msg/{response}"
    body = bytes(STORE.serialize_cdr(STORE.types[request](field), request))[4:]
    for answer in answers(session, f"robot/{name}", ty, body):
        return STORE.deserialize_cdr(answer.payload.to_bytes(), response)
    return None


def on_query(query):
    number, _, _, gid = struct.unpack("<qqB16s", query.attachment.to_bytes())
    names = STORE.deserialize_cdr(query.payload.to_bytes(), "peer/msg/Names").names
    known = {"odd": value(8, numbers=[numpy.inf, -numpy.inf, numpy.nan, -0.0, 5e-324])}
    values = STORE.types["peer/msg/Values"]([known.get(name, value(0)) for name in names])
    raw = bytes(STORE.serialize_cdr(values, "peer/msg/Values"))
    query.reply(own, raw, attachment=attachment(number, gid))


session = open_router()
own = key("peer/get_parameters", GET)
kept = [node_token(session), session.declare_queryable(own, on_query, complete=True),
        token(session, 1, "SS", "peer/get_parameters", GET)]
say("ready")

for line in sys.stdin:
    word, *rest = line.split()
    if word == "get":
        values = asked("get_parameters", GET, "Names", "Values", rest)
        for one in values.values if values else []:
            say("value", one.type, one.double_value)
    elif word == "set":
        parameter = Parameter(rest[0], value(3, float(rest[1])))
        results = asked("set_parameters", SET, "Parameters", "Results", [parameter])
        for one in results.results if results else []:
            say("result", one.successful, one.reason)
    elif word == "end":
        break
    say("done", line.strip())
