"""Logs on a cluster of two nodes, of which one is killed in the middle: nothing is lost, and nothing is there twice.

50 of them, or 400 where RECON_TESTS is "all".
"""

from __future__ import annotations

import os
import random
import threading
import time
import uuid
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import recon
from conftest import many_logs_example, same_row

COUNT = 400 if os.environ.get("RECON_TESTS") == "all" else 50

# Logs that the second node has finished when it is killed, and that are then finished in all: the middle.
THERE, IN_ALL = COUNT // 20, COUNT // 4

# Seconds that the kill may be late, and the file that says that it happened.
PATIENCE, KILLED = 120.0, "killed"


@pytest.fixture(scope="module")
def example() -> ModuleType:
    return many_logs_example()


@pytest.fixture(scope="module")
def logs(fig5: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> tuple[list[str], str]:
    """Logs, each of another start, of which every fiftieth is cut off; and their scene."""
    folder = tmp_path_factory.mktemp("many")
    paths = []
    for k in range(COUNT):
        chance = random.Random(k)
        start = [chance.uniform(*span) for span in ((-0.2, 0.2), (0.2, 0.4), (0.2, 0.4))]
        motion = {**fig5["simulation"], "sample_rate": 200.0, "angular_velocity": start}
        path = folder / f"{k:03}.csv"
        path.write_text(recon.simulate({**fig5, "simulation": motion}).log.to_csv(), encoding="utf-8")
        if k % 50 == 49:
            path.write_text(path.read_text(encoding="utf-8")[:2000], encoding="utf-8")
        paths.append(str(path))
    scene = folder / "scene.toml"
    scene.write_text("gravity = 9.81\n", encoding="utf-8")
    return paths, str(scene)


@pytest.fixture
def nodes() -> Iterator[tuple[Any, Any]]:
    """A cluster of two nodes, of one task at a time each, and its second node."""
    ray = pytest.importorskip("ray")
    pytest.importorskip("ray.data")
    from ray.cluster_utils import Cluster

    # A node that answers no more is noticed within a second, not within ten; one that is only slow has two each time.
    often = {"health_check_initial_delay_ms": 0, "health_check_period_ms": 300, "health_check_timeout_ms": 2000, "health_check_failure_threshold": 3}
    head = {"num_cpus": 1, "include_dashboard": False, "_system_config": often}
    cluster = Cluster(initialize_head=True, head_node_args=head)
    try:
        second = cluster.add_node(num_cpus=1)
        ray.init(address=cluster.address, log_to_driver=False)
        yield cluster, second
    finally:
        ray.shutdown()
        cluster.shutdown()


def marked(estimate: Any, folder: str) -> Any:
    """`estimate`, which leaves a file `NODE.LOG.CHANCE` in a folder when it has made a row.

    In the middle a node that has made enough waits for the kill, however late the other one comes to work on a machine that has much to do.
    """

    def made(log: str, scene: str) -> dict[str, Any]:
        import ray

        node = ray.get_runtime_context().get_node_id()
        deadline = time.monotonic() + PATIENCE
        while not Path(folder, KILLED).exists() and time.monotonic() < deadline:
            rows = [path.name for path in Path(folder).iterdir()]
            if len(rows) < COUNT // 2 or sum(row.startswith(node) for row in rows) < THERE:
                break
            time.sleep(0.05)
        row: dict[str, Any] = estimate(log, scene)
        Path(folder, f"{node}.{Path(log).stem}.{uuid.uuid4().hex}").touch()
        return row

    return made


def finished(folder: Path) -> list[tuple[str, str]]:
    """Node and log of each row that was made."""
    names = (path.name.split(".") for path in folder.iterdir() if path.name != KILLED)
    return [(node, log) for node, log, _ in names]


def test_a_lost_node_loses_no_row(
    example: ModuleType,
    logs: tuple[list[str], str],
    nodes: tuple[Any, Any],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    import ray

    (paths, scene), (cluster, second) = logs, nodes
    alone = example.in_one_process(paths, scene)
    at_death: list[tuple[str, str]] = []

    def kill() -> None:
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            made = finished(tmp_path)
            if len(made) >= IN_ALL and sum(node == second.node_id for node, _ in made) >= THERE:
                cluster.remove_node(second, allow_graceful=False)
                at_death.extend(finished(tmp_path))
                (tmp_path / KILLED).touch()
                return
            time.sleep(0.02)

    monkeypatch.setattr(example, "estimate", marked(example.estimate, str(tmp_path)))
    killer = threading.Thread(target=kill)
    killer.start()
    rows = example.with_ray(paths, scene)
    killer.join()

    # It happened in the middle, and one node was left.
    lost = [log for node, log in at_death if node == second.node_id]
    assert len(lost) >= THERE and len({log for _, log in at_death}) < COUNT
    assert sum(node["Alive"] for node in ray.nodes()) == 1
    # Rows are small, and stand with who asked for them: what the dead node was at is made again, not what it had made.
    made = Counter(log for _, log in finished(tmp_path))
    assert len(made) == COUNT and sum(made.values()) < COUNT + len(lost)
    print(f"{len(at_death)} rows at the kill, {len(lost)} of them there; {sum(made.values()) - COUNT} made twice")

    assert [row["log"] for row in rows] == [f"{k:03}.csv" for k in range(COUNT)]
    different = [(a, b) for a, b in zip(alone, rows) if not same_row(a, b)]
    assert len(alone) == len(rows) == COUNT and not different, different[:1]
    assert Counter(row["state"] for row in rows)["skipped"] == COUNT // 50
