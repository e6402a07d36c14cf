"""Poses of random bodies tossed onto a table: MuJoCo's motion, seen by a tracker with the faults that trackers have.

Usage: tosses.py FOLDER FAMILY TOSSES FIRST_SEED SETS [WORSE]
Writes for each seed FAMILY-SEED.csv (as tracked), FAMILY-SEED.true.csv (as it was) and FAMILY-SEED.body (which body).
The table's top is z = 0. Lengths in m, times in s, angles in rad.

Each set draws its own body, tracker and tosses:
- frames: 100 to 240 a second;
- noise of each frame, independent: position 0.02 to 0.3 mm and rotation 0.3 to 3 mrad a axis (log-uniform);
- an error of each toss, as markers that are hidden make: the same size again;
- rotation seen at another time than position, by 0.3 ms (standard deviation over the sets);
- in half of the sets a filter that predicts with constant velocity (alpha-beta, gain 0.8 to 1), which runs on into the
  table when the body bounces;
- a table that is taken for 0.1 mm (standard deviation) higher or lower than it is.
All errors of the tracker are WORSE times as large (1 by default; the filter's gain is as far below 1).
"""

import sys
from pathlib import Path

import mujoco
import numpy as np
from scipy.spatial import ConvexHull

SCENE = """
<mujoco>
  <option timestep="{step}" gravity="0 0 -9.81"/>
  <asset>{mesh}</asset>
  <default><geom friction="{friction} 0.005 0.0001" solref="0.0006 {damping}"/></default>
  <worldbody>
    <geom type="plane" size="5 5 0.1"/>
    <body name="body"><freejoint/><geom {geom} density="1000"/></body>
  </worldbody>
</mujoco>
"""
# Steps of a quarter of a millisecond: contacts as stiff as they allow, so that impacts last far less than a frame.
STEP = 2.5e-4
LONGEST = 0.7
FAMILIES = ("ellipsoid", "capsule", "cylinder", "polyhedron", "box", "tetrahedron", "prism")


def text(values):
    return " ".join(repr(float(v)) for v in np.ravel(values))


def body(family, rng):
    """A geom of MuJoCo, its mesh if any, and the line that tells the body."""
    size = rng.uniform(0.025, 0.07, size=3)
    if family == "ellipsoid":
        return f'type="ellipsoid" size="{text(size)}"', "", f"ellipsoid {text(size)}"
    if family == "capsule":
        return f'type="capsule" size="{text(size[:2])}"', "", f"capsule {text(size[:2])}"
    if family == "cylinder":
        return f'type="cylinder" size="{text(size[:2])}"', "", f"cylinder {text(size[:2])}"
    if family == "box":
        corners = size * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        return f'type="box" size="{text(size)}"', "", f"points {text(corners)}"
    if family == "tetrahedron":
        points = size * np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    elif family == "prism":
        sides = int(rng.integers(3, 7))
        angles = 2 * np.pi * np.arange(sides) / sides
        ring = np.stack([size[0] * np.cos(angles), size[0] * np.sin(angles)], axis=1)
        points = np.concatenate([np.c_[ring, np.full(sides, z)] for z in (-size[1], size[1])])
    else:
        points = rng.normal(size=(int(rng.integers(8, 17)), 3))
        points *= size / np.linalg.norm(points, axis=1, keepdims=True)
        points -= points[ConvexHull(points).vertices].mean(axis=0)
    mesh = f'<mesh name="mesh" vertex="{text(points)}"/>'
    return 'type="mesh" mesh="mesh"', mesh, f"points {text(points)}"


def product(p, q):
    out = np.zeros(4)
    mujoco.mju_mulQuat(out, p, q)
    return out


def turned(q, turn):
    """The orientation q after a small turn given in the body's axes."""
    angle = np.linalg.norm(turn)
    small = np.zeros(4)
    mujoco.mju_axisAngle2Quat(small, turn / max(angle, 1e-300), angle)
    return product(q, small)


def turn_between(p, q):
    """The turn in the body's axes that leads from p to q."""
    turn = np.zeros(3)
    mujoco.mju_subQuat(turn, q, p)
    return turn


