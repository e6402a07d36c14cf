"""Qhull, through SciPy, on the inputs of `bounds_timing` and `bounds_fuzz`, which write them as raw little-endian data.

Usage: bounds_qhull.py hull FILE N REPEATS   N points; prints thread time of the fastest repeat in ms, and corners
       bounds_qhull.py half FILE N REPEATS   interior point, then N planes (normal, offset)
       bounds_qhull.py batch IN OUT          hulls of many point sets, as oriented triangles
"""

import sys
import time

import numpy as np
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError


def timed(work, repeats):
    best = float("inf")
    for _ in range(repeats):
        start = time.thread_time()
        result = work()
        best = min(best, time.thread_time() - start)
    return best * 1e3, result


def triangles(points):
    hull = ConvexHull(points)
    corners = points[hull.simplices]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = np.einsum("ij,ij->i", normals, hull.equations[:, :3]) < 0.0
    simplices = hull.simplices.astype(np.uint32)
    simplices[inward] = simplices[inward][:, ::-1]
    return simplices


def batch(source, target):
    data = open(source, "rb").read()
    at = 0
    with open(target, "wb") as out:
        while at < len(data):
            count = int(np.frombuffer(data, "<u8", 1, at)[0])
            points = np.frombuffer(data, "<f8", 3 * count, at + 8).reshape(-1, 3)
            at += 8 + 24 * count
            try:
                found = triangles(points)
            except (QhullError, ValueError):
                found = np.zeros((0, 3), np.uint32)
            out.write(np.array([len(found)], "<u8").tobytes())
            out.write(np.ascontiguousarray(found, "<u4").tobytes())


if sys.argv[1] == "batch":
    batch(sys.argv[2], sys.argv[3])
else:
    what, path, count, repeats = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    data = np.fromfile(path, "<f8")
    if what == "hull":
        points = data.reshape(count, 3)
        ms, hull = timed(lambda: ConvexHull(points), repeats)
        print(f"{ms:.6f} {len(hull.vertices)}")
    else:
        planes = data[3:].reshape(count, 4)
        ms, hull = timed(lambda: HalfspaceIntersection(planes, data[:3]), repeats)
        print(f"{ms:.6f} {len(hull.dual_vertices)}")
