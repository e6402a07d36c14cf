#!/usr/bin/env python3
"""Repeats a reconstructed motion in MuJoCo and compares it with the sensor log.

Loads the exported object, sets palms as in the log and the object in its estimated first state, simulates, and prints
as JSON how far contact positions and forces are from those logged. Needs MuJoCo and NumPy.

Palms are planes on hinges of huge inertia, turned as logged. Contacts are springs (stiffness 1e6 1/s^2, damping 2e3
1/s at impedance 0.1) and sink in by some 1e-6 m: stiffer ones lose touch for single steps, which leaves the motion as
it is but makes forces jump. The first 50 ms, in which the springs are loaded, are not compared.
"""

import argparse
import csv
import json
import math

import mujoco
import numpy as np

STEP = 1e-4
STIFFNESS, DAMPING, IMPEDANCE = 1e6, 2e3, 0.1
SETTLING = 0.05
BROAD = 20.0
ARMATURE = 1e12


def table(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def palm_frame(normal):
    """Axis t1, t2 up the palm, normal: as in the sensor log."""
    rise = -normal[:2] / np.hypot(*normal[:2])
    t1 = np.array([rise[1], -rise[0], 0.0])
    return t1, np.cross(normal, t1), normal


def quaternion(x, y, z):
    q = np.zeros(4)
    mujoco.mju_mat2Quat(q, np.column_stack((x, y, z)).ravel())
    return q


class Palm:
    def __init__(self, log, number):
        self.normals = np.column_stack([log[f"n{axis}_{number}"] for axis in "xyz"])
        first = palm_frame(self.normals[0])
        self.start = quaternion(*first)
        # Angle about t1 since the start: n' = rate t1 x n = -rate t2.
        angles = np.unwrap(np.arctan2(-self.normals @ first[1], self.normals @ first[2]))
        rates = log.get(f"rate_{number}")
        self.t, self.angles = log["t"], angles
        self.turns = bool(np.ptp(angles) > 1e-9)
        self.rates = np.gradient(angles, self.t) if rates is None else rates

    def at(self, t):
        """Angle, rate and acceleration, by cubic interpolation."""
        k = int(np.clip(np.searchsorted(self.t, t) - 1, 0, len(self.t) - 2))
        h = self.t[k + 1] - self.t[k]
        s = (t - self.t[k]) / h
        a, b, u, v = self.angles[k], self.angles[k + 1], h * self.rates[k], h * self.rates[k + 1]
        c2, c3 = 3 * (b - a) - 2 * u - v, 2 * (a - b) + u + v
        return a + s * (u + s * (c2 + s * c3)), (u + s * (2 * c2 + 3 * s * c3)) / h, (2 * c2 + 6 * s * c3) / h**2


def build(path, palms, gravity, mesh_dir):
    spec = mujoco.MjSpec.from_file(path)
    if mesh_dir:
        spec.meshdir = mesh_dir
    if not spec.bodies[1].joints:
        # A URDF does not say that its root is free to move.
        spec.bodies[1].add_freejoint()
    option = spec.option
    option.timestep, option.integrator = STEP, mujoco.mjtIntegrator.mjINT_RK4
    option.gravity, option.tolerance, option.ccd_tolerance = [0, 0, -gravity], 1e-14, 1e-12
    for number, palm in enumerate(palms, 1):
        body = spec.worldbody.add_body(name=f"palm_{number}", quat=palm.start)
        if palm.turns:
            # Planes cannot move in MuJoCo, so this is the top of a box.
            body.mass, body.inertia, body.explicitinertial = 1.0, [1, 1, 1], True
            body.add_joint(name=f"hinge_{number}", type=mujoco.mjtJoint.mjJNT_HINGE, axis=[1, 0, 0], armature=ARMATURE)
            kind, size, place = mujoco.mjtGeom.mjGEOM_BOX, [BROAD, BROAD, BROAD], [0, 0, -BROAD]
        else:
            kind, size, place = mujoco.mjtGeom.mjGEOM_PLANE, [0, 0, 1], [0, 0, 0]
        geom = body.add_geom(name=f"palm_{number}", type=kind, size=size, pos=place, condim=1)
        geom.priority, geom.contype, geom.conaffinity = 1, 1, 0
        geom.solref, geom.solimp = [-STIFFNESS, -DAMPING], [IMPEDANCE, IMPEDANCE, 1e-3, 0.5, 2]
    return spec.compile()


def set_palms(data, palms, t):
    for number, palm in enumerate(palms, 1):
        if not palm.turns:
            continue
        joint = data.joint(f"hinge_{number}")
        joint.qpos[0], joint.qvel[0], acceleration = palm.at(t)
        joint.qfrc_applied[0] = ARMATURE * acceleration


def set_start(data, motion):
    joint = next(data.joint(j) for j in range(data.model.njnt) if data.model.jnt_type[j] == 0)
    pose = [motion[name][0] for name in ("cmx", "cmy", "cmz", "qw", "qx", "qy", "qz")]
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, np.array(pose[3:]))
    turning = rotation.reshape(3, 3).T @ [motion[name][0] for name in ("wx", "wy", "wz")]
    joint.qpos[:] = pose
    joint.qvel[:] = np.concatenate(([motion[name][0] for name in ("vx", "vy", "vz")], turning))


