"""What callers give, as arrays of numbers, or an error that says which of it is none."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from recon._recon import InputError

Array = NDArray[np.float64]


def array(name: str, values: ArrayLike, shape: tuple[int | str, ...]) -> Array:
    """`values` as numbers of a shape; a letter in it is a length that is free, but the same wherever it stands in one call."""
    made = numbers(name, values)
    fits = made.ndim == len(shape) and all(isinstance(want, str) or want == has for want, has in zip(shape, made.shape))
    if not fits:
        wanted = "(" + ", ".join(str(length) for length in shape) + ("," if len(shape) == 1 else "") + ")"
        raise InputError(f"{name} has the shape {made.shape}; give an array of shape {wanted}")
    return made


def numbers(name: str, values: ArrayLike) -> Array:
    """`values` as numbers, which neither text, truth values nor complex numbers are; what is masked was not measured."""
    try:
        made = np.asarray(values)
        if isinstance(values, np.ma.MaskedArray) and made.dtype.kind in "fiu":
            made = values.astype(np.float64).filled(np.nan)
    except ValueError as error:
        raise InputError(f"{name} is no array ({error}); give rows of one length") from error
    if made.dtype.kind not in "fiu":
        if made.dtype.kind != "O":
            raise InputError(f"{name} holds {made.dtype} values; give real numbers")
        try:
            made = made.astype(np.float64)
        except (TypeError, ValueError) as error:
            raise InputError(f"{name} holds what is no number ({error}); give real numbers, and nan for what was not measured") from error
    return np.ascontiguousarray(made, dtype=np.float64)


def same_length(first: str, length: int, **arrays: Array | None) -> None:
    """Raises where one of the arrays has another number of rows than the first."""
    for name, values in arrays.items():
        if values is not None and len(values) != length:
            raise InputError(f"{name} has {len(values)} rows where {first} has {length}; give one for each sample")


def columns_of(frame: Any) -> tuple[list[str], list[Array]]:
    """Names and columns of a data frame (pandas, polars), a structured array, or a dictionary."""
    names: list[Any]
    if isinstance(frame, np.ndarray) and frame.dtype.names:
        names = list(frame.dtype.names)
    elif isinstance(frame, Mapping):
        names = list(frame)
    elif hasattr(frame, "columns") and hasattr(frame, "__getitem__"):
        names = list(frame.columns)
    elif hasattr(frame, "column_names") and hasattr(frame, "column"):  # pyarrow
        return list(frame.column_names), [column(name, frame.column(name).to_numpy()) for name in frame.column_names]
    else:
        raise InputError(
            f"a value of type {type(frame).__name__} is no table of named columns; give a data frame, a dictionary of arrays, a path or a recon.Log"
        )
    return [str(name) for name in names], [column(str(name), frame[name]) for name in names]


def column(name: str, values: Any) -> Array:
    """One column, without an index of its own."""
    made = values.to_numpy() if hasattr(values, "to_numpy") else values
    return array(f"column `{name}`", made, ("n",))
