"""Mapping over logs: the example's table, in one process, with Ray, and the command's."""

from __future__ import annotations

import csv
import math
import os
from pathlib import Path
from types import ModuleType

import pytest

import recon
from conftest import many_logs_example, run, same_row

@pytest.fixture(scope="module")
def example() -> ModuleType:
    return many_logs_example()


@pytest.fixture(scope="module")
def logs(files: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three logs of one scene, of which the last is broken."""
    folder = tmp_path_factory.mktemp("logs")
    text = (files / "log.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    (folder / "a.csv").write_text("".join(text), encoding="utf-8")
    (folder / "b.csv").write_text("".join(text[:1001]), encoding="utf-8")
    (folder / "c.csv").write_text("".join(text[:50]) + "what,is,this\n", encoding="utf-8")
    return folder


def test_one_process_has_the_numbers_of_the_command(example: ModuleType, files: Path, logs: Path, tmp_path: Path, command: str) -> None:
    scene = str(files / "scene.toml")
    run(command, "batch", str(logs), "--scene", scene, "--identify", "-o", str(tmp_path / "out"), codes=(4,))
    with open(tmp_path / "out" / "results.csv", newline="", encoding="utf-8") as table:
        theirs = list(csv.DictReader(table))
    ours = example.in_one_process([str(path) for path in sorted(logs.iterdir())], scene)
    assert [row["state"] for row in ours] == [row["state"] for row in theirs] == ["relied on", "relied on", "skipped"]
    for mine, other in zip(ours, theirs):
        for name in ("mass_kg", "std_mass_kg", "lower_volume_m3", "upper_volume_m3"):
            assert mine[name] == float(other[name]) or math.isnan(mine[name]) and other[name] == "nan", name
    assert "line 51" in ours[2]["why"] and "c.csv" in ours[2]["why"]


def test_the_table_is_written_as_parquet_too(example: ModuleType, files: Path, logs: Path, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    rows = example.in_one_process([str(path) for path in sorted(logs.iterdir())], str(files / "scene.toml"))
    example.write(rows, str(tmp_path / "table.parquet"))
    read = parquet.read_table(tmp_path / "table.parquet").to_pylist()
    assert len(read) == 3 and all(same_row(a, b) for a, b in zip(rows, read))


def test_ray_makes_the_same_table(example: ModuleType, files: Path, logs: Path) -> None:
    ray = pytest.importorskip("ray")
    pytest.importorskip("ray.data")
    paths, scene = [str(path) for path in sorted(logs.iterdir())], str(files / "scene.toml")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, runtime_env={"env_vars": {"PYTHONPATH": os.environ.get("PYTHONPATH", "")}})
    try:
        ours, theirs = example.in_one_process(paths, scene), example.with_ray(paths, scene)
    finally:
        ray.shutdown()
    assert len(ours) == len(theirs) == 3
    for a, b in zip(ours, theirs):
        assert same_row(a, b), (a, b)
    assert recon.reconstruct(paths[0], scene, identify=True).mass == theirs[0]["mass_kg"]
