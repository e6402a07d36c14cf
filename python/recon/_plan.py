"""Where to touch a body next, so that its shape is proven with few touches."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from recon._arrays import Array
from recon._bounds import contact_columns
from recon._recon import plan_of_columns, plan_of_file
from recon._reconstruct import Progress
from recon._words import words


@dataclass(frozen=True)
class Plan:
    """Where to touch next, or that nothing is left to touch.

    done: whether the goal is proven; goal: as it was asked for; at_most: what is proven now, in the goal's unit, or None; touches: contacts
    so far; touches_predicted: how many are expected in all, or None.
    along: outward unit normal, (3,) or (2,), of the plane (line) to bring up to the body; ray: ends of a finger's way, (2, 3) or (2, 2), m;
    expected: what the touch is expected to gain (m^3, m^2 or m); why: in words. None where nothing is left to touch.
    summary: all that `recon next` prints.
    """

    done: bool
    goal: str
    at_most: float | None
    touches: int
    touches_predicted: int | None
    along: Array | None
    ray: Array | None
    expected: float | None
    why: str | None
    summary: dict[str, Any]

    def __repr__(self) -> str:
        known = "nothing is proven" if self.at_most is None else f"at most {self.at_most:.4g} is proven"
        state = f"{self.goal}: {known} after {self.touches} touches"
        if self.along is None:
            return f"<recon.Plan of {state}>"
        along = ", ".join(f"{of:.4g}" for of in self.along)
        return f"<recon.Plan of {state}; next along ({along}): {self.why}>"


def plan(
    source: Any,
    normals: ArrayLike | None = None,
    *,
    until: str | None = None,
    planner: str | None = None,
    seed: int | None = None,
    budget: int | None = None,
    contact_noise: float | None = None,
    normal_noise: float | None = None,
    confidence: float | None = None,
    progress: Progress | None = None,
) -> Plan:
    """Where to touch a convex body next, from the contacts so far.

    source: points (n, 3), m, in any one frame of the body, with outward `normals` (n, 3); in the plane (n, 2) both. Or a path (CSV, or a
        folder of `recon explore`, whose goal and settings count where none are given), a data frame or a dictionary of columns.
    until: what is to be proven: `"gap=0.1"` (what is between the bounds over the upper one), `"hausdorff=0.01"` (their largest distance, m)
        or `"width=0.001@0,0,1"` (the width along a direction, to within so many m).
    planner: `"path-aware"` (the default), `"volume"`, `"hausdorff"`, `"gaussian"`, `"sweep"`, `"random"`.
    seed, budget: of what is drawn; touches at most, among which the confidence is shared.
    contact_noise, normal_noise: standard deviations of points (m, per axis) and normals (rad, about each tangent axis); without them
        contacts are exact. confidence: for all touches together (0.95).

    Raises InputError (row from 0, or line) and OptionError.
    """
    said = words(
        until=until,
        planner=planner,
        seed=None if seed is None else str(seed),
        budget=None if budget is None else str(budget),
        contact_noise=contact_noise,
        normal_noise=normal_noise,
        confidence=confidence,
    )
    if isinstance(source, (str, os.PathLike)):
        contact_columns(source, normals)
        told = plan_of_file(source, said, progress)
    else:
        told = plan_of_columns(*contact_columns(source, normals), said, progress)
    action = told.get("action") or {}
    ray = action.get("ray")
    return Plan(
        done=told["done"],
        goal=told["goal"]["until"],
        at_most=told.get("at_most"),
        touches=told["touches"],
        touches_predicted=told.get("touches_predicted"),
        along=np.array(action["along"], dtype=np.float64) if action else None,
        ray=np.array([ray["from_m"], ray["to_m"]], dtype=np.float64) if ray else None,
        expected=action.get("expected"),
        why=action.get("why"),
        summary=told,
    )
