"""The native half of the package; its classes are those of `recon`."""

import os
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

_Array = NDArray[np.float64]
_Path = str | os.PathLike[str]
_Progress = Callable[[str], object] | None
_Row = tuple[float, list[float], list[float], str, bool, float, list[float] | None, list[tuple[int, float, float, str | None]] | None]

__version__: str

class ReconError(Exception):
    """Why recon has no result. The message names the value, the place and the mend."""

class InputError(ReconError, ValueError):
    """A log, a scene or contacts that cannot be used: which value, at which row or line, and what to do."""

class OptionError(ReconError, ValueError):
    """A keyword whose value is not understood, or that does not go with the input."""

class OutputError(ReconError, OSError):
    """A result that cannot be written."""

class FaultError(ReconError, RuntimeError):
    """A fault of recon itself, as where results fail the check at their end."""

class Scene:
    """What is known beside a log: gravity, the object's mass and inertia, palms, and the noise of the sensors."""

    @staticmethod
    def read(path: _Path) -> Scene:
        """Reads a scene file (TOML)."""
    @staticmethod
    def parse(text: str) -> Scene:
        """A scene from TOML text."""
    @staticmethod
    def _of_json(text: str) -> Scene: ...
    @property
    def gravity(self) -> float:
        """Gravity, m/s^2; the world's z axis points up."""
    @property
    def mass(self) -> float | None:
        """Mass of the object, kg, where it is known."""
    @property
    def inertia(self) -> _Array | None:
        """Inertia of the object about its centre of mass, (3, 3), kg m^2, body axes, where it is known."""
    @property
    def palms(self) -> int:
        """Number of palms that the scene describes."""

class Log:
    """A sensor log: what palms with tactile sensors felt, sample by sample."""

    @staticmethod
    def _read(path: _Path, scene: Scene, mapping: _Path | None = None) -> Log: ...
    @staticmethod
    def _of_columns(names: Sequence[str], columns: Sequence[_Array], scene: Scene) -> Log: ...
    @property
    def times(self) -> _Array:
        """Times of the samples, (n,), s."""
    @property
    def palms(self) -> int:
        """Number of palms."""
    @property
    def notes(self) -> list[str]:
        """What was done to a bag, and what the reader must know."""
    def to_csv(self) -> str:
        """The log as CSV text in the columns of the format, which reads back bit for bit."""
    def write(self, path: _Path) -> None:
        """Writes the log as a CSV file, whole or not at all."""
    def __len__(self) -> int: ...

class Simulation:
    """A simulated log, and what is said of it."""

    @property
    def log(self) -> Log:
        """The log, with the truth beside the readings."""
    @property
    def text(self) -> str:
        """What the command says of it."""
    @property
    def summary(self) -> dict[str, Any]:
        """What the command says of it, in numbers."""
    @property
    def is_whole(self) -> bool:
        """Whether it goes on to the end that was asked for."""
    @property
    def report_html(self) -> str | None:
        """The page that shows it (HTML), of scenes with `[[palm]]` tables; else None."""
    def _repr_html_(self) -> str: ...

class Mesh:
    """A surface of triangles."""

    @property
    def vertices(self) -> _Array:
        """Corners, (v, 3), m, body axes."""
    @property
    def triangles(self) -> NDArray[np.uint32]:
        """Numbers of the corners of each triangle, (t, 3), counter-clockwise from outside."""
    @property
    def volume(self) -> float | None:
        """Volume, m^3; None of surfaces that are no bounds."""
    def write(self, path: _Path) -> None:
        """Writes the surface as `.ply` (with all digits), `.stl` or `.glb` (both with seven), m, whole or not at all."""

