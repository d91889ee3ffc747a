"""One narrow yard and one person with the real simulator and the real move_base."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes
SCRIPT = Path(__file__).parent.parent / "scripts" / "navigation_trials.py"
LIMIT = 280.0  # s, wall, for 45 simulated seconds on a slow machine


def left_over(out: Path) -> list[str]:
    """Command lines of what this run started and did not end."""
    needle, found = f"ROS_LOG_DIR={out}/".encode(), []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if needle in (folder / "environ").read_bytes():
                found.append((folder / "cmdline").read_bytes().decode())
        except OSError:
            continue
    return found


@pytest.mark.timeout(LIMIT + 20)
def test_a_yard_is_crossed_and_a_person_comes_close(tmp_path):
    out = tmp_path / "out"
    done = subprocess.run(
        [sys.executable, str(SCRIPT), "--yards", "1", "--first-yard", "4", "--repeats", "1",
         "--crossings", "1", "--first-crossing", "1", "--real-time-factor", "2",
         "--out", str(out)], capture_output=True, text=True, timeout=LIMIT)
    assert (out / "report.json").exists(), done.stdout + done.stderr
    yard, crossing = json.loads((out / "report.json").read_text())["drives"]
    assert yard["outcome"] == "reached", done.stdout
    assert yard["time"] > yard["straight_time"] and 0.0 < yard["to_obstacles"] < 0.2
    assert crossing["outcome"] in ("reached", "contact", "walked into"), done.stdout
    assert crossing["to_person"] < 0.4  # whoever did not walk would be 2 m away
    assert left_over(out) == []
