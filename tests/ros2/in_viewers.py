#!/usr/bin/env python3
"""What viewers make of a bag of results, as rows of a Markdown table: topic, type, whether its definition is the one that ROS 2 publishes (as the
package `rosbags` has it), and what Rerun shows of it.

    in_viewers.py BAG

Needs the packages `mcap`, `rosbags` and `rerun-sdk`. Rerun converts the bag as its viewer loads it; what it takes for a thing in space becomes components
of an archetype, and everything else stays a message to be read.
"""

import re
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

from mcap.reader import make_reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

SHOWN = ("Transform3D", "Points3D", "InstancePoses3D", "Arrows3D", "Mesh3D")


def is_published(name, text, store):
    """Whether the fields of a type, and of all types in it, are those that are published; None of a type of our own."""
    if name not in store.fielddefs:
        return None
    own = get_types_from_msg(text, name)
    return all(store.fielddefs.get(kind, (None, None))[1] == fields for kind, (_, fields) in own.items())


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
    shown = in_rerun(bag)
    with open(bag, "rb") as file:
        summary = make_reader(file).get_summary()
    for channel in sorted(summary.channels.values(), key=lambda channel: channel.topic):
        schema = summary.schemas[channel.schema_id]
        published = {True: "yes", False: "NO", None: "of our own"}[is_published(schema.name, schema.data.decode(), store)]
        seen = ", ".join(f"{name} ({rows})" for name, rows in sorted(shown[channel.topic].items())) or "as a message"
        print(f"| {channel.topic} | {schema.name} | {published} | {seen} |")


if __name__ == "__main__":
    main()
