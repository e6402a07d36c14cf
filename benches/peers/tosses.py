"""Poses of a body tossed onto a table, simulated by MuJoCo and tracked with noise, as CSV on standard output.

Usage: tosses.py BODY TOSSES POSITION_SD ROTATION_SD SEED
BODY is one of BODIES; standard deviations per axis in m and rad. 148 frames a second. The table's top is z = 0.
"""

import sys

import mujoco
import numpy as np

BODIES = {
    "box": '<geom type="box" size="0.05 0.04 0.03" mass="0.4"/>',
    "ellipsoid": '<geom type="ellipsoid" size="0.06 0.05 0.04" mass="0.4"/>',
    "capsule": '<geom type="capsule" size="0.03 0.04" mass="0.3"/>',
    "cylinder": '<geom type="cylinder" size="0.04 0.05" mass="0.4"/>',
    "tetrahedron": '<geom type="mesh" mesh="tetrahedron" mass="0.3"/>',
}
SCENE = """
<mujoco>
  <option timestep="{step}" gravity="0 0 -9.81"/>
  <asset><mesh name="tetrahedron" vertex="0.06 0.06 0.06  0.06 -0.06 -0.06  -0.06 0.06 -0.06  -0.06 -0.06 0.06"/></asset>
  <default><geom friction="0.3 0.005 0.0001" solref="0.003 1"/></default>
  <worldbody>
    <geom type="plane" size="5 5 0.1"/>
    <body name="body"><freejoint/>{geom}</body>
  </worldbody>
</mujoco>
"""
FRAME = 1 / 148
STEPS = 20


def tosses(body, count, position_sd, rotation_sd, rng):
    model = mujoco.MjModel.from_xml_string(SCENE.format(step=FRAME / STEPS, geom=BODIES[body]))
    data = mujoco.MjData(model)
    for toss in range(count):
        mujoco.mj_resetData(model, data)
        quaternion = rng.normal(size=4)
        data.qpos[:] = [0, 0, rng.uniform(0.12, 0.25), *(quaternion / np.linalg.norm(quaternion))]
        data.qvel[:] = [*rng.normal(scale=[0.6, 0.6, 0.3]), *rng.normal(scale=6.0, size=3)]
        at_rest = 0
        for frame in range(150):
            mujoco.mj_step(model, data, STEPS)
            turn = np.zeros(4)
            error = rng.normal(scale=rotation_sd, size=3)
            angle = np.linalg.norm(error)
            mujoco.mju_axisAngle2Quat(turn, error / max(angle, 1e-300), angle)
            measured = np.zeros(4)
            # A free joint's velocity of rotation, and so a small turn of it, is in the body's axes.
            mujoco.mju_mulQuat(measured, data.qpos[3:7], turn)
            position = data.qpos[:3] + rng.normal(scale=position_sd, size=3)
            yield toss, frame, *measured, *position
            at_rest = at_rest + 1 if np.linalg.norm(data.qvel) < 0.02 else 0
            if at_rest > 10:
                break


def main():
    body, count, position_sd, rotation_sd, seed = sys.argv[1:]
    print("toss,frame,qw,qx,qy,qz,px,py,pz")
    rng = np.random.default_rng(int(seed))
    for row in tosses(body, int(count), float(position_sd), float(rotation_sd), rng):
        print(",".join(repr(float(x)) if k > 1 else str(x) for k, x in enumerate(row)))


main()
