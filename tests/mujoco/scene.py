#!/usr/bin/env python3
"""Runs an exported scene in MuJoCo and prints as JSON where it ends. Needs MuJoCo and NumPy.

Joints that follow a prescribed motion are set by the law whose numbers stand in the custom field of their name, at every step.
"""

import argparse
import json
import math

import mujoco
import numpy as np


def constant(value, t):
    return value, 0.0, 0.0


def steady(start, rate, t):
    return start + rate * t, rate, 0.0


def sinusoid(mean, amplitude, frequency, phase, t):
    sin, cos = math.sin(frequency * t + phase), math.cos(frequency * t + phase)
    return mean + amplitude * sin, amplitude * frequency * cos, -amplitude * frequency**2 * sin


def ramp(height, start, duration, t):
    x = min(max((t - start) / duration, 0.0), 1.0)
    y = x * (1 - x)
    value = x**4 * (35 + x * (-84 + x * (70 - 20 * x)))
    return height * value, height * 140 * y**3 / duration, height * 420 * y**2 * (1 - 2 * x) / duration**2


LAWS = {"constant": constant, "steady": steady, "sinusoid": sinusoid, "ramp": ramp}


def followed(model):
    """Joint, law and numbers of every joint that follows a law."""
    for index in range(model.nnumeric):
        name = model.numeric(index).name
        joint, _, kind = name.rpartition("_")
        if joint.endswith("_motor"):
            continue
        first = model.numeric_adr[index]
        yield joint, LAWS[kind], model.numeric_data[first:first + model.numeric_size[index]]


def follow(model, data, laws):
    for name, law, numbers in laws:
        joint = data.joint(name)
        joint.qpos[0], joint.qvel[0], acceleration = law(*numbers, data.time)
        joint.qfrc_applied[0] = model.dof_armature[model.joint(name).dofadr[0]] * acceleration


def forces(model, data):
    """Force of each palm on the object, world axes, N."""
    sums, wrench = {}, np.zeros(6)
    for index in range(data.ncon):
        contact = data.contact[index]
        names = [model.geom(geom).name for geom in (contact.geom1, contact.geom2)]
        palm = next(name for name in names if name.startswith("palm_"))
        mujoco.mj_contactForce(model, data, index, wrench)
        # The frame's first axis leads from the first geom to the second.
        sign = 1.0 if names[0] == palm else -1.0
        sums[palm] = sums.get(palm, np.zeros(3)) + sign * contact.frame.reshape(3, 3).T @ wrench[:3]
    return {palm: force.tolist() for palm, force in sums.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model")
    parser.add_argument("seconds", type=float)
    parser.add_argument("--push", nargs=4, metavar=("BODY", "FX", "FY", "FZ"), help="a constant force on a body, N")
    arguments = parser.parse_args()
    model = mujoco.MjModel.from_xml_path(arguments.model)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    laws = list(followed(model))
    follow(model, data, laws)
    mujoco.mj_forward(model, data)
    start = {model.body(body).name: data.xpos[body].tolist() for body in range(1, model.nbody)}
    if arguments.push:
        body, *force = arguments.push
        data.xfrc_applied[model.body(body).id, :3] = [float(f) for f in force]
    while data.time < arguments.seconds:
        follow(model, data, laws)
        mujoco.mj_step(model, data)
    follow(model, data, laws)
    mujoco.mj_forward(model, data)
    print(json.dumps({
        "mujoco": mujoco.__version__,
        "seconds": data.time,
        "start": start,
        "end": {model.body(body).name: data.xpos[body].tolist() for body in range(1, model.nbody)},
        "turn": {model.body(body).name: data.xquat[body].tolist() for body in range(1, model.nbody)},
        "forces": forces(model, data),
    }))


if __name__ == "__main__":
    main()
