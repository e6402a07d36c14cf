"""Shape, motion, mass and inertia of an unknown convex object, from touch alone.

>>> import recon
>>> result = recon.reconstruct("log.csv", "scene.toml")
>>> result.verdict, result.position[-1], result.mass

Units are SI (m, s, kg, N, rad). The world's z axis points up. Quaternions are stored with the scalar first and turn body axes into
world axes. Arrays that a result holds cannot be written to; copy them to change them.

Start with `reconstruct`. `simulate` makes a log of a known scene, `follow` and `Follower` estimate a motion while it goes on, `bounds`,
`fit` and `plan` (where to touch next) need contact points and normals alone. What goes wrong is a `ReconError`: `InputError` and `OptionError` (both are `ValueError`s),
`OutputError` (an `OSError`) or `FaultError`. Logs in a vertical plane are those of `recon.plane`.
"""

from recon import plane
from recon._bounds import Fit, bounds, fit
from recon._follow import Estimate, Follower, Following, follow
from recon._frames import columns, save, to_frame
from recon._log import log_from_arrays, log_from_contacts, log_from_frame, read_log, scene
from recon._plan import Plan, plan
from recon._recon import (
    Bounds,
    FaultError,
    InputError,
    Log,
    Mesh,
    OptionError,
    OutputError,
    Reconstruction,
    ReconError,
    Scene,
    Simulation,
    __version__,
    check,
)
from recon._reconstruct import reconstruct, simulate

__all__ = [
    "Bounds",
    "Estimate",
    "Fit",
    "FaultError",
    "Follower",
    "Following",
    "InputError",
    "Log",
    "Mesh",
    "OptionError",
    "OutputError",
    "Plan",
    "Reconstruction",
    "ReconError",
    "Scene",
    "Simulation",
    "__version__",
    "bounds",
    "check",
    "columns",
    "fit",
    "follow",
    "log_from_arrays",
    "log_from_contacts",
    "log_from_frame",
    "plan",
    "plane",
    "read_log",
    "reconstruct",
    "save",
    "scene",
    "simulate",
    "to_frame",
]
