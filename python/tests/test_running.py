"""Long work: others run meanwhile, each step is told, and Ctrl-C stops it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

import recon

LONG = """
import signal, sys, threading, os, time
import recon
scene = recon.scene({fig5!r})
log = recon.simulate(scene).log
begun = threading.Event()
def step(name):
    begun.set()
def interrupt():
    begun.wait()
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt, daemon=True).start()
try:
    for _ in range(10000):
        recon.reconstruct(log, scene, progress=step)
except KeyboardInterrupt:
    sys.exit(7)
sys.exit(1)
"""


def test_steps_are_told_in_order(log: recon.Log, fig5: dict[str, object]) -> None:
    steps: list[str] = []
    recon.reconstruct(log, fig5, progress=steps.append)
    assert steps == ["estimating the motion", "bounding the shape"]


def test_an_exception_of_the_callback_ends_the_work(log: recon.Log, fig5: dict[str, object]) -> None:
    def enough(step: str) -> None:
        raise RuntimeError(step)

    with pytest.raises(RuntimeError, match="estimating the motion"):
        recon.reconstruct(log, fig5, progress=enough)


def test_other_threads_run_meanwhile(log: recon.Log, fig5: dict[str, object]) -> None:
    done, ran = threading.Event(), []

    def other() -> None:
        while not done.is_set():
            ran.append(1)

    thread = threading.Thread(target=other)
    results: list[int] = []

    def step(name: str) -> None:
        results.append(len(ran))

    thread.start()
    recon.reconstruct(log, fig5, progress=step)
    results.append(len(ran))
    done.set()
    thread.join()
    assert results[-1] > results[0], "nothing ran between the first step and the end"


def test_two_threads_get_the_same(log: recon.Log, fig5: dict[str, object]) -> None:
    made: list[recon.Reconstruction] = []
    threads = [threading.Thread(target=lambda: made.append(recon.reconstruct(log, fig5))) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert np.array_equal(made[0].motion, made[1].motion)


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_ctrl_c_stops_it(fig5: dict[str, object]) -> None:
    run = subprocess.run([sys.executable, "-c", LONG.format(fig5=fig5)], timeout=120, check=False)
    assert run.returncode == 7


def test_the_command_comes_with_the_package(tmp_path: Path) -> None:
    made = subprocess.run([sys.executable, "-m", "recon", "--version"], capture_output=True, text=True, check=False)
    assert made.returncode == 0 and recon.__version__ in made.stdout
    wrong = subprocess.run([sys.executable, "-m", "recon", "check", str(tmp_path)], capture_output=True, text=True, check=False)
    assert wrong.returncode == 3 and "recon:" in wrong.stderr


def test_following_row_by_row_is_following_all_of_them(small: Path) -> None:
    scene = recon.scene(small / "scene.toml")
    table = recon.columns(recon.read_log(small / "log.csv", scene))
    rows = np.column_stack(list(table.values()))
    noise = {"contact_noise": 1e-6, "force_noise": 1e-4}
    whole = recon.follow(table, scene, **noise)
    follower = recon.Follower(list(table), scene, **noise)
    pushed = [follower.push(row) for row in rows]
    assert pushed[0] is None and follower.latest is pushed[-1]
    # Three planes: a sample waits for the next.
    assert pushed[-1].t == whole.times[-2] and len(follower.finish()) == 1
    known = {estimate.t: estimate for estimate in pushed if estimate is not None}
    for k in range(25, len(whole.times) - 1, 20):
        assert np.array_equal(known[whole.times[k]].position, whole.position[k], equal_nan=True)
    assert whole.left_out == (0, None) == follower.left_out
    assert follower.push(list(rows[-1] + 0.001 * (np.arange(rows.shape[1]) == 0))) is not None
    truth = np.column_stack([table[f"cm{axis}"] for axis in "xyz"])
    assert whole.reliable.any() and whole.found is not None
    error = np.linalg.norm(whole.position - truth, axis=1)[whole.reliable]
    assert (error < 6.0 * whole.deviations[whole.reliable, 0] + 1e-9).all(), "errors beyond what is said of them"
