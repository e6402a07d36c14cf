#!/usr/bin/env python3
"""What viewers make of a bag of results, as rows of a Markdown table: topic, type, whether its definition is the one that ROS 2 publishes (as the
package `rosbags` has it), whether its contents are what a viewer of ROS messages draws (Foxglove's 3D panel, RViz), and what Rerun shows of it.

    in_viewers.py BAG

Needs the packages `mcap`, `mcap-ros2-support`, `rosbags` and `rerun-sdk`. Rerun converts the bag as its viewer loads it; what it takes for a thing in space becomes components
of an archetype, and everything else stays a message to be read.
"""

import math
import re
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

from mcap.reader import make_reader
from mcap_ros2.reader import read_ros2_messages
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

SHOWN = ("Transform3D", "Points3D", "InstancePoses3D", "Arrows3D", "Mesh3D")


def is_published(name, text, store):
    """Whether the fields of a type, and of all types in it, are those that are published; None of a type of our own."""
    if name not in store.fielddefs:
        return None
    own = get_types_from_msg(text, name)
    return all(store.fielddefs.get(kind, (None, None))[1] == fields for kind, (_, fields) in own.items())


# Numbers of visualization_msgs/Marker and sensor_msgs/PointField.
ARROW, SPHERE, TRIANGLE_LIST, DELETE, FLOAT32 = 0, 2, 11, 2, 7


def seconds(stamp):
    return stamp.sec + 1e-9 * stamp.nanosec


def of_marker(marker):
    """What keeps a marker from being drawn as it is meant."""
    if marker.action == DELETE:
        return
    turn, scale = marker.pose.orientation, marker.scale
    if abs(math.hypot(turn.x, turn.y, turn.z, turn.w) - 1.0) > 1e-9:
        yield "its orientation has no unit length"
    if marker.color.a <= 0.0:
        yield "it is transparent"
    if marker.type == ARROW and not (len(marker.points) == 2 and scale.x > 0.0 and scale.y > 0.0):
        yield "an arrow has two points, and a shaft and a head that are wide"
    if marker.type == SPHERE and min(scale.x, scale.y, scale.z) <= 0.0:
        yield "a ball is flat"
    if marker.type == TRIANGLE_LIST and (len(marker.points) % 3 or (scale.x, scale.y, scale.z) != (1.0, 1.0, 1.0)):
        yield "triangles have three corners each, to scale"
    if marker.type not in (ARROW, SPHERE, TRIANGLE_LIST):
        yield f"kind {marker.type}"


def of_cloud(cloud):
    """What keeps a cloud of points from being read."""
    fields = [(field.name, field.offset, field.datatype, field.count) for field in cloud.fields]
    if fields != [("x", 0, FLOAT32, 1), ("y", 4, FLOAT32, 1), ("z", 8, FLOAT32, 1)] or cloud.is_bigendian:
        yield f"its fields are {fields}"
    if cloud.row_step != cloud.point_step * cloud.width or len(cloud.data) != cloud.row_step * cloud.height:
        yield "its size is not that of its points"


def not_drawn(bag):
    """By topic, what keeps its messages from being drawn: contents, or a frame of which the bag says only later, or never, where it is."""
    first, standing, wrong = {"world": -math.inf}, [], defaultdict(set)
    for read in read_ros2_messages(bag):
        name, message = read.schema.name.split("/")[-1], read.ros_msg
        parts = {"TFMessage": lambda: message.transforms, "MarkerArray": lambda: message.markers}.get(name, lambda: [message])()
        for part in parts:
            at = seconds(part.header.stamp)
            standing.append((read.channel.topic, part.header.frame_id, at))
            if name == "TFMessage":
                first.setdefault(part.child_frame_id, at)
            of = {"MarkerArray": of_marker, "PointCloud2": of_cloud}.get(name)
            wrong[read.channel.topic].update(of(part) if of else ())
    for topic, frame, at in standing:
        if first.get(frame, math.inf) > at:
            wrong[topic].add(f"{frame} stands nowhere then")
    return wrong


def in_rerun(bag):
    """Archetypes that Rerun makes of each topic, with the rows of each."""
    with tempfile.TemporaryDirectory() as folder:
        made = str(Path(folder, "bag.rrd"))
        subprocess.run(["rerun", "mcap", "convert", bag, "-o", made], check=True, capture_output=True)
        text = subprocess.run(["rerun", "rrd", "print", made], check=True, capture_output=True, text=True).stdout
    found = defaultdict(lambda: defaultdict(int))
    for rows, topic, columns in re.findall(r"with (\d+) rows .*? - (/\S+) - data columns: \[(.*?)\]", text):
        for archetype in {column.split(":")[0] for column in columns.split()} & set(SHOWN):
            found[topic][archetype] += int(rows)
    return found


def main():
    bag = sys.argv[1]
    store = get_typestore(Stores.ROS2_JAZZY)
    shown, wrong = in_rerun(bag), not_drawn(bag)
    with open(bag, "rb") as file:
        summary = make_reader(file).get_summary()
    for channel in sorted(summary.channels.values(), key=lambda channel: channel.topic):
        schema = summary.schemas[channel.schema_id]
        published = {True: "yes", False: "NO", None: "of our own"}[is_published(schema.name, schema.data.decode(), store)]
        seen = ", ".join(f"{name} ({rows})" for name, rows in sorted(shown[channel.topic].items())) or "as a message"
        drawn = "; ".join(sorted(wrong[channel.topic])) or "yes"
        print(f"| {channel.topic} | {schema.name} | {published} | {drawn} | {seen} |")


if __name__ == "__main__":
    main()
