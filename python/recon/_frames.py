"""Results and logs as tables of other libraries, and as files that these read."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

from recon._arrays import Array
from recon._follow import Following, _columns_of_log
from recon._recon import InputError, Log, Reconstruction

if TYPE_CHECKING:
    import pandas

_MOTION = ["cmx", "cmy", "cmz", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"]


def columns(of: Log | Reconstruction | Following) -> dict[str, Array]:
    """The columns of motion.csv, of the table of `recon follow`, or of a log, by name: SI units, as in `recon formats`."""
    if isinstance(of, Log):
        names, values = _columns_of_log(of)
        return dict(zip(names, values))
    if not isinstance(of, (Reconstruction, Following)):
        raise InputError(f"a {type(of).__name__} has no table; give a Log, a Reconstruction or a Following")
    table: dict[str, Any] = {"t": of.times} | {name: of.motion[:, k] for k, name in enumerate(_MOTION)}
    if isinstance(of, Following):
        names = ["std_cm", "std_v", "std_w", "std_turn"]
        table |= {name: of.deviations[:, k] for k, name in enumerate(names)}
        table |= {"stage": of.stages, "relied_on": of.reliable, "misfit": of.misfit}
        table |= {"mass": of.mass[:, 0], "std_mass": of.mass[:, 1]} | _modes(of)
        return table if of.doubts is None else table | {f"doubt_{i + 1}": of.doubts[:, i] for i in range(of.doubts.shape[1])}
    stds = {"cm": of.position_std, "v": of.velocity_std, "w": of.angular_velocity_std, "turn": of.turn_std}
    for name, std in stds.items():
        table |= {f"std_{name}{axis}": std[:, k] for k, axis in enumerate("xyz")}
    return table | _modes(of) | {"relied_on": of.relied_on}


def _modes(of: Reconstruction | Following) -> dict[str, Array]:
    """Contact modes and their probabilities, where they are told."""
    table: dict[str, Array] = {}
    if of.modes is not None:
        table |= {f"mode_{i + 1}": of.modes[:, i] for i in range(of.modes.shape[1])}
    if of.mode_probabilities is not None:
        for i in range(of.mode_probabilities.shape[1]):
            table |= {f"p_{mode}_{i + 1}": of.mode_probabilities[:, i, k] for k, mode in enumerate(["slide", "stick"])}
    return table


def to_frame(of: Log | Reconstruction | Following) -> pandas.DataFrame:
    """A pandas data frame of `columns`, which needs pandas."""
    import pandas

    return pandas.DataFrame(columns(of))


def save(of: Log | Reconstruction | Following, path: str | os.PathLike[str]) -> None:
    """Writes the columns as `.npz` (NumPy), `.npy` (a structured array), or `.parquet`, which needs pyarrow."""
    ending = os.path.splitext(os.fspath(path))[1].lower()
    table: dict[str, Any] = columns(of)
    if ending == ".npz":
        np.savez(path, **table)
    elif ending == ".npy":
        records = np.empty(len(table["t"]), dtype=[(name, np.asarray(values).dtype) for name, values in table.items()])
        for name, values in table.items():
            records[name] = values
        np.save(path, records)
    elif ending == ".parquet":
        import pyarrow  # type: ignore[import-untyped, unused-ignore]
        import pyarrow.parquet  # type: ignore[import-untyped, unused-ignore]

        pyarrow.parquet.write_table(pyarrow.table({name: pyarrow.array(np.ascontiguousarray(v)) for name, v in table.items()}), path)
    else:
        raise InputError(f"{os.fspath(path)} ends in `{ending}`; give .npz, .npy or .parquet")
