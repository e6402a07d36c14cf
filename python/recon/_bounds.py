"""Bounds on a shape, and shapes fitted to contacts."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from recon._arrays import Array, array, columns_of, numbers, same_length
from recon._recon import Bounds, InputError, Mesh, bounds_of_columns, bounds_of_file
from recon._reconstruct import Progress
from recon._words import words


def bounds(
    source: Any,
    normals: ArrayLike | None = None,
    *,
    curve: ArrayLike | None = None,
    contact_noise: float | None = None,
    normal_noise: float | None = None,
    estimate_noise: bool = False,
    confidence: float | None = None,
    rho_min: float | None = None,
    rho_max: float | None = None,
    fit: str | None = None,
    concave: bool = False,
    alpha: float | None = None,
    surface: str | None = None,
    plane_height: float | None = None,
    height_deviation: float | None = None,
    run_height_deviation: float | None = None,
    tight: bool = False,
    progress: Progress | None = None,
) -> Bounds:
    """What contact points with outward normals, or poses above a plane, guarantee about a convex body.

    source: points (n, 3), m, in any one frame of the object, with `normals` (n, 3); in the plane (n, 2) both. Or a path (CSV), a data
        frame or a dictionary: `x, y, z, nx, ny, nz`, in the plane `x, y, nx, ny`, of poses `qw, qx, qy, qz, px, py, pz`.
    curve: (n,): numbers of the curves along which contacts were traced.
    contact_noise, normal_noise: standard deviations of points (m, per axis) and normals (rad, about each tangent axis); without them
        contacts are taken as exact, unless `estimate_noise` judges them by the roughness of the curves.
    confidence: that of bounds under noise, between 0.5 and 1 (0.95).
    rho_min, rho_max: limits on the radii of curvature, m, which tighten the bounds.
    fit: `"auto"`, `"ball"`, `"ellipsoid"`, `"superquadric"`, `"harmonics:4"`; in the plane `"auto"`, `"circle"`, `"ellipse"`, `"waves:4"`.
    concave, alpha: the body need not be convex; radius of the balls that hollow out the alpha shape, m.
    surface: `"hermite"`, `"spline"` (through exact contacts) or `"principal"` (through the midst of noisy ones): an approximation, no bound.
    plane_height, height_deviation, run_height_deviation, tight: of poses above a plane, m.

    Raises InputError (row from 0, or line) and OptionError.
    """
    said = words(
        contact_noise=contact_noise,
        normal_noise=normal_noise,
        estimate_noise=estimate_noise,
        confidence=confidence,
        rho_min=rho_min,
        rho_max=rho_max,
        fit=fit,
        concave=concave,
        alpha=alpha,
        surface=surface,
        plane_height=plane_height,
        height_deviation=height_deviation,
        run_height_deviation=run_height_deviation,
        tight=tight,
    )
    names, columns = contact_columns(source, normals, curve)
    if isinstance(source, (str, os.PathLike)):
        return bounds_of_file(source, said, progress)
    return bounds_of_columns(names, columns, said, progress)


def contact_columns(source: Any, normals: ArrayLike | None, curve: ArrayLike | None = None) -> tuple[list[str], list[Array]]:
    """Names and columns of contacts: of points with normals, or of a table; of a path none, as its file has them."""
    if isinstance(source, (str, os.PathLike)):
        _alone(normals, curve)
        return [], []
    if normals is None:
        _alone(normals, curve)
        return columns_of(source)
    columns = _contacts(source, normals, curve)
    return list(columns), [np.ascontiguousarray(column) for column in columns.values()]


def _alone(normals: ArrayLike | None, curve: ArrayLike | None) -> None:
    if normals is not None or curve is not None:
        raise InputError("a table or a file has normals and curves of its own; give points (n, 3) where these are given beside them")


def _contacts(points: ArrayLike, normals: ArrayLike, curve: ArrayLike | None) -> dict[str, Array]:
    points = numbers("points", points)
    planar = points.ndim == 2 and points.shape[1] == 2
    axes = "xy" if planar else "xyz"
    p, n = array("points", points, ("n", len(axes))), array("normals", normals, ("n", len(axes)))
    of_curve = None if curve is None else array("curve", curve, ("n",))
    same_length("points", len(p), normals=n, curve=of_curve)
    columns = {axis: p[:, k] for k, axis in enumerate(axes)} | {f"n{axis}": n[:, k] for k, axis in enumerate(axes)}
    return columns if of_curve is None else columns | {"curve": of_curve}


@dataclass(frozen=True)
class Fit:
    """A shape of few parameters, fitted to contacts.

    family: what it is; parameters: names to values; deviations: names to standard deviations, in the same units; covariance: (k, k) in the
    order of the names; residual: root mean square, m; mesh: its surface (in space); outline: its corners (in the plane); summary: all that
    is known; bounds: those of the same contacts.
    """

    family: str
    parameters: dict[str, float]
    deviations: dict[str, float]
    covariance: Array
    residual: float
    mesh: Mesh | None
    outline: Array | None
    summary: dict[str, Any]
    bounds: Bounds

    def __repr__(self) -> str:
        rows = [f"  {name}: {value:.6g} +- {self.deviations[name]:.1e}" for name, value in self.parameters.items()]
        return "\n".join([f"<recon.Fit: {self.family}, rms residual {self.residual:.2e} m", *rows]) + ">"


def fit(source: Any, normals: ArrayLike | None = None, family: str = "auto", **options: Any) -> Fit:
    """The likeliest shape of a family through contacts, or of the family with the smallest information criterion (`"auto"`).

    Takes what `bounds` takes, its noise among it. Raises InputError where contacts refute the family, or all that were tried.
    """
    bounded = bounds(source, normals, fit=family, **options)
    of = bounded.summary["about"]["fit"]
    if of["status"] != "fitted":
        said = "; ".join(bounded.warnings) or str(of)
        raise InputError(f"{said} Take another family, or state the noise (contact_noise, normal_noise) as large as it is.")
    found = {row["name"]: row for row in of["parameters"]}
    return Fit(
        family=of["family"],
        parameters={name: row["value"] for name, row in found.items()},
        deviations={name: row["std"] for name, row in found.items()},
        covariance=np.array(of["covariance"], dtype=np.float64),
        residual=of["residual_m"],
        mesh=bounded.fitted,
        outline=bounded.fitted_outline,
        summary=of,
        bounds=bounded,
    )