class Reconstruction:
    """Everything that a log tells. Arrays cannot be written to; parts of the motion share its memory."""

    @property
    def reliable(self) -> bool:
        """Whether the result may be relied on; `verdict` says why or why not."""
    @property
    def is_whole(self) -> bool:
        """Whether everything that was asked for is there and may be relied on: what exit code 0 of the command says."""
    @property
    def verdict(self) -> str:
        """Whether the result may be relied on, in a sentence."""
    @property
    def warnings(self) -> list[str]:
        """What the reader must know."""
    @property
    def text(self) -> str:
        """What the command prints."""
    @property
    def evidence(self) -> list[dict[str, Any]]:
        """What the estimate rests on: dictionaries with key, name, value, unit, level and meaning."""
    @property
    def summary(self) -> dict[str, Any]:
        """What summary.json of the command holds."""
    @property
    def times(self) -> _Array:
        """Times of the motion, (n,), s."""
    @property
    def motion(self) -> _Array:
        """The motion, (n, 13), in the columns of motion.csv: position, orientation (w first), velocity, angular velocity."""
    @property
    def position(self) -> _Array:
        """Centre of mass, (n, 3), m, world axes."""
    @property
    def orientation(self) -> _Array:
        """Orientation, (n, 4), unit quaternions with the scalar first, body to world."""
    @property
    def velocity(self) -> _Array:
        """Velocity of the centre of mass, (n, 3), m/s, world axes."""
    @property
    def angular_velocity(self) -> _Array:
        """Angular velocity, (n, 3), rad/s, world axes."""
    @property
    def position_std(self) -> _Array:
        """Standard deviations of the centre of mass, (n, 3), m, world axes."""
    @property
    def velocity_std(self) -> _Array:
        """Standard deviations of the velocity, (n, 3), m/s, world axes."""
    @property
    def angular_velocity_std(self) -> _Array:
        """Standard deviations of the angular velocity, (n, 3), rad/s, world axes."""
    @property
    def turn_std(self) -> _Array:
        """Standard deviations of the turn since the first sample, (n, 3), rad, world axes."""
    @property
    def pose_covariance(self) -> _Array | None:
        """Covariances of position and turn together, (n, 6, 6), m and rad, world axes; None without forces."""
    @property
    def relied_on(self) -> NDArray[np.bool_]:
        """Whether the motion of a sample is relied on to within its deviations, (n,); of an estimate with one verdict for all samples, that."""
    @property
    def modes(self) -> NDArray[np.uint8] | None:
        """Contact modes, (n, palms): 0 off, 1 slides, 2 sticks; None of three planes without friction."""
    @property
    def mode_probabilities(self) -> NDArray[np.float64] | None:
        """How probable it is that each palm slides and that it sticks, (n, palms, 2), to a millionth; the rest is that it is off. None where it is
        not estimated."""
    @property
    def contacts(self) -> _Array:
        """Where the palms touched the object, (n, palms, 3), m, body axes from the centre of mass; nan where they did not."""
    @property
    def contacts_world(self) -> _Array:
        """The same points in the world, (n, palms, 3), m."""
    @property
    def normals(self) -> _Array:
        """Outward normals there, (n, palms, 3), body axes."""
    @property
    def mass(self) -> float | None:
        """Mass, kg; None without forces."""
    @property
    def mass_std(self) -> float | None:
        """Its standard deviation, kg, where it was estimated."""
    @property
    def inertia(self) -> _Array | None:
        """Inertia about the centre of mass, (3, 3), kg m^2, body axes; None without forces."""
    @property
    def inertia_std(self) -> _Array | None:
        """Standard deviations of its entries, (3, 3), kg m^2, where it was estimated."""
    @property
    def lower_bound(self) -> Mesh | None:
        """Surface of the bound that lies inside of the object; None where there is none."""
    @property
    def upper_bound(self) -> Mesh | None:
        """Surface of the bound that holds the object; None where there is none."""
    @property
    def report_html(self) -> str:
        """The page that the command writes (HTML, which loads nothing)."""
    def write(
        self,
        folder: _Path,
        *,
        export: Sequence[str] = (),
        export_shape: str = "auto",
        mesh: Sequence[str] = (),
        mcap: bool = False,
        covariance: bool = False,
        force: bool = False,
    ) -> None:
        """Writes the folder that the command writes, whole or not at all.

        export: "mjcf", "urdf": the object for simulators, with export_shape "auto", "ellipsoid", "inner" or "outer". mesh: "stl", "glb": the
        bounds in these formats beside PLY. mcap: a bag for Foxglove too. covariance: that of the pose at all samples too. force: write beside files that recon did not write, which are never replaced. Raises OutputError.
        """
    def _repr_html_(self) -> str: ...
    def __len__(self) -> int: ...

class PlaneScene:
    """What is known beside a log in the plane: gravity (along -y), the object's mass and inertia, palms, and the noise of the sensors."""

    @staticmethod
    def read(path: _Path) -> PlaneScene:
        """Reads a scene file (TOML) with `plane = true`."""
    @staticmethod
    def parse(text: str) -> PlaneScene:
        """A scene from TOML text."""
    @staticmethod
    def _of_json(text: str) -> PlaneScene: ...
    @property
    def gravity(self) -> float:
        """Gravity, m/s^2, along -y."""
    @property
    def mass(self) -> float | None:
        """Mass of the object, kg, where it is known."""
    @property
    def inertia(self) -> float | None:
        """Moment of inertia about the centre of mass, kg m^2, where it is known."""
    @property
    def palms(self) -> int:
        """Number of palms; where the scene describes none, they are two hinged ones."""

