"""Scenes and logs, from whatever holds them."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any, TypeVar, Union

import numpy as np
from numpy.typing import ArrayLike

from recon._arrays import Array, array, columns_of, numbers, same_length
from recon._recon import InputError, Log, PlaneScene, Scene

SceneLike = Union[Scene, Mapping[str, Any], str, "os.PathLike[str]", None]
_S = TypeVar("_S", Scene, PlaneScene)
LogLike = Union[Log, str, "os.PathLike[str]", Any]


def scene(known: SceneLike = None, /, **keys: Any) -> Scene:
    """What is known beside a log: from a file, from a dictionary, or from keywords with the keys of a scene file.

    `scene("scene.toml")`; `scene(gravity=9.81, object={"mass": 1.0, "principal_moments": [1.0, 1.45, 2.05]})`;
    `scene(gravity=9.81, sensors={"contact_std": 1e-4, "force_std": 0.01})`. Keywords replace keys of a dictionary. What is
    left out is unknown; gravity is 9.81 m/s^2 where nothing says otherwise. `docs/formats.md` has the keys, in SI units.

    Raises InputError, which names the key.
    """
    return scene_of(Scene, known, keys)


def scene_of(kind: type[_S], known: Any, keys: Mapping[str, Any], **defaults: Any) -> _S:
    """A scene of space or of the plane."""
    if isinstance(known, kind):
        if keys:
            raise InputError("a scene that is made takes no keys; give a dictionary and keys, or all of it by keys")
        return known
    if isinstance(known, (str, os.PathLike)):
        if keys:
            raise InputError("a scene file takes no keys beside it; write them into the file, or give all of it by keys")
        return kind.read(known)
    if known is not None and not isinstance(known, Mapping):
        raise InputError(f"a {type(known).__name__} is no scene; give a path, a dictionary or a {kind.__module__}.Scene")
    stated = {**defaults, "gravity": 9.81, **(known or {}), **keys}
    try:
        text = json.dumps(stated, default=_plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise InputError(f"the scene holds what is no number, text, list or dictionary: {error}") from error
    return kind._of_json(text)


def _plain(value: Any) -> Any:
    """Arrays and numbers of NumPy, and paths, as what a file can say."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"{value!r} of type {type(value).__name__}")


def read_log(path: str | os.PathLike[str], scene: SceneLike = None, *, mapping: str | os.PathLike[str] | None = None) -> Log:
    """Reads a sensor log: CSV (version 1 or 2), or a bag of ROS 2 (MCAP) by its `mapping` (TOML).

    A log of version 2 needs the palms of the scene. Raises InputError with file, line and column.
    """
    return Log._read(path, _scene(scene), mapping)


def log_from_frame(frame: Any, scene: SceneLike = None) -> Log:
    """A log from a data frame, a dictionary of arrays or a structured array, with the columns of the format (`recon formats`).

    Columns are found by name, in any order; others are left alone. Raises InputError with the column and the row, counted from 0.
    """
    names, columns = columns_of(frame)
    return Log._of_columns(names, columns, _scene(scene))


