"""The style of all Python code, as `make lint` checks it, and of docstrings that name errors."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SIM = ROOT / "src/sim"
sys.path.insert(0, str(SIM / "bullet_sim/test"))

from documented_errors import Sources  # noqa: E402

PACKAGES = ("bullet_sim_ros", "sim_viewer")  # bullet_sim's own tests have this one, too
NEVER = {"bullet_sim_ros.control.controller_context": "action raises SimulationError"}


def test_ruff_finds_nothing():
    ruff = Path(sys.executable).with_name("ruff")
    done = subprocess.run([ruff, "check", "--output-format=concise"], text=True, cwd=ROOT,
                          capture_output=True)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture(scope="module")
def sources() -> Sources:
    return Sources.of(*(SIM / name / "src" / name for name in ("bullet_sim", *PACKAGES)))


@pytest.mark.parametrize("package", PACKAGES)
def test_public_functions_name_the_errors_that_they_raise(sources: Sources, package: str):
    found = [f"{module}:{line}" for module in sources.modules if module.startswith(package)
             for line in sources.silent(module)
             if not line.endswith(NEVER.get(module, "\n"))]
    assert not found, "\n".join(found)
