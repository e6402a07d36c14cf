#!/usr/bin/env python3
"""Loads models of one object each (MJCF or URDF) in a simulator and prints as JSON, a line for each, what was taken in: mass, centre of
mass and inertia about it in the axes of the body, how far what collides reaches along ten directions (all as words), and what the loader warns of.

    load.py mujoco|drake BODY MODEL..

Needs NumPy, and MuJoCo or Drake (the package `drake`).
"""

import json
import sys

import numpy as np

# Directions in which the extent of a shape is taken: the axes of the body and two oblique ones.
DIRECTIONS = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1], [-1, 2, 0.5]], dtype=float)
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1)[:, None]


def reach(points):
    """How far points reach along the directions and against them."""
    along = np.asarray(points) @ DIRECTIONS.T
    return np.concatenate((along.max(axis=0), -along.min(axis=0))).tolist()


def reach_of_ellipsoid(centre, rotation, semi_axes):
    half = np.linalg.norm(DIRECTIONS @ rotation * semi_axes, axis=1)
    middle = DIRECTIONS @ centre
    return np.concatenate((middle + half, half - middle)).tolist()


def in_mujoco(path, body):
    import mujoco

    spec = mujoco.MjSpec.from_file(path)
    # What a URDF does not say: that its root is free to move.
    if not spec.body(body).joints:
        spec.body(body).add_freejoint()
    model = spec.compile()
    index = model.body(body).id
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, model.body_iquat[index])
    turn = turn.reshape(3, 3)
    found = {
        "version": mujoco.__version__,
        "mass": model.body_mass[index],
        "centre": model.body_ipos[index].tolist(),
        "inertia": (turn * model.body_inertia[index] @ turn.T).tolist(),
        "warnings": [],
    }
    colliding = [g for g in range(model.ngeom) if model.geom_bodyid[g] == index and model.geom_contype[g]]
    found["colliding"] = len(colliding)
    for geom in colliding:
        at = np.zeros(9)
        mujoco.mju_quat2Mat(at, model.geom_quat[geom])
        at = at.reshape(3, 3)
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
            found["reach"] = reach_of_ellipsoid(model.geom_pos[geom], at, model.geom_size[geom])
        else:
            mesh = model.geom_dataid[geom]
            first = model.mesh_vertadr[mesh]
            points = model.mesh_vert[first:first + model.mesh_vertnum[mesh]]
            found["reach"] = reach(points @ at.T + model.geom_pos[geom])
    return found


def in_drake(path, body):
    import logging

    from importlib.metadata import version

    from pydrake.geometry import Convex, Ellipsoid, Mesh, SceneGraph
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant

    warnings = []

    class Keep(logging.Handler):
        def emit(self, record):
            warnings.append(record.getMessage())

    keep, log = Keep(), logging.getLogger("drake")
    log.addHandler(keep)
    plant, scene = MultibodyPlant(0.0), SceneGraph()
    plant.RegisterAsSourceForSceneGraph(scene)
    Parser(plant).AddModels(path)
    plant.Finalize()
    log.removeHandler(keep)
    link = plant.GetBodyByName(body)
    context = plant.CreateDefaultContext()
    inertia = link.CalcSpatialInertiaInBodyFrame(context)
    found = {
        "version": version("drake"),
        "mass": inertia.get_mass(),
        "centre": inertia.get_com().tolist(),
        "inertia": inertia.Shift(inertia.get_com()).CalcRotationalInertia().CopyToFullMatrix3().tolist(),
        "free": link.is_floating_base_body(),
        "warnings": warnings,
    }
    shapes = plant.GetCollisionGeometriesForBody(link)
    found["colliding"] = len(shapes)
    for shape in shapes:
        inspector = scene.model_inspector()
        pose, of = inspector.GetPoseInFrame(shape), inspector.GetShape(shape)
        rotation, centre = pose.rotation().matrix(), pose.translation()
        if isinstance(of, Ellipsoid):
            found["reach"] = reach_of_ellipsoid(centre, rotation, np.array([of.a(), of.b(), of.c()]))
        elif isinstance(of, (Convex, Mesh)):
            hull = of.GetConvexHull()
            points = np.array([hull.vertex(k) for k in range(hull.num_vertices())])
            found["reach"] = reach(points @ rotation.T + centre)
    return found


def words(value):
    """Numbers as words: not every reader of JSON keeps the last digit."""
    if isinstance(value, dict):
        return {key: words(of) for key, of in value.items()}
    if isinstance(value, list):
        return [words(of) for of in value]
    return repr(float(value)) if isinstance(value, float) else value


def main():
    loader, body, *paths = sys.argv[1:]
    load = {"mujoco": in_mujoco, "drake": in_drake}[loader]
    for path in paths:
        print(json.dumps(words(load(path, body))))


if __name__ == "__main__":
    main()
