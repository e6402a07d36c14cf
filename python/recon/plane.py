"""Motion and shape in a vertical plane: the functions of `recon`, for scenes with `plane = true`.

>>> from recon import plane
>>> result = plane.reconstruct("log.csv", "scene.toml")
>>> result.verdict, result.position[-1], result.mass

x points to the right, y up; angles are counter-clockwise, in rad. Palms are lines, arcs and cups (`[[palm]]`); a scene without them means
two straight palms hinged at the origin, without friction. Columns are those of planar logs in `recon formats`.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Union

from recon._arrays import columns_of
from recon._log import scene_of
from recon._recon import PlaneLog as Log
from recon._recon import PlaneReconstruction as Reconstruction
from recon._recon import PlaneScene as Scene
from recon._recon import PlaneSimulation as Simulation
from recon._recon import reconstruct_plane as _reconstruct
from recon._recon import simulate_plane as _simulate
from recon._reconstruct import Progress
from recon._words import words

__all__ = ["Log", "Reconstruction", "Scene", "Simulation", "log_from_frame", "read_log", "reconstruct", "scene", "simulate"]

SceneLike = Union[Scene, Mapping[str, Any], str, "os.PathLike[str]", None]


def scene(known: SceneLike = None, /, **keys: Any) -> Scene:
    """What is known beside a log in the plane: from a file, from a dictionary, or from keywords with the keys of a scene file.

    `scene("scene.toml")`; `scene(object={"mass": 0.2, "inertia": 1e-4}, palm=[{"kind": "line", "friction": 0.3}])`. `plane = true` goes
    without saying; gravity is 9.81 m/s^2 where nothing says otherwise. Raises InputError, which names the key.
    """
    return scene_of(Scene, known, keys, plane=True)


def read_log(path: str | os.PathLike[str], scene: SceneLike = None) -> Log:
    """Reads a planar sensor log (CSV) of the palms of the scene. Raises InputError with file, line and column."""
    return Log._read(path, _scene(scene))


def log_from_frame(frame: Any, scene: SceneLike = None) -> Log:
    """A log from a data frame, a dictionary of arrays or a structured array, with the columns of a planar log (`recon formats`).

    Columns are found by name, in any order; others are left alone. Raises InputError with the column and the row, counted from 0.
    """
    names, columns = columns_of(frame)
    return Log._of_columns(names, columns, _scene(scene))


def reconstruct(
    source: Any,
    scene: SceneLike,
    *,
    identify: bool = False,
    accuracy: float | None = None,
    progress: Progress | None = None,
) -> Reconstruction:
    """Motion, mass, moment of inertia and bounds on the outline, from a sensor log in the plane. No initial guess is needed.

    source: a path (CSV), a `Log`, a data frame or a dictionary with the columns of the format.
    scene: a path, a dictionary or a `Scene`: gravity, the shapes of the palms and their friction where it is known, the noise of the sensors
        where it is known; mass and inertia, where they are left out, are estimated.
    identify: estimate mass and inertia too where the scene states them.
    accuracy: that is wanted, with 95 %, root mean square over the log: of the centre of mass in sizes of the object and of its turn in rad. The
        cheapest model that reaches it is chosen; `summary["least_model"]` says what was modelled, what was left out, and what that costs.
    progress: called with the name of each step as it begins; an exception that it raises ends the work.

    The numbers are those of the command `recon reconstruct`, to the last bit. Raises InputError where the log gives no estimate at all.
    """
    known = _scene(scene)
    if isinstance(source, Log):
        log = source
    elif isinstance(source, (str, os.PathLike)):
        log = Log._read(source, known)
    else:
        log = log_from_frame(source, known)
    return _reconstruct(log, known, words(identify=identify, accuracy=accuracy), progress)


def simulate(
    scene: SceneLike, *, tolerance: float = 1e-12, report: bool = False, progress: Progress | None = None
) -> Simulation:
    """A sensor log of a known object on palms in the plane: the scene has `[simulation]`, and a `[[palm]]` for each palm.

    tolerance: of the integration, relative and absolute.
    report: make the page too (`report_html`).
    """
    return _simulate(_scene(scene), words(tolerance=tolerance), report, progress)


def _scene(known: SceneLike) -> Scene:
    return known if isinstance(known, Scene) else scene(known)
