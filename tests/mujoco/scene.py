#!/usr/bin/env python3
"""Runs an exported scene in MuJoCo and prints as JSON where it ends. Needs MuJoCo and NumPy.

Joints that follow a prescribed motion are set at every step: by the law whose numbers stand in the custom field of their name, or as
the table says that the text `palm_i_path` names.
"""

import argparse
import json
import math
import os
import time

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


def paths(model, folder):
    """Name and table of every palm that follows one: a row for each time step."""
    for index in range(model.ntext):
        start, size = model.text_adr[index], model.text_size[index]
        # Ends with a zero.
        file = model.text_data[start:start + size - 1].decode()
        name = model.names[model.name_textadr[index]:].split(b"\0")[0].decode()
        yield name, np.loadtxt(os.path.join(folder, file), delimiter=",", skiprows=1, ndmin=2)


def follow(model, data, laws, tables):
    for name, table in tables:
        row = table[min(round(data.time / model.opt.timestep), len(table) - 1), 1:]
        for axis, tail in enumerate("xyz"):
            joint = data.joint(f"{name}_{tail}")
            joint.qpos[0], joint.qvel[0] = row[axis], row[7 + axis]
            joint.qfrc_applied[0] = model.dof_armature[model.joint(f"{name}_{tail}").dofadr[0]] * row[13 + axis]
        joint = data.joint(f"{name}_turn")
        joint.qpos[:], joint.qvel[:] = row[3:7], row[10:13]
        joint.qfrc_applied[:] = model.dof_armature[model.joint(f"{name}_turn").dofadr[0]] * row[16:19]
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
        geom = next(name for name in names if name.startswith("palm_"))
        # The pieces of a cup have a number more.
        palm = "_".join(geom.split("_")[:2])
        mujoco.mj_contactForce(model, data, index, wrench)
        # The frame's first axis leads from the first geom to the second.
        sign = 1.0 if names[0] == geom else -1.0
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
    laws, tables = list(followed(model)), list(paths(model, os.path.dirname(arguments.model)))
    follow(model, data, laws, tables)
    mujoco.mj_forward(model, data)
    start = {model.body(body).name: data.xpos[body].tolist() for body in range(1, model.nbody)}
    if arguments.push:
        body, *force = arguments.push
        data.xfrc_applied[model.body(body).id, :3] = [float(f) for f in force]
    begun = time.perf_counter()
    for _ in range(round(arguments.seconds / model.opt.timestep)):
        follow(model, data, laws, tables)
        mujoco.mj_step(model, data)
    wall = time.perf_counter() - begun
    follow(model, data, laws, tables)
    mujoco.mj_forward(model, data)
    print(json.dumps({
        "mujoco": mujoco.__version__,
        "seconds": data.time,
        "wall": wall,
        "start": start,
        "end": {model.body(body).name: data.xpos[body].tolist() for body in range(1, model.nbody)},
        "turn": {model.body(body).name: data.xquat[body].tolist() for body in range(1, model.nbody)},
        "forces": forces(model, data),
    }))


if __name__ == "__main__":
    main()