class PlaneLog:
    """A sensor log in the plane."""

    @staticmethod
    def _read(path: _Path, scene: PlaneScene) -> PlaneLog: ...
    @staticmethod
    def _of_columns(names: Sequence[str], columns: Sequence[_Array], scene: PlaneScene) -> PlaneLog: ...
    @property
    def times(self) -> _Array:
        """Times of the samples, (n,), s."""
    @property
    def palms(self) -> int:
        """Number of palms."""
    def to_csv(self) -> str:
        """The log as CSV text in the columns of version 2, which reads back bit for bit."""
    def write(self, path: _Path) -> None:
        """Writes the log as a CSV file, whole or not at all."""
    def __len__(self) -> int: ...

class PlaneSimulation:
    """A simulated log in the plane, and what is said of it."""

    @property
    def log(self) -> PlaneLog:
        """The log, with the truth beside the readings."""
    @property
    def text(self) -> str:
        """What the command says of it."""
    @property
    def summary(self) -> dict[str, Any]:
        """What the command says of it, in numbers."""
    @property
    def report_html(self) -> str | None:
        """The page that shows it (HTML), where it was asked for; else None."""
    def _repr_html_(self) -> str: ...

class PlaneReconstruction:
    """Everything that a log in the plane tells."""

    @property
    def reliable(self) -> bool:
        """Whether the result may be relied on; `verdict` says why or why not."""
    @property
    def verdict(self) -> str:
        """Whether the result may be relied on, in a sentence."""
    @property
    def warnings(self) -> list[str]:
        """What the reader must know."""
    @property
    def text(self) -> str:
        """What the command prints."""
    @property
    def evidence(self) -> list[dict[str, Any]]:
        """What the estimate rests on: dictionaries with key, name, value, unit, level and meaning."""
    @property
    def summary(self) -> dict[str, Any]:
        """What summary.json of the command holds."""
    @property
    def times(self) -> _Array:
        """Times of the motion, (n,), s."""
    @property
    def motion(self) -> _Array:
        """The motion, (n, 6), in the columns of motion.csv: place, orientation, velocity, angular velocity."""
    @property
    def position(self) -> _Array:
        """Centre of mass, (n, 2), m."""
    @property
    def orientation(self) -> _Array:
        """Orientation, (n,), rad, counter-clockwise from the first sample."""
    @property
    def velocity(self) -> _Array:
        """Velocity of the centre of mass, (n, 2), m/s."""
    @property
    def angular_velocity(self) -> _Array:
        """Angular velocity, (n,), rad/s."""
    @property
    def position_std(self) -> _Array:
        """Standard deviations of the centre of mass, (n, 2), m."""
    @property
    def turn_std(self) -> _Array:
        """Standard deviations of the turn since the first sample, (n,), rad."""
    @property
    def velocity_std(self) -> _Array:
        """Standard deviations of the velocity, (n, 2), m/s."""
    @property
    def angular_velocity_std(self) -> _Array:
        """Standard deviations of the angular velocity, (n,), rad/s."""
    @property
    def pose_covariance(self) -> _Array:
        """Covariances of position and turn together, (n, 3, 3), m and rad."""
    @property
    def relied_on(self) -> NDArray[np.bool_]:
        """Whether the motion of a sample is relied on to within its deviations, (n,), bool."""
    @property
    def modes(self) -> NDArray[np.uint8]:
        """Contact modes, (n, palms), uint8: 0 off, 1 slides, 2 sticks."""
    @property
    def contacts(self) -> _Array:
        """Where the palms touched the object, (n, palms, 2), m, body axes from the centre of mass; nan where they did not."""
    @property
    def normals(self) -> _Array:
        """Outward normals there, (n, palms, 2), body axes."""
    @property
    def mass(self) -> float:
        """Mass, kg."""
    @property
    def mass_std(self) -> float | None:
        """Its standard deviation, kg, where it was estimated."""
    @property
    def inertia(self) -> float:
        """Moment of inertia about the centre of mass, kg m^2."""
    @property
    def inertia_std(self) -> float | None:
        """Its standard deviation, kg m^2, where it was estimated."""
    @property
    def areas(self) -> list[float] | None:
        """Areas of the lower and the upper bound, m^2, of which the second is inf where a side is open; None where there are no bounds."""
    @property
    def outlines(self) -> list[_Array] | None:
        """Corners of the lower and the upper bound, (n, 2) and (m, 2), m, world axes of the first sample from the centre of mass; None where there are no bounds."""
    @property
    def report_html(self) -> str:
        """The page that the command writes (HTML, which loads nothing)."""
    def write(self, folder: _Path, *, covariance: bool = False, force: bool = False) -> None:
        """Writes the folder that the command writes, whole or not at all; covariance: that of the pose at all samples too; force: write beside files that
        recon did not write. Raises OutputError."""
    def _repr_html_(self) -> str: ...
    def __len__(self) -> int: ...

