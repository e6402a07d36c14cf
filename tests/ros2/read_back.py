#!/usr/bin/env python3
"""Decodes a bag of results with `mcap-ros2-support`, by the definitions that stand in the bag, and prints as JSON, a line for each message:
topic, type, log time (ns), and its stamps (ns), names and numbers (those with a point as words) in the order of the definition. Points of clouds are unpacked, what has
no meaning in a marker (colours, texture, text) is left out.

    read_back.py BAG

Needs the packages `mcap` and `mcap-ros2-support`.
"""

import json
import struct
import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

SECOND = 1_000_000_000
OF_MARKER = ("header", "ns", "id", "type", "action", "pose", "points")


def stamp(time):
    return time.sec * SECOND + time.nanosec


def points_of(cloud):
    """Numbers of the fields of each point, one point after the other."""
    kinds = {7: "f", 8: "d"}
    order = ">" if cloud.is_bigendian else "<"
    data = bytes(cloud.data)
    for k in range(cloud.width * cloud.height):
        for field in cloud.fields:
            yield struct.unpack_from(order + kinds[field.datatype], data, k * cloud.point_step + field.offset)[0]


def flat(value, out):
    if hasattr(value, "sec") and hasattr(value, "nanosec"):
        out.append(stamp(value))
    elif hasattr(value, "point_step"):
        flat(value.header, out)
        flat(list(points_of(value)), out)
    elif hasattr(value, "__slots__"):
        marker = hasattr(value, "mesh_resource")
        for name in value.__slots__:
            if not marker or name in OF_MARKER:
                flat(getattr(value, name), out)
    elif isinstance(value, float):
        # As a word: not every reader of JSON keeps the last digit.
        out.append(repr(value))
    elif isinstance(value, (bool, int, str)):
        out.append(int(value) if isinstance(value, bool) else value)
    else:
        for item in value:
            flat(item, out)
    return out


def main():
    with open(sys.argv[1], "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for schema, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False):
            told = {"topic": channel.topic, "type": schema.name, "log": message.log_time, "values": flat(decoded, [])}
            print(json.dumps(told))


if __name__ == "__main__":
    main()
