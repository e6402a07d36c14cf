"""The next touch is that of the command, from arrays, tables and files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import recon
from conftest import run

POLES = np.vstack([np.eye(3), -np.eye(3)])


@pytest.fixture
def contacts(tmp_path: Path) -> Path:
    path = tmp_path / "contacts.csv"
    rows = [",".join(map(repr, [*map(float, row)] * 2)) for row in POLES]
    path.write_text("\n".join(["x,y,z,nx,ny,nz", *rows]) + "\n", encoding="utf-8")
    return path


def test_the_next_touch_is_that_of_the_command(contacts: Path, command: str) -> None:
    said = run(command, "next", str(contacts), "--until", "gap=0.2", "--planner", "volume", "--seed", "3").stdout
    theirs = json.loads(said)
    table = {axis: POLES[:, k] for k, axis in enumerate("xyz")} | {f"n{axis}": POLES[:, k] for k, axis in enumerate("xyz")}
    for source in [(POLES, POLES), (table,), (contacts,)]:
        plan = recon.plan(*source, until="gap=0.2", planner="volume", seed=3)
        assert plan.summary == theirs
        assert not plan.done and plan.touches == 6 and plan.at_most == theirs["at_most"]
        assert np.array_equal(plan.along, theirs["action"]["along"]) and plan.ray.shape == (2, 3)
        assert plan.why in repr(plan) and plan.expected > 0.0


def test_a_goal_that_is_reached_leaves_nothing_to_touch() -> None:
    plan = recon.plan(POLES, POLES, until="gap=0.99")
    assert plan.done and plan.along is None and plan.ray is None and "gap=0.99" in repr(plan)


def test_the_plane_has_directions_of_two_numbers() -> None:
    plan = recon.plan(np.vstack([np.eye(2), -np.eye(2)]), np.vstack([np.eye(2), -np.eye(2)]), until="hausdorff=0.01")
    assert plan.along.shape == (2,) and abs(np.linalg.norm(plan.along) - 1.0) < 1e-12


def test_what_cannot_be_planned_says_why() -> None:
    with pytest.raises(recon.InputError, match="goal"):
        recon.plan(POLES, POLES)
    with pytest.raises(recon.OptionError, match="until"):
        recon.plan(POLES, POLES, until="gap")
    with pytest.raises(recon.InputError, match=r"normals has the shape \(6, 2\)"):
        recon.plan(POLES, POLES[:, :2], until="gap=0.1")
