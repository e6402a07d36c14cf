"""What results hold: shapes, units, frames, memory."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import recon


def test_motion_is_the_true_one(log: recon.Log, result: recon.Reconstruction) -> None:
    truth = recon.columns(log)
    assert result.reliable and result.is_whole and result.verdict
    assert len(result) == len(log) == len(result.times)
    for k, axis in enumerate("xyz"):
        assert np.abs(result.position[:, k] - truth[f"cm{axis}"]).max() < 1e-9
        assert np.abs(result.velocity[:, k] - truth[f"v{axis}"]).max() < 1e-8
        assert np.abs(result.angular_velocity[:, k] - truth[f"w{axis}"]).max() < 1e-8
    assert np.abs(np.linalg.norm(result.orientation, axis=1) - 1.0).max() < 1e-14
    assert result.mass == 1.0 and np.allclose(np.linalg.eigvalsh(result.inertia), [1.0, 1.45, 2.05], rtol=1e-12)


def test_contacts_are_on_the_bounds_and_in_the_world_where_the_pose_says(result: recon.Reconstruction) -> None:
    n = len(result)
    assert result.contacts.shape == result.normals.shape == result.contacts_world.shape == (n, 3, 3)
    w, v = result.orientation[:, None, :1], result.orientation[:, None, 1:]
    c = result.contacts
    cross = np.cross(np.broadcast_to(v, c.shape), c)
    turned = c + 2.0 * (w * cross + np.cross(np.broadcast_to(v, c.shape), cross))
    assert np.abs(turned + result.position[:, None, :] - result.contacts_world).max() < 1e-9
    # On the ellipsoid: x / a^2 along the normal.
    lower, upper = result.lower_bound, result.upper_bound
    assert lower is not None and upper is not None
    true = 4.0 / 3.0 * np.pi * 2.5 * 2.0 * 1.0
    assert lower.volume < true < upper.volume
    assert lower.triangles.max() < len(lower.vertices) and lower.vertices.shape[1] == 3


def test_parts_of_the_motion_share_its_memory_and_none_can_be_written_to(result: recon.Reconstruction) -> None:
    assert np.shares_memory(result.position, result.motion)
    assert np.shares_memory(result.motion, result.motion), "the same array each time"
    assert result.motion is result.motion
    for values in (result.motion, result.position, result.times, result.contacts):
        with pytest.raises(ValueError):
            values[0] = 0.0


def test_arrays_outlive_their_result(log: recon.Log, fig5: dict[str, object]) -> None:
    made = recon.reconstruct(log, fig5)
    position, first = made.position, made.position[0].copy()
    del made
    assert np.array_equal(position[0], first)


def test_mass_and_inertia_have_deviations_where_they_are_estimated(log: recon.Log, fig5: dict[str, object]) -> None:
    found = recon.reconstruct(log, {"gravity": 9.81}, identify=True)
    assert abs(found.mass - 1.0) < 1e-6 and found.mass_std > 0.0
    assert found.inertia.shape == found.inertia_std.shape == (3, 3)
    assert recon.reconstruct(log, fig5).mass_std is None


def test_what_a_person_sees(result: recon.Reconstruction, log: recon.Log, simulation: recon.Simulation) -> None:
    assert "1501 samples" in repr(log) or "1500 samples" in repr(log)
    assert result.verdict.split()[0] in repr(result)
    page = result._repr_html_()
    assert page.startswith("<iframe srcdoc=") and "&lt;" in page
    assert result.report_html.lstrip().lower().startswith("<!doctype html>")
    assert {"key", "name", "value", "unit", "level", "meaning"} == set(result.evidence[0])
    assert simulation.is_whole and "samples" in repr(simulation)


def test_any_palms_have_deviations_modes_and_marks(
    palms_simulation: recon.Simulation, palms_result: recon.Reconstruction
) -> None:
    assert palms_simulation.report_html and "<iframe" in palms_simulation._repr_html_()
    result = palms_result
    n = len(result)
    assert result.modes.shape == (n, 4) and set(np.unique(result.modes)) <= {0, 1, 2}
    for std in (result.position_std, result.velocity_std, result.angular_velocity_std, result.turn_std):
        assert std.shape == (n, 3) and (std >= 0.0).all()
    covariance = result.pose_covariance
    assert covariance.shape == (n, 6, 6) and np.array_equal(covariance, covariance.transpose(0, 2, 1))
    std = np.hstack([result.position_std, result.turn_std])
    assert np.allclose(np.einsum("kii->ki", covariance), std**2, rtol=1e-9, atol=0.0)
    assert result.relied_on.dtype == bool and result.relied_on.shape == (n,)


def test_columns_go_into_files_and_come_back(result: recon.Reconstruction, tmp_path: Path) -> None:
    recon.save(result, tmp_path / "motion.npz")
    recon.save(result, tmp_path / "motion.npy")
    with np.load(tmp_path / "motion.npz") as back:
        assert np.array_equal(back["cmx"], result.position[:, 0])
    back = np.load(tmp_path / "motion.npy")
    assert np.array_equal(back["wz"], result.angular_velocity[:, 2])
    with pytest.raises(recon.InputError, match="npz, .npy or .parquet"):
        recon.save(result, tmp_path / "motion.txt")


def test_parquet(result: recon.Reconstruction, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    recon.save(result, tmp_path / "motion.parquet")
    back = parquet.read_table(tmp_path / "motion.parquet")
    assert np.array_equal(back["qw"].to_numpy(), result.orientation[:, 0])


def test_bounds_of_the_poles_of_a_ball_are_octahedron_and_cube() -> None:
    poles = np.vstack([np.eye(3), -np.eye(3)])
    made = recon.bounds(poles, poles)
    assert made.is_whole
    assert abs(made.lower_volume - 4.0 / 3.0) < 1e-12 and abs(made.upper_volume - 8.0) < 1e-12
    assert made.lower_bound.vertices.shape == (6, 3)
    plane = recon.bounds(poles[:, :2][[0, 1, 3, 4]], poles[:, :2][[0, 1, 3, 4]])
    assert plane.lower_volume is None and np.allclose(plane.areas, [2.0, 4.0]) and len(plane.outlines[0]) == 4


def test_a_ball_is_fitted_by_a_ball() -> None:
    angles = np.linspace(0.1, 3.0, 40)
    normals = np.column_stack([np.cos(7 * angles) * np.sin(angles), np.sin(7 * angles) * np.sin(angles), np.cos(angles)])
    made = recon.fit(0.05 * normals + [0.01, 0.0, 0.0], normals, "ball")
    assert made.family == "ball" or "sphere" in made.family
    values = sorted(made.parameters.values())
    assert abs(values[-1] - 0.05) < 1e-12 and abs(values[-2] - 0.01) < 1e-12
    assert made.covariance.shape == (len(values), len(values)) and made.residual < 1e-12
    assert made.mesh.vertices.shape[1] == 3 and "+-" in repr(made)


def test_surfaces_are_written_as_ply_stl_and_gltf(result: recon.Reconstruction, tmp_path: Path) -> None:
    mesh = result.lower_bound
    for ending, start in (("ply", b"ply"), ("stl", b"binary STL"), ("glb", b"glTF")):
        mesh.write(tmp_path / f"lower.{ending}")
        assert (tmp_path / f"lower.{ending}").read_bytes().startswith(start)
    stl = np.frombuffer((tmp_path / "lower.stl").read_bytes()[84:], dtype=[("v", "<f4", (4, 3)), ("-", "<u2")])
    assert np.allclose(stl["v"][:, 1:], mesh.vertices[mesh.triangles], rtol=1e-6, atol=1e-6)
    with pytest.raises(recon.InputError, match=".ply, .stl or .glb"):
        mesh.write(tmp_path / "lower.obj")
    result.write(tmp_path / "out", mesh=["stl"], export=["mjcf"])
    assert (tmp_path / "out" / "upper_bound.stl").is_file() and (tmp_path / "out" / "object.xml").is_file()
