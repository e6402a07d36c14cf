"""Logs in the plane: the folder of the command byte for byte, arrays bit for bit, and errors that name the mend."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import recon
from conftest import run
from recon import plane

# A palm that rubs and one that moves too: what is known of them, and what a simulation needs beside.
KNOWN: dict[str, Any] = {
    "plane": True,
    "gravity": 9.81,
    "object": {"mass": 0.2, "inertia": 1.8e-4},
    "sensors": {"contact_std": 1e-4, "force_std": 0.01},
    "palm": [{"kind": "line", "friction": 0.3}, {"kind": "line", "friction": 0.2}],
}
ANGLES, AMPLITUDES, FREQUENCIES = (45.0, 315.0), (0.3, 0.2), (6.0, 4.0)


def moving(k: int) -> dict[str, Any]:
    law = {"kind": "sinusoid", "amplitude": AMPLITUDES[k], "frequency": FREQUENCIES[k]}
    pose = {"position": [0.0, 0.0], "angle_deg": ANGLES[k]}
    return {**KNOWN["palm"][k], "pose": pose, "motion": [{"pivot": [0.0, 0.0], "law": law}]}


SCENE: dict[str, Any] = {
    **KNOWN,
    "palm": [moving(0), moving(1)],
    "simulation": {
        "duration": 1.0,
        "sample_rate": 500.0,
        "position": [0.0, 0.06],
        "touches": [1, 2],
        "shape": {"kind": "ellipse", "semi_axes": [0.05, 0.035]},
    },
}
TOML = """plane = true
gravity = 9.81
[object]
mass = 0.2
inertia = 1.8e-4
[sensors]
contact_std = 1e-4
force_std = 0.01
[[palm]]
kind = "line"
friction = 0.3
[[palm]]
kind = "line"
friction = 0.2
"""


@pytest.fixture(scope="module")
def log() -> plane.Log:
    return plane.simulate(SCENE).log


@pytest.fixture(scope="module")
def result(log: plane.Log) -> plane.Reconstruction:
    return plane.reconstruct(log, KNOWN, identify=True)


def table(text: str) -> dict[str, np.ndarray]:
    rows = list(csv.reader(io.StringIO(text)))
    return {name: np.array([float(row[k]) for row in rows[1:]]) for k, name in enumerate(rows[0])}


def test_the_motion_is_found(log: plane.Log, result: plane.Reconstruction) -> None:
    truth = table(log.to_csv())
    assert result.reliable and len(result) == len(log) == 501 and log.palms == 2
    off = result.position - np.column_stack([truth["cmx"], truth["cmy"]])
    relied = result.relied_on
    # Errors of some deviations; of a thousand numbers one of five is to be expected in a million runs.
    assert relied.mean() > 0.9 and (np.abs(off)[relied] < 6.0 * result.position_std[relied]).all()
    assert result.mass_std is not None and abs(result.mass - 0.2) < 6.0 * result.mass_std
    assert result.inertia_std is not None and abs(result.inertia - 1.8e-4) < 6.0 * result.inertia_std
    # The contacts leave the outline open on one side: there is no upper bound.
    assert result.outlines is not None and result.areas is not None and any("no upper bound" in warning for warning in result.warnings)
    assert len(result.outlines[0]) > 2 and len(result.outlines[1]) == 0 and result.areas[0] > 0.0 and np.isinf(result.areas[1])


def test_the_folder_is_that_of_the_command(log: plane.Log, tmp_path: Path, command: str) -> None:
    log.write(tmp_path / "log.csv")
    (tmp_path / "scene.toml").write_text(TOML, encoding="utf-8")
    words = [str(tmp_path / "log.csv"), "--scene", str(tmp_path / "scene.toml"), "--identify"]
    run(command, "reconstruct", *words, "-o", str(tmp_path / "theirs"))
    again = plane.read_log(tmp_path / "log.csv", tmp_path / "scene.toml")
    plane.reconstruct(again, tmp_path / "scene.toml", identify=True).write(tmp_path / "ours")
    names = sorted(path.name for path in (tmp_path / "theirs").iterdir())
    assert names == sorted(path.name for path in (tmp_path / "ours").iterdir()) and "report.html" in names
    for name in names:
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes(), name
    assert recon.check(tmp_path / "ours")


def test_no_more_is_modelled_than_an_accuracy_needs(tmp_path: Path, command: str) -> None:
    # 350 samples in the time in which it falls over: some are left out.
    log = plane.simulate({**SCENE, "simulation": {**SCENE["simulation"], "sample_rate": 5000.0}}).log
    log.write(tmp_path / "log.csv")
    (tmp_path / "scene.toml").write_text(TOML, encoding="utf-8")
    words = [str(tmp_path / "log.csv"), "--scene", str(tmp_path / "scene.toml"), "--accuracy", "0.05"]
    run(command, "reconstruct", *words, "-o", str(tmp_path / "theirs"), codes=(0, 4))
    again = plane.read_log(tmp_path / "log.csv", tmp_path / "scene.toml")
    result = plane.reconstruct(again, KNOWN, accuracy=0.05)
    motion = table((tmp_path / "theirs" / "motion.csv").read_text(encoding="utf-8"))
    assert np.array_equal(result.times, motion["t"]) and np.array_equal(result.position[:, 1], motion["y"])
    assert result.summary["least_model"]["is_reached"] and len(result) == len(result.motion) < len(log)
    with pytest.raises(recon.OptionError, match="accuracy"):
        plane.reconstruct(log, KNOWN, accuracy=-1.0)


def test_arrays_are_the_columns_of_the_tables(log: plane.Log, result: plane.Reconstruction, tmp_path: Path) -> None:
    result.write(tmp_path / "out")
    motion = table((tmp_path / "out" / "motion.csv").read_text(encoding="utf-8"))
    assert np.array_equal(result.times, motion["t"])
    assert np.array_equal(result.motion, np.column_stack([motion[name] for name in ("x", "y", "phi0", "vx", "vy", "omega0")]))
    assert np.array_equal(result.orientation, motion["phi0"]) and np.array_equal(result.angular_velocity, motion["omega0"])
    assert np.array_equal(result.velocity_std, np.column_stack([motion["std_vx"], motion["std_vy"]]))
    covariance = result.pose_covariance
    assert covariance.shape == (len(result), 3, 3) and np.array_equal(covariance, covariance.transpose(0, 2, 1))
    std = np.column_stack([result.position_std, result.turn_std])
    assert np.allclose(np.einsum("kii->ki", covariance), std**2, rtol=1e-9, atol=0.0)
    assert np.array_equal(result.turn_std, motion["std_phi0"]) and np.array_equal(result.angular_velocity_std, motion["std_omega0"])
    assert np.array_equal(result.modes[:, 1], motion["mode_2"]) and np.array_equal(result.relied_on, motion["relied_on"] == 1)
    points = table((tmp_path / "out" / "contact_points.csv").read_text(encoding="utf-8"))
    touched = result.relied_on & np.isfinite(result.contacts[:, 0, 0])
    assert np.array_equal(result.contacts[touched, 0, 0], points["x"][points["palm"] == 1])
    assert np.array_equal(result.normals[touched, 0, 1], points["ny"][points["palm"] == 1])
    assert not result.motion.flags.writeable and result.summary["mass_kg"] == result.mass
    assert "<html" in result.report_html and "<iframe" in result._repr_html_() and "mass" in repr(result)
    assert {row["key"] for row in result.evidence} >= {"mass", "std_mass", "inertia"}


def test_columns_are_the_log(log: plane.Log) -> None:
    columns = table(log.to_csv())
    again = plane.log_from_frame(columns, KNOWN)
    assert again.to_csv() == log.to_csv() and "501 samples" in repr(again)


def test_two_hinged_palms_need_no_table(command: str, tmp_path: Path) -> None:
    run(command, "planar", "-o", str(tmp_path / "fig3"))
    result = plane.reconstruct(tmp_path / "fig3" / "log.csv", {})
    assert result.reliable and result.contacts.shape[1:] == (2, 2) and abs(result.mass - 1.0) < 1e-6
    assert result.outlines is not None and result.areas is not None
    assert all(len(outline) > 2 for outline in result.outlines) and 0.0 < result.areas[0] < result.areas[1]
    columns = table((tmp_path / "fig3" / "log.csv").read_text(encoding="utf-8"))
    assert np.array_equal(plane.reconstruct(columns, {}).motion, result.motion)


def test_what_is_wrong_says_the_mend(log: plane.Log) -> None:
    with pytest.raises(recon.InputError, match="recon.plane"):
        recon.scene(SCENE)
    with pytest.raises(recon.InputError, match="plane"):
        plane.scene({**KNOWN, "plane": False})
    with pytest.raises(recon.InputError, match=r"\[simulation\]"):
        plane.simulate(KNOWN)
    columns = table(log.to_csv())
    columns["fx_2"][7] = np.inf
    with pytest.raises(recon.InputError, match=r"row 7.*fx_2|fx_2.*row 7"):
        plane.log_from_frame(columns, KNOWN)
    del columns["angle_1"]
    with pytest.raises(recon.InputError, match="angle_1"):
        plane.reconstruct(columns, KNOWN)
    with pytest.raises(recon.OptionError, match="tolerance"):
        plane.simulate(SCENE, tolerance=-1.0)


def test_the_page_of_a_simulation_and_its_steps() -> None:
    made = plane.simulate(SCENE, report=True)
    assert made.report_html is not None and "samples" in made.text and made.summary["samples"] == 501
    steps: list[str] = []
    plane.reconstruct(made.log, KNOWN, progress=steps.append)
    assert steps == ["estimating the motion"]