def log_from_arrays(
    t: ArrayLike,
    contacts: ArrayLike,
    normals: ArrayLike,
    forces: ArrayLike | None = None,
    *,
    torques: ArrayLike | None = None,
    rates: ArrayLike | None = None,
) -> Log:
    """A log of three flat palms through the origin of the world (version 1).

    t: (n,), s, strictly increasing.
    contacts: (n, 3, 2), m: s1 and s2 of each palm in its own frame, `c = s1 t1 + s2 t2`; nan while there is no contact.
    normals: (n, 3, 3): unit normals of the palms, world axes, towards the object.
    forces: (n, 3), N: sizes of the normal forces; 0 or nan without contact.
    torques: (n, 3), N m: of the palms' motors about t1.
    rates: (n, 3), rad/s: of rotation about t1; taken from the normals where they are not given.

    The horizontal t1 and the upward t2 of a palm follow from its normal: `t1 = t2 x n`.
    """
    times = array("t", t, ("n",))
    s, n = array("contacts", contacts, ("n", 3, 2)), array("normals", normals, ("n", 3, 3))
    by_stem = {"f": ("forces", forces), "tau": ("torques", torques), "rate": ("rates", rates)}
    given = {stem: array(name, values, ("n", 3)) for stem, (name, values) in by_stem.items() if values is not None}
    same_length("t", len(times), contacts=s, normals=n, **{by_stem[stem][0]: values for stem, values in given.items()})
    columns: dict[str, Array] = {"t": times}
    for i in range(3):
        columns |= {f"s{k + 1}_{i + 1}": s[:, i, k] for k in range(2)}
        columns |= {f"n{axis}_{i + 1}": n[:, i, k] for k, axis in enumerate("xyz")}
        columns |= {f"{stem}_{i + 1}": values[:, i] for stem, values in given.items()}
    return _of(columns, Scene.parse("gravity = 9.81"))


def log_from_contacts(
    t: ArrayLike,
    contacts: ArrayLike,
    forces: ArrayLike,
    scene: SceneLike,
    *,
    poses: ArrayLike | None = None,
    twists: ArrayLike | None = None,
    impulses: ArrayLike | None = None,
    in_palm_axes: bool = False,
) -> Log:
    """A log of palms of any number, shape, pose and motion (version 2); the scene has a `[[palm]]` for each.

    t: (n,), s, strictly increasing.
    contacts: (n, p, 3), m: contact points in the world, or with `in_palm_axes` in the palms' frames; nan without contact.
    forces: (n, p, 3), N: on the object, world axes; or (n, p): along the palms' normals. 0 or nan without contact.
    poses: (n, p, 7), m and 1: origins of the palms' frames in the world, then quaternions (scalar first, palm to world); may be left out
        where the scene has them.
    twists: (n, p, 6), m/s and rad/s: velocities of these origins, then angular velocities, world axes.
    impulses: (n, p, 3), N s: integrals of the forces since one time for the whole log.
    """
    times, points = array("t", t, ("n",)), array("contacts", contacts, ("n", "palms", 3))
    palms = points.shape[1]
    forces = numbers("forces", forces)
    force = array("forces", forces, ("n", palms) if forces.ndim == 2 else ("n", palms, 3))
    groups: dict[str, tuple[Array, list[str]]] = {
        "contacts": (points, [("s" if in_palm_axes else "p") + axis for axis in "xyz"]),
        "forces": (force[..., None], ["fn"]) if force.ndim == 2 else (force, ["fx", "fy", "fz"]),
    }
    more = {
        "poses": (poses, ["Px", "Py", "Pz", "Qw", "Qx", "Qy", "Qz"]),
        "twists": (twists, ["Vx", "Vy", "Vz", "Wx", "Wy", "Wz"]),
        "impulses": (impulses, ["Jx", "Jy", "Jz"]),
    }
    for name, (values, stems) in more.items():
        if values is not None:
            groups[name] = (array(name, values, ("n", palms, len(stems))), stems)
    same_length("t", len(times), **{name: values for name, (values, _) in groups.items()})
    columns: dict[str, Array] = {"t": times}
    for values, stems in groups.values():
        columns |= {f"{stem}_{i + 1}": values[:, i, k] for i in range(palms) for k, stem in enumerate(stems)}
    return _of(columns, _scene(scene))


def _of(columns: dict[str, Array], known: Scene) -> Log:
    return Log._of_columns(list(columns), [np.ascontiguousarray(column) for column in columns.values()], known)


def _scene(known: SceneLike) -> Scene:
    return known if isinstance(known, Scene) else scene(known)


def log(source: LogLike, known: Scene, mapping: str | os.PathLike[str] | None = None) -> Log:
    """A log from whatever holds it: a log, a path, or a table of named columns."""
    if isinstance(source, Log):
        return source
    if isinstance(source, (str, os.PathLike)):
        return Log._read(source, known, mapping)
    return log_from_frame(source, known)