class Bounds:
    """What contacts or poses guarantee about a shape."""

    @property
    def is_whole(self) -> bool:
        """Whether both bounds are there, do not contradict each other, and a fit was not refused."""
    @property
    def warnings(self) -> list[str]:
        """What the reader must know."""
    @property
    def text(self) -> str:
        """What the command prints."""
    @property
    def summary(self) -> dict[str, Any]:
        """What summary.json of the command holds."""
    @property
    def lower_volume(self) -> float | None:
        """Volume of the lower bound, m^3; None in the plane."""
    @property
    def upper_volume(self) -> float | None:
        """Volume of the upper bound, m^3; None in the plane, or where there is none."""
    @property
    def areas(self) -> list[float] | None:
        """Areas of the lower and the upper bound, m^2; None in space. The second is inf where a side is open."""
    @property
    def largest_gap(self) -> float | None:
        """Largest distance between the bounds, m."""
    @property
    def lower_bound(self) -> Mesh | None:
        """Surface of the bound that lies inside of the object, in space."""
    @property
    def upper_bound(self) -> Mesh | None:
        """Surface of the bound that holds the object, in space."""
    @property
    def outlines(self) -> list[_Array] | None:
        """Corners of the lower and the upper bound in the plane, (n, 2) and (m, 2), m; None in space."""
    @property
    def fitted_outline(self) -> _Array | None:
        """Corners of the fitted outline in the plane, (n, 2), m; None where there is none."""
    @property
    def fitted(self) -> Mesh | None:
        """Surface of the fitted shape, in space; None where none was asked for, or the contacts refute it."""
    @property
    def alpha_shape(self) -> Mesh | None:
        """Alpha shape of a body that need not be convex; an approximation."""
    @property
    def smooth_surface(self) -> Mesh | None:
        """Smooth surface of the kind that was asked for, or of a body that need not be convex; an approximation."""
    def write(self, folder: _Path, *, mesh: Sequence[str] = (), force: bool = False) -> None:
        """Writes the folder that the command writes; `mesh` names formats beside PLY ("stl", "glb"), `force` writes beside files that recon
        did not write."""

class Follower:
    def __init__(self, names: Sequence[str], scene: Scene, words: Sequence[str]) -> None: ...
    def push(self, row: Sequence[float]) -> list[_Row]: ...
    def push_array(self, row: _Array) -> list[_Row]: ...
    def push_all(self, rows: _Array, width: int) -> list[_Row]: ...
    def finish(self) -> list[_Row]: ...
    def left_out(self) -> tuple[int, str | None]: ...

def simulate(scene: Scene, words: Sequence[str], report: bool, progress: _Progress = None) -> Simulation: ...
def reconstruct(log: Log, scene: Scene, words: Sequence[str], progress: _Progress = None) -> Reconstruction: ...
def simulate_plane(scene: PlaneScene, words: Sequence[str], report: bool, progress: _Progress = None) -> PlaneSimulation: ...
def reconstruct_plane(log: PlaneLog, scene: PlaneScene, words: Sequence[str], progress: _Progress = None) -> PlaneReconstruction: ...
def bounds_of_columns(
    names: Sequence[str], columns: Sequence[_Array], words: Sequence[str], progress: _Progress = None
) -> Bounds: ...
def bounds_of_file(path: _Path, words: Sequence[str], progress: _Progress = None) -> Bounds: ...
def plan_of_columns(
    names: Sequence[str], columns: Sequence[_Array], words: Sequence[str], progress: _Progress = None
) -> dict[str, Any]: ...
def plan_of_file(path: _Path, words: Sequence[str], progress: _Progress = None) -> dict[str, Any]: ...
def main(args: Sequence[str]) -> int: ...
def check(folder: _Path) -> list[str]:
    """Checks a folder of results by its files alone; returns what held. Raises InputError."""