def sense(model, data):
    """Contact (s1, s2) and force of each palm; the middle of a palm's contacts, and their sum, where it has several."""
    sums = {number: np.zeros(4) for number in (1, 2, 3)}
    wrench = np.zeros(6)
    for index in range(data.ncon):
        contact = data.contact[index]
        names = [model.geom(contact.geom1).name, model.geom(contact.geom2).name]
        number = next((int(name[-1]) for name in names if name.startswith("palm_")), None)
        if number is None:
            continue
        mujoco.mj_contactForce(model, data, index, wrench)
        t1, t2, _ = palm_frame(data.geom(f"palm_{number}").xmat.reshape(3, 3)[:, 2])
        force = wrench[0]
        sums[number] += [force, force * (contact.pos @ t1), force * (contact.pos @ t2), 1]
    return {n: (s[1] / s[0], s[2] / s[0], s[0]) if s[0] > 0 else None for n, s in sums.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("object", help="exported MJCF or URDF")
    parser.add_argument("motion", help="motion.csv of the reconstruction")
    parser.add_argument("log", help="sensor log")
    parser.add_argument("--gravity", type=float, default=9.81)
    parser.add_argument("--until", type=float, default=math.inf, help="time at which to stop, s")
    parser.add_argument("--average", type=float, default=0.0, help="time over which forces are averaged, s")
    parser.add_argument("--mesh-dir", help="folder of the meshes")
    arguments = parser.parse_args()
    log, motion = table(arguments.log), table(arguments.motion)
    palms = [Palm(log, number) for number in (1, 2, 3)]
    model = build(arguments.object, palms, arguments.gravity, arguments.mesh_dir)
    data = mujoco.MjData(model)
    start = log["t"][0]
    set_palms(data, palms, start)
    set_start(data, motion)
    errors, sums, parted = [], [], 0
    step = 0
    for k, t in enumerate(log["t"]):
        if t > arguments.until or k >= len(motion["t"]):
            break
        while step < round((t - start) / STEP):
            set_palms(data, palms, start + step * STEP)
            mujoco.mj_step(model, data)
            step += 1
        set_palms(data, palms, t)
        mujoco.mj_forward(model, data)
        if t - start < SETTLING:
            continue
        found = sense(model, data)
        parted += sum(1 for n in found if found[n] is None)
        s = [abs(found[n][a] - log[f"s{a + 1}_{n}"][k]) for n in found if found[n] for a in (0, 1)]
        errors.append((t - start, max(s, default=math.nan)))
        sums.append([(found[n][2] if found[n] else 0.0) - log[f"f_{n}"][k] for n in found])
    width = max(1, round(arguments.average / (log["t"][1] - log["t"][0])))
    forces = np.array(sums)
    forces = np.abs(np.apply_along_axis(np.convolve, 0, forces, np.ones(width) / width, "valid"))
    print(json.dumps({
        "mujoco": mujoco.__version__,
        "mass_kg": float(model.body_mass[model.jnt_bodyid[model.jnt_type == 0]][0]),
        "seconds": errors[-1][0],
        "parted": parted,
        "contact_m": max(e for _, e in errors),
        "force_n": float(forces.max()),
        "force_rms_n": float(np.sqrt((forces**2).mean())),
    }))


if __name__ == "__main__":
    main()
