"""Keywords as words of the command line, which has their limits and says what is wrong with them."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from recon._recon import OptionError

FLAGS = {"concave", "estimate_noise", "identify", "tight", "without_forces"}
"""Options that are set or not."""


def words(**options: Any) -> list[str]:
    """`contact_noise=1e-4` as `--contact-noise=0.0001`; None and False are left out."""
    said = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if name in FLAGS:
            said.extend([option] if flag(name, value) else [])
        elif value is None:
            continue
        elif isinstance(value, (str, os.PathLike)):
            said.append(f"{option}={os.fspath(value)}")
        elif isinstance(value, (list, tuple)):
            said.extend(f"{option}={one}" for one in value)
        else:
            said.append(f"{option}={number(name, value)!r}")
    return said


def flag(name: str, value: Any) -> bool:
    """A value as one of two."""
    if value is not None and not isinstance(value, (bool, np.bool_)):
        raise OptionError(f"{name} is {value!r}; give True or False")
    return bool(value)


def number(name: str, value: Any) -> float:
    """A value as a number with all its digits."""
    try:
        return float(value)
    except (TypeError, ValueError) as error:
        raise OptionError(f"{name} is {value!r}; give a number") from error
