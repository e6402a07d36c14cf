"""Keywords as words of the command line, which has their limits and says what is wrong with them."""

from __future__ import annotations

import os
from typing import Any

from recon._recon import OptionError


def words(**options: Any) -> list[str]:
    """`contact_noise=1e-4` as `--contact-noise=0.0001`; None and False are left out."""
    said = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            said.append(option)
        elif isinstance(value, (str, os.PathLike)):
            said.append(f"{option}={os.fspath(value)}")
        elif isinstance(value, (list, tuple)):
            said.extend(f"{option}={one}" for one in value)
        else:
            said.append(f"{option}={number(name, value)!r}")
    return said


def number(name: str, value: Any) -> float:
    """A value as a number with all its digits."""
    try:
        return float(value)
    except (TypeError, ValueError) as error:
        raise OptionError(f"{name} is {value!r}; give a number") from error
