"""The motion sample by sample, as it becomes known."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from io import StringIO
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from recon import _recon
from recon._arrays import Array, columns_of, numbers
from recon._log import LogLike, SceneLike, _scene, log
from recon._recon import InputError, Log
from recon._words import words


class Estimate(NamedTuple):
    """What is known of the motion at one sample; numbers are nan before a motion is found.

    t: s. position: (x, y, z) of the centre of mass, m, world axes. orientation: quaternion, scalar first, body to world. velocity: m/s and
    angular_velocity: rad/s, world axes. The std_* are standard deviations of all axes together (m, rad, m/s, rad/s). stage is "gathering",
    "searching", "tracking" or "contradicted"; reliable says whether the motion is relied on to within its deviations. misfit is about 1 where
    all is as stated. mass and std_mass (kg) where they are estimated.

    Of palms with friction, None before a motion is found and where no palm has any: modes has the contact mode to act on for each palm (0 off, 1
    slides, 2 sticks), mode_probabilities (slide, stick) for each, doubts what contradicts its readings, in a word, or None.
    """

    t: float
    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float]
    velocity: tuple[float, float, float]
    angular_velocity: tuple[float, float, float]
    std_position: float
    std_velocity: float
    std_angular_velocity: float
    std_turn: float
    stage: str
    reliable: bool
    misfit: float
    mass: float
    std_mass: float
    modes: tuple[int, ...] | None
    mode_probabilities: tuple[tuple[float, float], ...] | None
    doubts: tuple[str | None, ...] | None


def _estimate(row: tuple[Any, ...]) -> Estimate:
    t, motion, deviations, stage, reliable, misfit, mass, told = row
    mass, std_mass = mass or (float("nan"), float("nan"))
    x, y, z, qw, qx, qy, qz, vx, vy, vz, wx, wy, wz = motion
    std_position, std_velocity, std_angular_velocity, std_turn = deviations
    return Estimate(
        t=t,
        position=(x, y, z),
        orientation=(qw, qx, qy, qz),
        velocity=(vx, vy, vz),
        angular_velocity=(wx, wy, wz),
        std_position=std_position,
        std_velocity=std_velocity,
        std_angular_velocity=std_angular_velocity,
        std_turn=std_turn,
        stage=stage,
        reliable=reliable,
        misfit=misfit,
        mass=mass,
        std_mass=std_mass,
        modes=None if told is None else tuple(mode for mode, *_ in told),
        mode_probabilities=None if told is None else tuple((slide, stick) for _, slide, stick, _ in told),
        doubts=None if told is None else tuple(doubt for *_, doubt in told),
    )


class Follower:
    """Follows a motion while a robot makes it: push each sample, and know the motion.

    >>> follower = recon.Follower(columns, "scene.toml", rate=1000.0, contact_noise=1e-4, force_noise=0.01)
    >>> estimate = follower.push(row)

    columns: names of the log's columns in the order in which rows have them (`recon formats`): of three planes through the origin, or of
        any palms that the scene has.
    scene: gravity, and mass and inertia unless `identify` is set.
    rate: samples a second; else taken from the first 21 samples.
    contact_noise: standard deviation of a contact in each tangent direction, m; force_noise: of a force, N; else those of the scene.
        

    The first 21 samples are held back, from which the size of what is touched is seen; of three planes each sample waits for the next. A push takes
    microseconds; what takes longer is computed on a thread of its own. Raises InputError and OptionError.
    """

    def __init__(
        self,
        columns: Sequence[str],
        scene: SceneLike,
        *,
        rate: float | None = None,
        identify: bool = False,
        contact_noise: float | None = None,
        force_noise: float | None = None,
    ) -> None:
        said = words(rate=rate, identify=identify, contact_noise=contact_noise, force_noise=force_noise)
        self._follower = _recon.Follower([str(name) for name in columns], _scene(scene), said)
        self._columns = list(columns)
        self._latest: Estimate | None = None

    @property
    def latest(self) -> Estimate | None:
        """The newest estimate; None before the first."""
        return self._latest

    @property
    def left_out(self) -> tuple[int, str | None]:
        """How many samples could not be used, and what was wrong with the first of them."""
        return self._follower.left_out()

    def push(self, row: Sequence[float] | Array) -> Estimate | None:
        """Takes a sample, (columns,), in the order of the columns; returns the newest estimate, None before the first.

        Raises InputError, which names the row (from 0) and the column; the next row may be pushed all the same.
        """
        if isinstance(row, np.ndarray):
            if row.ndim != 1 or row.dtype != np.float64:
                raise InputError(f"the row has the shape {row.shape} and holds {row.dtype}; give ({len(self._columns)},) of float64")
            made = self._follower.push_array(row)
        else:
            try:
                made = self._follower.push(row)
            except TypeError as error:
                raise InputError(f"the row is no sequence of numbers: {error}; give {len(self._columns)} numbers") from error
        return self._take(made)

    def push_all(self, rows: Array) -> list[Estimate]:
        """Takes many samples, (n, columns); returns all estimates that they make known."""
        rows = numbers("rows", rows)
        if rows.ndim != 2:
            raise InputError(f"the rows have the shape {rows.shape}; give (n, {len(self._columns)})")
        made = [_estimate(row) for row in self._follower.push_all(rows, rows.shape[1])]
        self._latest = made[-1] if made else self._latest
        return made

    def finish(self) -> list[Estimate]:
        """Says that no sample will come; returns the estimates that were held back."""
        made = [_estimate(row) for row in self._follower.finish()]
        self._latest = made[-1] if made else self._latest
        return made

    def _take(self, made: list[tuple[Any, ...]]) -> Estimate | None:
        if made:
            self._latest = _estimate(made[-1])
        return self._latest

    def __repr__(self) -> str:
        said = "no estimate yet" if self._latest is None else f"{self._latest.stage} at t = {self._latest.t:.6g} s"
        return f"<recon.Follower of {len(self._columns)} columns: {said}>"


@dataclass(frozen=True, repr=False)
class Following:
    """How a motion became known over a whole log: arrays over its samples, with the units of `Estimate`.

    times: (n,). motion: (n, 13): position, orientation (scalar first), velocity, angular velocity. deviations: (n, 4): of position,
    velocity, angular velocity, turn. stages: (n,), text. reliable: (n,), bool. misfit: (n,). mass: (n, 2), kg, with its deviation.
    modes: (n, palms), the contact modes to act on (0 off, 1 slides, 2 sticks), nan before a motion is found; mode_probabilities: (n, palms, 2), to slide
    and to stick; doubts: (n, palms), text, "none" where nothing is doubted. All three None where no palm has friction.
    left_out: how many samples could not be used, and why the first of them.
    """

    times: Array
    motion: Array
    deviations: Array
    stages: NDArray[np.str_]
    reliable: NDArray[np.bool_]
    misfit: Array
    mass: Array
    modes: Array | None
    mode_probabilities: Array | None
    doubts: NDArray[np.str_] | None
    left_out: tuple[int, str | None]

    @property
    def position(self) -> Array:
        """Centre of mass, (n, 3), m, world axes."""
        return self.motion[:, 0:3]

    @property
    def orientation(self) -> Array:
        """Unit quaternions, (n, 4), scalar first, body to world."""
        return self.motion[:, 3:7]

    @property
    def velocity(self) -> Array:
        """Velocity of the centre of mass, (n, 3), m/s, world axes."""
        return self.motion[:, 7:10]

    @property
    def angular_velocity(self) -> Array:
        """(n, 3), rad/s, world axes."""
        return self.motion[:, 10:13]

    @property
    def found(self) -> float | None:
        """When the motion was relied on first, s; None if it never was."""
        return float(self.times[self.reliable][0]) if self.reliable.any() else None

    def __repr__(self) -> str:
        known = f"known first at t = {self.found:.6g} s, at {self.reliable.mean():.1%} of the samples" if self.reliable.any() else "never known"
        return f"<recon.Following of {len(self.times)} samples: {known}>"


def follow(
    source: LogLike,
    scene: SceneLike,
    *,
    rate: float | None = None,
    identify: bool = False,
    contact_noise: float | None = None,
    force_noise: float | None = None,
) -> Following:
    """Follows the motion over a whole log, sample by sample, as `Follower` does: what would have been known when.

    Takes what `reconstruct` takes. The numbers are those of `recon follow --every 0`, to the last bit.
    """
    known = _scene(scene)
    if isinstance(source, Log) or not (hasattr(source, "columns") or isinstance(source, dict)):
        made = log(source, known)
        names, columns = _columns_of_file(source, made) if isinstance(source, (str, os.PathLike)) else _columns_of_log(made)
    else:
        names, columns = columns_of(source)
    follower = Follower(names, known, rate=rate, identify=identify, contact_noise=contact_noise, force_noise=force_noise)
    rows = follower.push_all(np.column_stack(columns)) + follower.finish()
    palms = max((len(row.modes) for row in rows if row.modes is not None), default=0)
    unknown = (float("nan"),) * palms
    modes = [unknown if row.modes is None else row.modes for row in rows]
    odds = [[(float("nan"),) * 2] * palms if row.mode_probabilities is None else row.mode_probabilities for row in rows]
    doubts = [["none"] * palms if row.doubts is None else [doubt or "none" for doubt in row.doubts] for row in rows]
    return Following(
        times=np.array([row.t for row in rows]),
        motion=np.array([[*row.position, *row.orientation, *row.velocity, *row.angular_velocity] for row in rows]).reshape(-1, 13),
        deviations=np.array([row[5:9] for row in rows], dtype=np.float64).reshape(-1, 4),
        stages=np.array([row.stage for row in rows], dtype=np.str_),
        reliable=np.array([row.reliable for row in rows], dtype=np.bool_),
        misfit=np.array([row.misfit for row in rows]),
        mass=np.array([row[12:14] for row in rows], dtype=np.float64).reshape(-1, 2),
        modes=np.array(modes, dtype=np.float64) if palms else None,
        mode_probabilities=np.array(odds, dtype=np.float64) if palms else None,
        doubts=np.array(doubts, dtype=np.str_) if palms else None,
        left_out=follower.left_out,
    )


def _columns_of_file(path: str | os.PathLike[str], made: Log) -> tuple[list[str], list[Array]]:
    """Names and columns of a log's file as they stand there: what was read has unit vectors whose last digits may be others."""
    try:
        with open(path, encoding="utf-8-sig") as file:
            names = [name.strip() for name in file.readline().split(",")]
            values = np.loadtxt(file, delimiter=",", ndmin=2)
    except ValueError:
        # A bag, or columns that are no numbers, which a log may have beside its own.
        return _columns_of_log(made)
    return names, list(np.ascontiguousarray(values.T))


def _columns_of_log(made: Log) -> tuple[list[str], list[Array]]:
    """Names and columns of a log."""
    text = made.to_csv()
    names = text[: text.index("\n")].split(",")
    values = np.loadtxt(StringIO(text), delimiter=",", skiprows=1, ndmin=2)
    return names, list(np.ascontiguousarray(values.T))
