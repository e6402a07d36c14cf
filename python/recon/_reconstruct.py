"""From a log to everything it tells, and from a scene to a log."""

from __future__ import annotations

import os
from collections.abc import Callable

from recon._log import LogLike, SceneLike, _scene, log
from recon._recon import Reconstruction, Simulation
from recon._recon import reconstruct as _reconstruct
from recon._recon import simulate as _simulate
from recon._words import words

Progress = Callable[[str], object]


def reconstruct(
    source: LogLike,
    scene: SceneLike,
    *,
    identify: bool = False,
    without_forces: bool = False,
    accuracy: float | None = None,
    mapping: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> Reconstruction:
    """Motion, contact curves, bounds on the shape, and mass and inertia, from a sensor log. No initial guess is needed.

    source: a path (CSV, or a bag of ROS 2 with its `mapping`), a `Log`, a data frame or a dictionary with the columns of the format.
    scene: a path, a dictionary or a `Scene`: gravity, and mass and inertia unless `identify` is set; of palms that are not three
        planes through the origin, what they are (`[[palm]]`); the noise of the sensors, where it is known.
    identify: estimate mass and inertia too, with their standard deviations; those of the scene are not looked at.
    without_forces: use contacts and poses of the palms alone, for an ellipsoid.
    accuracy: that is wanted, with 95 %, root mean square over the log: of the centre of mass in sizes of the object and of its turn in rad. The
        cheapest model that reaches it is chosen; `summary["least_model"]` says what was modelled, what was left out, and what that costs.
    progress: called with the name of each step as it begins; an exception that it raises ends the work.

    The numbers are those of the command `recon reconstruct`, to the last bit. Other Python threads run meanwhile, and Ctrl-C stops the call
    at once (what was begun ends unheard at its next step). A result that is not to be relied on is no error: look at
    `reliable` and `verdict`. Raises InputError where the log gives no estimate at all.
    """
    known = _scene(scene)
    said = words(identify=identify, without_forces=without_forces, accuracy=accuracy)
    return _reconstruct(log(source, known, mapping), known, said, progress)


def simulate(
    scene: SceneLike, *, tolerance: float = 1e-12, report: bool = False, progress: Progress | None = None
) -> Simulation:
    """A sensor log of a known object on palms: the scene has `[simulation]` with shape, start and duration (`recon init` writes one).

    tolerance: of the integration, relative and absolute.
    report: make the page too (`report_html`), of scenes with `[[palm]]` tables.

    Noise is put on the readings where the scene's `[sensors]` state it; the log has the truth beside the readings.
    """
    return _simulate(_scene(scene), words(tolerance=tolerance), report, progress)
