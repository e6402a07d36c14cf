"""What the tests share: scenes, logs, and the command that they compare with."""

from __future__ import annotations

import importlib.util
import math
import os
import shutil
import subprocess
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import recon

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "crates" / "recon-cli" / "scenes"


@pytest.fixture(scope="session")
def command() -> str:
    """The command: RECON_COMMAND, one that cargo built, or the script that came with the package."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    built = [target / profile / "recon" for profile in ("release", "debug")]
    found = [os.environ.get("RECON_COMMAND"), *(str(path) for path in built if path.is_file()), shutil.which("recon")]
    names = [name for name in found if name]
    assert names, "no command `recon`: build it (cargo build -p recon-touch-cli), or install the package"
    return names[0]


def run(command: str, *words: str, codes: tuple[int, ...] = (0,)) -> subprocess.CompletedProcess[str]:
    made = subprocess.run([command, *words], capture_output=True, text=True, check=False)
    assert made.returncode in codes, f"{words}: {made.returncode}\n{made.stderr}"
    return made


def many_logs_example() -> ModuleType:
    """The example that maps over logs."""
    spec = importlib.util.spec_from_file_location("many_logs", ROOT / "python" / "examples" / "many_logs.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def same_row(a: dict[str, Any], b: dict[str, Any]) -> bool:
    """Whether two rows of a table are equal to the last bit, in the same columns; nan is equal to nan."""
    nan = [name for name, value in a.items() if isinstance(value, float) and math.isnan(value)]
    return list(a) == list(b) and all(math.isnan(b[name]) if name in nan else a[name] == b[name] for name in a)


@pytest.fixture(scope="session")
def fig5() -> dict[str, object]:
    """The scene of the paper's Fig. 5, over 1.5 s."""
    azimuths = (270.0, 30.0, 150.0)
    return {
        "gravity": 9.81,
        "object": {"mass": 1.0, "principal_moments": [1.0, 1.45, 2.05]},
        "simulation": {
            "duration": 1.5,
            "sample_rate": 1000.0,
            "orientation": [1.0, 0.0, 0.0, 0.0],
            "angular_velocity": [0.0, 0.3, 0.3],
            "shape": {"kind": "ellipsoid", "semi_axes": [2.5, 2.0, 1.0]},
            "palms": [{"azimuth_deg": azimuth, "slope_deg": 60.0} for azimuth in azimuths],
        },
    }


@pytest.fixture(scope="session")
def simulation(fig5: dict[str, object]) -> recon.Simulation:
    return recon.simulate(fig5)


@pytest.fixture(scope="session")
def log(simulation: recon.Simulation) -> recon.Log:
    return simulation.log


@pytest.fixture(scope="session")
def result(log: recon.Log, fig5: dict[str, object]) -> recon.Reconstruction:
    return recon.reconstruct(log, fig5)


@pytest.fixture(scope="session")
def palms_scene() -> str:
    """Three fingertips that take an ellipsoid from a table, with friction and noise."""
    return str(SCENES / "pick-up.toml")


@pytest.fixture(scope="session")
def palms_simulation(palms_scene: str) -> recon.Simulation:
    return recon.simulate(palms_scene, tolerance=1e-8, report=True)


@pytest.fixture(scope="session")
def palms_log(palms_simulation: recon.Simulation, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("palms") / "log.csv"
    path.write_text(palms_simulation.log.to_csv(), encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def palms_result(palms_log: Path, palms_scene: str) -> recon.Reconstruction:
    return recon.reconstruct(palms_log, palms_scene)


@pytest.fixture(scope="session")
def files(tmp_path_factory: pytest.TempPathFactory, command: str) -> Path:
    """A folder with the scene of Fig. 5 over 1.5 s and its log, as the command makes them."""
    folder = tmp_path_factory.mktemp("fig5")
    text = (SCENES / "fig5.toml").read_text(encoding="utf-8")
    assert "duration = 4.2" in text
    (folder / "scene.toml").write_text(text.replace("duration = 4.2", "duration = 1.5"), encoding="utf-8")
    run(command, "simulate", str(folder / "scene.toml"), "-o", str(folder / "log.csv"))
    return folder


@pytest.fixture(scope="session")
def small(tmp_path_factory: pytest.TempPathFactory, command: str) -> Path:
    """What `recon init` gives: an object of a few centimetres, whose motion is found within the log."""
    folder = tmp_path_factory.mktemp("small") / "start"
    run(command, "init", str(folder))
    return folder