class Tracker:
    def __init__(self, rng, worse):
        self.rng = rng
        self.rate = rng.uniform(100, 240)
        self.position = worse * np.exp(rng.uniform(np.log(2e-5), np.log(3e-4)))
        self.rotation = worse * np.exp(rng.uniform(np.log(3e-4), np.log(3e-3)))
        self.lag = worse * rng.normal(scale=3e-4)
        self.gain = 1.0 - worse * (1.0 - rng.uniform(0.8, 1.0)) if rng.random() < 0.5 else 1.0
        self.table = worse * rng.normal(scale=1e-4)

    def begin(self):
        self.shift = self.rng.normal(scale=self.position, size=3) - [0, 0, self.table]
        self.turn = self.rng.normal(scale=self.rotation, size=3)
        self.state = None

    def see(self, position, quaternion):
        position = position + self.shift + self.rng.normal(scale=self.position, size=3)
        quaternion = turned(quaternion, self.turn + self.rng.normal(scale=self.rotation, size=3))
        if self.gain == 1.0 or self.state is None:
            self.state = (position, quaternion, None, None)
            return position, quaternion
        # Alpha-beta filter, with Benedict and Bordner's gain for the velocity; the first two frames give the velocity.
        before, q_before, velocity, omega = self.state
        if velocity is None:
            self.state = (position, quaternion, position - before, turn_between(q_before, quaternion))
            return position, quaternion
        alpha, beta = self.gain, self.gain**2 / (2 - self.gain)
        expected, q_expected = before + velocity, turned(q_before, omega)
        off, q_off = position - expected, turn_between(q_expected, quaternion)
        kept, q_kept = expected + alpha * off, turned(q_expected, alpha * q_off)
        self.state = (kept, q_kept, velocity + beta * off, omega + beta * q_off)
        return kept, q_kept


def lifted(model, data):
    """The position lifted by what the contact gives way: a real body does not reach into the table."""
    mujoco.mj_kinematics(model, data)
    mujoco.mj_collision(model, data)
    deepest = min((c.dist for c in data.contact), default=0.0)
    return data.qpos[:3] + [0, 0, max(0.0, -deepest)]


def toss(model, data, tracker, rng):
    """Rows of (measured, true) until rest."""
    mujoco.mj_resetData(model, data)
    quaternion = rng.normal(size=4)
    data.qpos[:] = [0, 0, rng.uniform(0.12, 0.25), *(quaternion / np.linalg.norm(quaternion))]
    data.qvel[:] = [*rng.normal(scale=[0.6, 0.6, 0.3]), *rng.normal(scale=6.0, size=3)]
    tracker.begin()
    steps = round(1 / tracker.rate / STEP)
    late = min(round(abs(tracker.lag) / STEP), steps - 1)
    at_rest = 0
    for _ in range(int(LONGEST * tracker.rate)):
        mujoco.mj_step(model, data, steps - late)
        first = lifted(model, data), data.qpos[3:7].copy()
        if late:
            mujoco.mj_step(model, data, late)
        second = lifted(model, data), data.qpos[3:7].copy()
        seen = tracker.see(first[0], second[1]) if tracker.lag > 0 else tracker.see(second[0], first[1])
        yield seen, second
        at_rest = at_rest + 1 if np.linalg.norm(data.qvel) < 0.02 else 0
        if at_rest > 10:
            return


def write(folder, family, tosses, seed, worse):
    # Streams of their own for each family too, so that all sets are independent.
    streams = ([seed, FAMILIES.index(family), k] for k in range(3))
    bodies, tracking, tossing = map(np.random.default_rng, streams)
    geom, mesh, line = body(family, bodies)
    friction, damping = bodies.uniform(0.15, 0.6), bodies.uniform(0.3, 1.0)
    scene = SCENE.format(step=STEP, mesh=mesh, geom=geom, friction=friction, damping=damping)
    model = mujoco.MjModel.from_xml_string(scene)
    data = mujoco.MjData(model)
    tracker = Tracker(tracking, worse)
    header = "toss,frame,qw,qx,qy,qz,px,py,pz"
    files = [[header], [header]]
    for run in range(tosses):
        for frame, poses in enumerate(toss(model, data, tracker, tossing)):
            for rows, (position, quaternion) in zip(files, poses):
                rows.append(f"{run},{frame}," + ",".join(repr(float(x)) for x in (*quaternion, *position)))
    stem = Path(folder) / f"{family}-{seed}"
    for ending, rows in (("csv", files[0]), ("true.csv", files[1])):
        Path(f"{stem}.{ending}").write_text("\n".join(rows) + "\n")
    Path(f"{stem}.body").write_text(line + "\n")


def main():
    folder, family, tosses, first, sets = sys.argv[1:6]
    worse = float(sys.argv[6]) if len(sys.argv) > 6 else 1.0
    if family not in FAMILIES:
        raise SystemExit(f"no family {family}: one of {', '.join(FAMILIES)}")
    for seed in range(int(first), int(first) + int(sets)):
        write(folder, family, int(tosses), seed, worse)


main()
