"""Python's results are those of the command, to the last bit."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import recon
from conftest import run

MOTION = ["cmx", "cmy", "cmz", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"]


def table(path: Path) -> np.ndarray:
    return np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8")


def same_files(ours: Path, theirs: Path) -> None:
    names = sorted(path.name for path in theirs.iterdir())
    assert names == sorted(path.name for path in ours.iterdir())
    assert "motion.csv" in names and "summary.json" in names
    for name in names:
        assert (ours / name).read_bytes() == (theirs / name).read_bytes(), name


@pytest.mark.parametrize("identify", [False, True])
def test_reconstruction_from_a_file_from_columns_and_from_arrays(files: Path, tmp_path: Path, command: str, identify: bool) -> None:
    words = ["--identify"] if identify else []
    scene, path, theirs = files / "scene.toml", files / "log.csv", tmp_path / "theirs"
    run(command, "reconstruct", str(path), "--scene", str(scene), "-o", str(theirs), *words)
    result = recon.reconstruct(path, scene, identify=identify)
    result.write(tmp_path / "ours")
    same_files(tmp_path / "ours", theirs)
    assert result.summary == json.loads((theirs / "summary.json").read_text(encoding="utf-8"))
    motion = table(theirs / "motion.csv")
    rows = table(path)
    columns = {name: np.array(rows[name]) for name in rows.dtype.names}
    by_palm = range(1, 4)
    arrays = recon.log_from_arrays(
        columns["t"],
        np.stack([np.column_stack([columns[f"s1_{i}"], columns[f"s2_{i}"]]) for i in by_palm], axis=1),
        np.stack([np.column_stack([columns[f"n{axis}_{i}"] for axis in "xyz"]) for i in by_palm], axis=1),
        np.column_stack([columns[f"f_{i}"] for i in by_palm]),
        **({"rates": np.column_stack([columns[f"rate_{i}"] for i in by_palm])} if "rate_1" in columns else {}),
    )
    for made in (result, recon.reconstruct(columns, scene, identify=identify), recon.reconstruct(arrays, scene, identify=identify)):
        assert np.array_equal(made.times, motion["t"])
        for k, name in enumerate(MOTION):
            assert np.array_equal(made.motion[:, k], motion[name]), name


def test_the_least_model_of_an_accuracy(files: Path, tmp_path: Path, command: str) -> None:
    scene, path, theirs = files / "scene.toml", files / "log.csv", tmp_path / "theirs"
    run(command, "reconstruct", str(path), "--scene", str(scene), "--accuracy", "1e-2", "-o", str(theirs), codes=(0, 4))
    result, motion = recon.reconstruct(path, scene, accuracy=1e-2), table(theirs / "motion.csv")
    assert np.array_equal(result.times, motion["t"]) and np.array_equal(result.motion, np.column_stack([motion[name] for name in MOTION]))
    chosen = json.loads((theirs / "summary.json").read_text(encoding="utf-8"))["least_model"]
    assert result.summary["least_model"]["is_reached"] == chosen["is_reached"]
    with pytest.raises(recon.OptionError, match="accuracy"):
        recon.reconstruct(path, scene, accuracy=1e-2, without_forces=True)


def test_contacts_of_any_palms(palms_scene: str, palms_log: Path, palms_result: recon.Reconstruction, tmp_path: Path, command: str) -> None:
    path, theirs, result = palms_log, tmp_path / "theirs", palms_result
    run(command, "reconstruct", str(path), "--scene", palms_scene, "-o", str(theirs), codes=(0, 4))
    result.write(tmp_path / "ours")
    same_files(tmp_path / "ours", theirs)
    motion = table(theirs / "motion.csv")
    columns = recon.columns(result)
    assert set(motion.dtype.names) == set(columns)
    for name in motion.dtype.names:
        assert np.array_equal(np.asarray(columns[name], dtype=float), motion[name].astype(float)), name
    assert np.array_equal(recon.reconstruct(recon.to_frame(recon.read_log(path, palms_scene)), palms_scene).motion, result.motion)


def test_simulation(files: Path, fig5: dict[str, object], log: recon.Log) -> None:
    assert (files / "log.csv").read_text(encoding="utf-8") == log.to_csv()
    assert recon.simulate(files / "scene.toml").log.to_csv() == log.to_csv()


def test_following(small: Path, tmp_path: Path, command: str) -> None:
    scene, path = small / "scene.toml", small / "log.csv"
    noise = {"contact_noise": 1e-6, "force_noise": 1e-4}
    words = [f"--{name.replace('_', '-')}={value}" for name, value in noise.items()]
    run(command, "follow", str(path), "--scene", str(scene), "--every", "0", "-o", str(tmp_path / "rows.csv"), *words, codes=(0, 4))
    theirs, ours = table(tmp_path / "rows.csv"), recon.follow(path, scene, **noise)
    assert np.array_equal(ours.times, theirs["t"]) and ours.reliable.any()
    for k, name in enumerate(MOTION):
        assert np.array_equal(ours.motion[:, k], theirs[name], equal_nan=True), name
    assert list(ours.stages) == list(theirs["stage"])
    for name, values in recon.columns(ours).items():
        if name != "stage":
            assert np.array_equal(np.asarray(values, dtype=float), theirs[name].astype(float), equal_nan=True), name


def test_bounds_and_fit(files: Path, result: recon.Reconstruction, tmp_path: Path, command: str) -> None:
    points, normals = result.contacts[::10].reshape(-1, 3), result.normals[::10].reshape(-1, 3)
    rows = [",".join(map(repr, map(float, row))) for row in np.hstack([points, normals])]
    (tmp_path / "contacts.csv").write_text("\n".join(["x,y,z,nx,ny,nz", *rows]) + "\n", encoding="utf-8")
    run(command, "bounds", str(tmp_path / "contacts.csv"), "--fit", "ellipsoid", "-o", str(tmp_path / "theirs"))
    theirs = json.loads((tmp_path / "theirs" / "summary.json").read_text(encoding="utf-8"))
    fit = recon.fit(points, normals, "ellipsoid")
    assert fit.bounds.summary == theirs
    assert recon.bounds(tmp_path / "contacts.csv", fit="ellipsoid").summary == theirs
    fit.bounds.write(tmp_path / "ours")
    for name in ("lower_bound.ply", "upper_bound.ply", "fitted_shape.ply"):
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes()
    assert recon.check(tmp_path / "ours")
