"""The paper's Fig. 5 scene in MuJoCo: an ellipsoid on three frictionless planes, at several integrators and steps.

Prints one JSON line a run: version, setting, poses every 0.2 s and processor milliseconds per simulated second.
"""

import json
import math
import time

import mujoco
import numpy as np

SLOPE = math.radians(60)
NORMALS = [
    (math.sin(SLOPE) * math.cos(a), math.sin(SLOPE) * math.sin(a), math.cos(SLOPE))
    for a in map(math.radians, (90, 210, 330))
]
START = (-6.70759744e-16, -0.2480484297265176, 4.035183758487995)
VELOCITY = (-0.508133446483411, 0.0, 0.0)
SPIN = (0.0, 0.3, 0.3)


def model(integrator, step, stiffness):
    planes = "".join(
        f'<geom type="plane" size="20 20 1" zaxis="{x} {y} {z}"/>' for x, y, z in NORMALS
    )
    damping = 2 * math.sqrt(stiffness)
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><option gravity="0 0 -9.81" timestep="{step}" integrator="{integrator}" cone="elliptic"
        tolerance="1e-14" iterations="100"/>
        <default><geom condim="1" friction="0 0 0" solref="-{stiffness} -{damping}" solimp="0.9999 0.9999 0.001"/></default>
        <worldbody>{planes}<body pos="{START[0]} {START[1]} {START[2]}"><freejoint/>
        <inertial pos="0 0 0" mass="1" diaginertia="1 1.45 2.05"/>
        <geom type="ellipsoid" size="2.5 2 1"/></body></worldbody></mujoco>"""
    )


def run(integrator, step, stiffness):
    m = model(integrator, step, stiffness)
    d = mujoco.MjData(m)
    d.qvel[:] = (*VELOCITY, *SPIN)
    poses, per_sample = [list(map(float, d.qpos))], round(0.2 / step)
    start = time.process_time()
    for _ in range(21):
        mujoco.mj_step(m, d, nstep=per_sample)
        poses.append(list(map(float, d.qpos)))
    cost = 1e3 * (time.process_time() - start) / 4.2
    return poses, cost


for integrator, step, stiffness, name in (
    ("Euler", 2e-3, 1e5, "Euler 2 ms"),
    ("RK4", 1e-3, 1e5, "RK4 1 ms"),
    ("RK4", 1e-4, 1e7, "RK4 0.1 ms"),
):
    poses, cost = run(integrator, step, stiffness)
    assert np.isfinite(poses).all()
    print(json.dumps({"version": mujoco.__version__, "setting": name, "poses": poses, "ms_per_second": cost}))
