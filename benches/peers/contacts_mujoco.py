#!/usr/bin/env python3
"""Peer for `contact_cost`: an ellipsoid that slides over three planes, by MuJoCo's own contacts and integrators.

Usage: contacts_mujoco.py SCENE REPEATS

SCENE is a JSON file: gravity, mass, moments, semi_axes, normals, friction, the start (position, orientation with w first,
velocity, and spin in world axes), duration, and poses (position, orientation) at equal times after the start.
Prints a JSON line for each way and step: what it is, its largest pose error (m, rad) and the wall time of its fastest run in
ms per simulated second, with the settings that were best for that step.

Ways: `constraints` are hard (impedance 0.9999), as MuJoCo is commonly set up; the convex cone couples slip into their normal
row and lets a sliding contact hover, so that with friction they do not get better with shorter steps. `springs` are as soft
as MuJoCo takes them: the contact becomes a spring and damper, the friction a viscous force up to Coulomb's bound, and both get
better with stiffness. All settings of a grid are tried at the longest steps, and variations of the best few of the step
before at each shorter one. The time is that of the best settings alone.
"""
import json
import math
import sys
import time

import mujoco
import numpy as np

STEPS = [5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5]
# `implicitfast` is Euler's here, error by error, as no force of the body's own depends on its velocity.
INTEGRATORS = ["Euler", "RK4"]
WAYS = {"constraints": [0.9999], "springs": [1e-4, 1e-3]}
# Of a spring: times the square of the step. Runge-Kutta steps are stable up to about 7, the others up to about 1.
STIFFNESS = [0.03, 0.1, 0.3, 1.0, 3.0]
# Shares of the critical one.
DAMPING = [0.1, 0.3, 1.0]
# Damping of the slip, 1/s, and how much harder the rows of friction are than normal ones.
FRICTION = [(1.0, 100.0), (3.0, 100.0), (10.0, 100.0), (30.0, 10.0), (100.0, 10.0)]
# Steps at which the whole grid is tried.
LONG = 1e-3
KEPT = 6


def model(scene, integrator, step, settings):
    impedance, stiffness, damping, slip, ratio = settings
    k = stiffness / step**2
    planes, pairs = "", ""
    condim = 3 if scene["friction"] > 0.0 else 1
    mu = max(scene["friction"], 1e-5)
    solimp = f"{impedance} {impedance} 0.001"
    for i, n in enumerate(scene["normals"]):
        zaxis = " ".join(repr(v) for v in n)
        planes += f'<geom name="p{i}" contype="0" conaffinity="0" type="plane" size="20 20 1" zaxis="{zaxis}"/>'
        pairs += (
            f'<pair geom1="p{i}" geom2="o" condim="{condim}" friction="{mu} {mu} 0 0 0" solimp="{solimp}" '
            f'solref="-{k!r} -{2.0 * damping * math.sqrt(k)!r}" solreffriction="-1 -{slip}"/>'
        )
    numbers = lambda name: " ".join(repr(v) for v in scene[name])
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><option gravity="0 0 {-scene['gravity']}" timestep="{step}" integrator="{integrator}" cone="elliptic"
        solver="Newton" tolerance="1e-14" iterations="100" impratio="{ratio}"/>
        <worldbody>{planes}<body><freejoint/>
        <inertial pos="0 0 0" mass="{scene['mass']}" diaginertia="{numbers('moments')}"/>
        <geom name="o" contype="0" conaffinity="0" type="ellipsoid" size="{numbers('semi_axes')}"/></body></worldbody>
        <contact>{pairs}</contact></mujoco>"""
    )


def run(scene, built):
    """Largest pose error, and wall time in s; infinite where the simulation breaks down."""
    data = mujoco.MjData(built)
    q = np.array(scene["orientation"])
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, q)
    data.qpos[:] = [*scene["position"], *q]
    # Angular velocity in body axes.
    data.qvel[:] = [*scene["velocity"], *(turn.reshape(3, 3).T @ scene["spin"])]
    poses = scene["poses"]
    steps = round(scene["duration"] / len(poses) / built.opt.timestep)
    found, begun = [], time.perf_counter()
    for _ in poses:
        mujoco.mj_step(built, data, nstep=steps)
        found.append(data.qpos.copy())
    spent, worst = time.perf_counter() - begun, 0.0
    for got, (p, q) in zip(found, poses):
        off, inverse = np.zeros(4), np.array([q[0], -q[1], -q[2], -q[3]])
        mujoco.mju_mulQuat(off, got[3:], inverse)
        turned = 2.0 * math.atan2(float(np.linalg.norm(off[1:])), abs(float(off[0])))
        worst = max(worst, float(np.linalg.norm(got[:3] - p)), turned)
    broken = data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number or not math.isfinite(worst)
    return (math.inf if broken else worst), spent


def best_first(scene, integrator, step, candidates):
    tried = [(run(scene, model(scene, integrator, step, settings))[0], settings) for settings in candidates]
    return sorted(tried, key=lambda one: one[0])


def variations(settings):
    impedance, stiffness, damping, slip, ratio = settings
    stiffer = [(impedance, stiffness * factor, damping, slip, ratio) for factor in (0.5, 1.0, 2.0)]
    return stiffer + [(impedance, stiffness, damping, 3.0 * slip, ratio)]


def main():
    scene, repeats = json.load(open(sys.argv[1])), int(sys.argv[2])
    mujoco.set_mju_user_warning(lambda _: None)
    friction = FRICTION if scene["friction"] > 0.0 else [(1.0, 1.0)]
    for way, impedances in WAYS.items():
        grid = [(i, k, d, *f) for i in impedances for k in STIFFNESS for d in DAMPING for f in friction]
        for integrator in INTEGRATORS:
            candidates = grid
            for step in STEPS:
                tried = best_first(scene, integrator, step, candidates)
                error, settings = tried[0]
                if not math.isfinite(error):
                    continue
                kept = [settings for error, settings in tried[:KEPT] if math.isfinite(error)]
                candidates = list(dict.fromkeys(new for one in kept for new in variations(one)))
                if step > LONG:
                    candidates = grid
                built = model(scene, integrator, step, settings)
                wall = min(run(scene, built)[1] for _ in range(repeats))
                names = ("impedance", "stiffness dt^2", "damping ratio", "slip damping", "impratio")
                line = {"version": mujoco.__version__, "way": way, "integrator": integrator, "step": step}
                line |= {"error": error, "ms": 1e3 * wall / scene["duration"]}
                print(json.dumps(line | {"settings": dict(zip(names, settings))}), flush=True)


if __name__ == "__main__":
    main()
