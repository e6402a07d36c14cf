#!/usr/bin/env python3
"""A sensor log as a bag of ROS 2: a wrench a palm, the frames of the palms and the true pose, each at every sample.

    log_to_bag.py LOG BAG

Needs `numpy` and `mcap`; messages are encoded here, since a minute at 1 kHz is 300,000 of them. Conventions are those of the reference bags
(docs/formats.md): forces on the object and torques about the origin of the palm's frame, in that frame; quaternions with the scalar last.
"""

import struct
import sys

import numpy as np
from mcap.writer import CompressionType, Writer

EPOCH = 1_760_000_000 * 10**9
TIME = "int32 sec\nuint32 nanosec\n"
HEADER = "builtin_interfaces/Time stamp\nstring frame_id\n"
VECTOR = "float64 x\nfloat64 y\nfloat64 z\n"
TURN = "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
PARTS = {
    "std_msgs/Header": HEADER,
    "builtin_interfaces/Time": TIME,
    "geometry_msgs/Vector3": VECTOR,
    "geometry_msgs/Point": VECTOR,
    "geometry_msgs/Quaternion": TURN,
    "geometry_msgs/Wrench": "Vector3 force\nVector3 torque\n",
    "geometry_msgs/Pose": "Point position\nQuaternion orientation\n",
    "geometry_msgs/Transform": "Vector3 translation\nQuaternion rotation\n",
    "geometry_msgs/TransformStamped": "std_msgs/Header header\nstring child_frame_id\nTransform transform\n",
}
HEAD = ["std_msgs/Header", "builtin_interfaces/Time"]
KINDS = {
    "geometry_msgs/msg/WrenchStamped": (
        "std_msgs/Header header\nWrench wrench\n",
        [*HEAD, "geometry_msgs/Wrench", "geometry_msgs/Vector3"],
    ),
    "geometry_msgs/msg/PoseStamped": (
        "std_msgs/Header header\nPose pose\n",
        [*HEAD, "geometry_msgs/Pose", "geometry_msgs/Point", "geometry_msgs/Quaternion"],
    ),
    "tf2_msgs/msg/TFMessage": (
        "geometry_msgs/TransformStamped[] transforms\n",
        ["geometry_msgs/TransformStamped", *HEAD, "geometry_msgs/Transform", "geometry_msgs/Vector3", "geometry_msgs/Quaternion"],
    ),
}


def matrices(q):
    """Of unit quaternions (n, 4), scalar first."""
    w, x, y, z = q.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def upright(normals):
    """Orientations (n, 4), scalar first, of palms that pass through the origin: x is horizontal, y points up the palm (version 1)."""
    x = np.cross([0.0, 0.0, 1.0], normals)
    x /= np.linalg.norm(x, axis=1)[:, None]
    m = np.stack([x, np.cross(normals, x), normals], axis=2)
    # The orientation is the eigenvector of the largest eigenvalue of this matrix (Bar-Itzhack 2000), also at half turns.
    of = np.zeros((len(m), 4, 4))
    for a, b, c in [(0, 1, 2), (1, 2, 0), (2, 0, 1)]:
        of[:, 0, a + 1] = of[:, a + 1, 0] = m[:, c, b] - m[:, b, c]
        of[:, a + 1, b + 1] = of[:, b + 1, a + 1] = m[:, a, b] + m[:, b, a]
        of[:, a + 1, a + 1] = m[:, a, a] - m[:, b, b] - m[:, c, c]
    of[:, 0, 0] = np.einsum("kii->k", m)
    return np.linalg.eigh(of)[1][:, :, 3]


def scalar_last(q):
    return q[:, [1, 2, 3, 0]]


def word(text, at):
    """Bytes of a string that begins at an offset of the message, after those up to it."""
    raw = text.encode() + b"\0"
    return b"\0" * (-at % 4) + struct.pack("<I", len(raw)) + raw


def body(raw, numbers):
    """A message whose numbers, in double precision, follow."""
    return b"\0\1\0\0" + raw + b"\0" * (-len(raw) % 8) + struct.pack(f"<{len(numbers)}d", *numbers)


def stamp(ns):
    return struct.pack("<iI", *divmod(ns, 10**9))


def transforms(ns, items):
    raw = struct.pack("<I", len(items))
    for child, numbers in items:
        raw += b"\0" * (-len(raw) % 4) + stamp(ns)
        raw += word("world", len(raw))
        raw += word(child, len(raw))
        raw += b"\0" * (-len(raw) % 8) + struct.pack("<7d", *numbers)
    return b"\0\1\0\0" + raw


def main():
    log, bag = sys.argv[1:3]
    with open(log) as file:
        names = file.readline().strip().split(",")
        table = np.loadtxt(file, delimiter=",")
    column = {name: table[:, k] for k, name in enumerate(names)}
    several = lambda pattern, over="xyz": np.column_stack([column[pattern.format(a)] for a in over])
    palms = range(1, 1 + sum(name.startswith(("Px_", "nx_")) for name in names))
    frames, wrenches = [], []
    for i in palms:
        if "Px_1" in column:
            origin, turn = several("P{}_%d" % i), several("Q{}_%d" % i, "wxyz")
            into = lambda vectors: np.einsum("kji,kj->ki", matrices(turn), vectors)
            contact = several("s{}_%d" % i) if f"sx_{i}" in column else into(several("p{}_%d" % i) - origin)
            force = np.nan_to_num(into(several("f{}_%d" % i)))
        else:
            turn = upright(several("n{}_%d" % i))
            nothing = np.zeros(len(turn))
            origin = np.zeros((len(turn), 3))
            contact = np.column_stack([column[f"s1_{i}"], column[f"s2_{i}"], nothing])
            force = np.column_stack([nothing, nothing, np.nan_to_num(column[f"f_{i}"])])
        wrenches.append(np.hstack([force, np.nan_to_num(np.cross(contact, force))]))
        frames.append(np.hstack([origin, scalar_last(turn)]))
    truth = np.hstack([several("cm{}"), scalar_last(several("q{}", "wxyz"))])
    with open(bag, "wb") as file:
        writer = Writer(file, chunk_size=1 << 20, compression=CompressionType.ZSTD)
        writer.start(profile="ros2", library="recon log_to_bag")
        ids = {}
        for name, (own, parts) in KINDS.items():
            text = own + "".join("=" * 80 + f"\nMSG: {part}\n{PARTS[part]}" for part in parts)
            ids[name] = writer.register_schema(name, "ros2msg", text.encode())
        channel = lambda topic, kind: writer.register_channel(topic, "cdr", ids[kind])
        of_palm = [channel(f"/palm_{i}/wrench", "geometry_msgs/msg/WrenchStamped") for i in palms]
        of_frames, of_truth = channel("/tf", "tf2_msgs/msg/TFMessage"), channel("/truth/pose", "geometry_msgs/msg/PoseStamped")
        for k, t in enumerate(column["t"]):
            ns = EPOCH + round(t * 1e9)
            told = [
                (of_palm[i - 1], body(stamp(ns) + word(f"palm_{i}", 8), wrenches[i - 1][k])) for i in palms
            ]
            told.append((of_frames, transforms(ns, [(f"palm_{i}", frames[i - 1][k]) for i in palms])))
            told.append((of_truth, body(stamp(ns) + word("world", 8), truth[k])))
            for topic, data in told:
                writer.add_message(topic, log_time=ns, publish_time=ns, sequence=k, data=data)
        writer.finish()


if __name__ == "__main__":
    main()
