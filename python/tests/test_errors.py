"""What cannot be used is an exception of its kind that names the value, the place and the mend."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import recon


def columns(log: recon.Log) -> dict[str, Any]:
    return {name: values.copy() for name, values in recon.columns(log).items()}


def test_the_classes_are_what_python_calls_such_errors() -> None:
    for kind in (recon.InputError, recon.OptionError, recon.OutputError, recon.FaultError):
        assert issubclass(kind, recon.ReconError)
    assert issubclass(recon.InputError, ValueError) and issubclass(recon.OptionError, ValueError)
    assert issubclass(recon.OutputError, OSError) and recon.InputError.__module__ == "recon"


def test_values_of_a_log(log: recon.Log) -> None:
    def refused(change: Any, *words: str) -> None:
        table = columns(log)
        table = change(table) or table
        with pytest.raises(recon.InputError) as caught:
            recon.log_from_frame(table)
        for word in words:
            assert word in str(caught.value), str(caught.value)

    refused(lambda t: t["f_2"].__setitem__(7, np.inf), "row 7", "f_2", "finite")
    refused(lambda t: t["s1_1"].__setitem__(3, np.nan), "row 3", "s1_1", "nan")
    refused(lambda t: t["nz_3"].__setitem__(5, 9.0), "row 5", "palm 3")
    refused(lambda t: t["t"].__setitem__(5, t["t"][4]), "row 5")
    refused(lambda t: {name: v for name, v in t.items() if name != "s2_2"}, "s2_2", "missing")
    refused(lambda t: t | {"f_1": t["f_1"][:-1]}, "f_1", "1500", "1501")
    refused(lambda t: t | {"f_1": t["f_1"].astype(str)}, "f_1", "real numbers")
    refused(lambda t: t | {"f_1": t["f_1"] * 1j}, "f_1", "complex")
    refused(lambda t: t | {"f_1": np.zeros((len(t["t"]), 2))}, "f_1", "shape", "(n,)")
    refused(lambda t: t | {"f_1": ["one"] + [1.0] * 1500}, "f_1")
    refused(lambda t: {"f_1": t["f_1"]}, "column `t` is missing")
    refused(lambda t: t | {"f_1": t["f_1"] > 0.0}, "f_1", "bool")
    refused(lambda t: t | {3: t["f_1"]} | {"f_1": np.ma.masked_array(t["f_1"], mask=t["t"] == t["t"][9])}, "row 9", "f_1", "nan")


def test_shapes_of_arrays() -> None:
    t, s, n = np.arange(4.0), np.zeros((4, 3, 2)), np.zeros((4, 3, 3))
    with pytest.raises(recon.InputError, match=r"contacts has the shape \(4, 2, 3\); give an array of shape \(n, 3, 2\)"):
        recon.log_from_arrays(t, np.zeros((4, 2, 3)), n)
    with pytest.raises(recon.InputError, match="normals has 3 rows where t has 4"):
        recon.log_from_arrays(t, s, n[:3])
    with pytest.raises(recon.InputError, match="forces"):
        recon.log_from_arrays(t, s, n, np.zeros(4))
    with pytest.raises(recon.InputError, match="palm"):
        recon.log_from_arrays(t, s, n, np.zeros((4, 3)))
    with pytest.raises(recon.InputError, match="no array"):
        recon.log_from_arrays([0.0, 1.0], [[[1, 2]], [[1]]], n)
    with pytest.raises(recon.InputError, match="palm"):
        recon.log_from_contacts(t, np.zeros((4, 1, 3)), np.zeros((4, 1, 3)), {"gravity": 9.81})
    with pytest.raises(recon.InputError, match="points"):
        recon.bounds(np.zeros((3, 4)), np.zeros((3, 4)))
    with pytest.raises(recon.InputError, match="points is no array.*one length"):
        recon.bounds([[1.0, 2.0, 3.0], [1.0, 2.0]], np.eye(3)[:2])  # type: ignore[list-item]
    with pytest.raises(recon.InputError, match="row 1"):
        recon.bounds(np.eye(3), np.diag([1.0, 2.0, 1.0]))
    with pytest.raises(recon.InputError, match="row 2.*finite"):
        recon.bounds(np.diag([1.0, 1.0, np.nan]), np.eye(3))


def test_scenes_and_files(tmp_path: Path, log: recon.Log) -> None:
    with pytest.raises(recon.InputError, match="grav"):
        recon.scene({"gravty": 9.81, "object": {}})
    with pytest.raises(recon.InputError, match="None|null|nul"):
        recon.scene(object={"mass": None})
    with pytest.raises(recon.InputError, match="no scene"):
        recon.reconstruct(log, 9.81)
    with pytest.raises(recon.InputError, match="mass and inertia"):
        recon.reconstruct(log, {"gravity": 9.81})
    with pytest.raises(recon.InputError, match="none.csv"):
        recon.read_log(tmp_path / "none.csv")
    with pytest.raises(recon.InputError, match="int is no table"):
        recon.reconstruct(3, {"gravity": 9.81})
    (tmp_path / "bad.csv").write_text("t,s1_1\n0,one\n", encoding="utf-8")
    with pytest.raises(recon.InputError, match="s2_1"):
        recon.reconstruct(tmp_path / "bad.csv", {"gravity": 9.81})


def test_options(log: recon.Log) -> None:
    poles = np.vstack([np.eye(3), -np.eye(3)])
    with pytest.raises(recon.OptionError, match="normal_noise"):
        recon.bounds(poles, poles, contact_noise=1e-3)
    with pytest.raises(recon.OptionError, match="contact_noise"):
        recon.bounds(poles, poles, contact_noise=-1.0, normal_noise=1e-3)
    with pytest.raises(recon.OptionError, match="contact_noise is 'much'|much"):
        recon.bounds(poles, poles, contact_noise="much", normal_noise=1e-3)
    for wrong in ("perhaps", 2, [True]):
        with pytest.raises(recon.OptionError, match="identify is .*; give True or False"):
            recon.reconstruct("log.csv", {"gravity": 9.81}, identify=wrong)  # type: ignore[arg-type]
    with pytest.raises(recon.OptionError, match="fit"):
        recon.bounds(poles, poles, fit="cube")
    with pytest.raises(recon.OptionError, match="plane_height"):
        recon.bounds(poles, poles, plane_height=0.0)
    with pytest.raises(recon.OptionError, match="tolerance"):
        recon.simulate({"gravity": 9.81}, tolerance=1.0)
    with pytest.raises(recon.OptionError, match="tolerance"):
        recon.simulate({"gravity": 9.81}, tolerance=[1, {}])


def test_what_stands_in_the_way_of_results_is_named(result: recon.Reconstruction, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mine.txt").write_text("mine", encoding="utf-8")
    with pytest.raises(recon.OutputError, match="force"):
        result.write(tmp_path / "out")
    result.write(tmp_path / "out", force=True)
    assert (tmp_path / "out" / "mine.txt").read_text(encoding="utf-8") == "mine"
    with pytest.raises(recon.OptionError, match="export"):
        result.write(tmp_path / "other", export=["stl"])
    (tmp_path / "out" / "motion.csv").write_text("t\n", encoding="utf-8")
    with pytest.raises(recon.InputError, match="motion.csv"):
        recon.check(tmp_path / "out")


def test_rows_of_a_follower(log: recon.Log, fig5: dict[str, object]) -> None:
    table = columns(log)
    follower = recon.Follower(list(table), fig5, contact_noise=1e-6, force_noise=1e-4)
    with pytest.raises(recon.InputError, match="columns"):
        follower.push([0.0])
    with pytest.raises(recon.InputError, match="float64"):
        follower.push(np.zeros(3, dtype=np.float32))
    with pytest.raises(recon.InputError, match="numbers"):
        follower.push(["one"] * len(table))
    with pytest.raises(recon.InputError, match="row 0.*finite"):
        follower.push([np.nan] * len(table))
    with pytest.raises(recon.InputError, match="contact_noise"):
        recon.Follower(list(table), fig5)
