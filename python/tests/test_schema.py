"""Summaries keep the committed JSON schema, by a validator of others."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

import recon
from conftest import ROOT
from recon import plane
from test_plane import KNOWN, SCENE

jsonschema = pytest.importorskip("jsonschema")
SCHEMA: dict[str, Any] = json.loads((ROOT / "docs" / "schema" / "summary.schema.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def validator() -> Any:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    return jsonschema.Draft202012Validator(SCHEMA)


def test_summaries_keep_the_schema(validator: Any, result: recon.Reconstruction, log: recon.Log, fig5: dict[str, object]) -> None:
    points, normals = result.contacts[::10].reshape(-1, 3), result.normals[::10].reshape(-1, 3)
    summaries = {
        "reconstruction/1": result.summary,
        "without-forces/1": recon.reconstruct(log, fig5, without_forces=True).summary,
        "plane-reconstruction/1": plane.reconstruct(plane.simulate(SCENE).log, KNOWN, identify=True).summary,
        "bounds/1": recon.fit(points, normals, "ellipsoid").bounds.summary,
    }
    for name, summary in summaries.items():
        assert summary["schema"] == name
        validator.validate(summary)


def test_palms_of_any_kind_and_noise_keep_it(validator: Any, palms_result: recon.Reconstruction) -> None:
    validator.validate(palms_result.summary)
    angles = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    flat = np.column_stack([np.cos(angles), np.sin(angles)])
    validator.validate(recon.bounds(flat, flat, contact_noise=1e-3, normal_noise=1e-3).summary)


def test_another_spelling_is_refused(validator: Any, result: recon.Reconstruction) -> None:
    spoilt = {**result.summary, "mass_deviation_kg": 1.0}
    assert not validator.is_valid(spoilt) and validator.is_valid(result.summary)
