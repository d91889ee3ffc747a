"""The avoid trial: what counts as reached, late or a contact, and one hall that is driven."""

import json
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

import pytest

from evaluation import avoid as drive
from evaluation.avoid import AvoidTrial
from run_session.failure import RunError

pytestmark = pytest.mark.processes
PACKAGE = Path(__file__).resolve().parents[1]
QUICK = "4"  # a hall that is passed in 37 s
GROUND = [["ground_plane", drive.WAFFLE]]


def state(time, x, y=0.0, contacts=()):
    return {"time": time, "poses": {drive.WAFFLE: [x, y, 0, 0, 0, 0, 1]},
            "contacts": [*GROUND, *contacts], "unanswered": 0}


@pytest.mark.parametrize(("last", "outcome"), [
    (state(30.0, 8.01), drive.REACHED),
    (state(30.0, 7.9), None),
    (state(120.1, 7.9), drive.LATE),
    (state(30.0, 9.0, contacts=[["hall", drive.WAFFLE]]), drive.CONTACT),
])
def test_outcomes(last, outcome):
    assert drive.outcome(last) == outcome


class Waiting:
    """Looks, and lets the simulator write its next line in parts."""

    def __init__(self, path, parts):
        self._path, self._parts = path, list(parts)

    def wait_for(self, _what, condition, _limit):
        while not condition():
            with self._path.open("a") as log:
                log.write(self._parts.pop(0))


def test_the_states_are_read_while_lines_are_half_written(tmp_path):
    states = [state(0.0, 0.0), state(1.0, 7.9), state(2.0, 8.1), state(3.0, 9.0)]
    lines = "".join(json.dumps(each) + "\n" for each in ({"called": "pause"}, *states))
    parts = [lines[begin:begin + 100] for begin in range(0, len(lines), 100)]
    log = tmp_path / "state.jsonl"
    log.touch()
    assert drive.watch(Waiting(log, parts), log) == states[:3]
    log.write_text(lines)
    assert drive.watch(Waiting(log, []), log) == states[:3]
    log.write_text("no state\n")
    with pytest.raises(RunError, match="log of states"):
        drive.watch(Waiting(log, []), log)


def test_a_result_is_read_back_as_it_was_written():
    found = drive.scored("hall-3", 3, [state(0.0, 0.0), state(20.0, 4.0, 1.3), state(40.0, 8.1)])
    assert found.outcome == drive.REACHED and found.distance == pytest.approx(8.5, abs=0.1)
    assert found.nearest <= 0.2  # the wall
    trial = AvoidTrial()
    assert trial.from_values(json.loads(json.dumps(trial.values([found])))) == [found]
    assert trial.passed([found]) and "reached" in trial.line(found)


def test_a_mistyped_script_is_one_line():
    with pytest.raises(RunError, match=r"no avoider 'avoid.py' .*there are: avoid_obstacles.py"):
        AvoidTrial().parse(["--avoider", "avoid.py"])


def test_it_drives_through_a_hall(tmp_path, monkeypatch):
    monkeypatch.setenv("TURTLEBOT3_MODEL", "burger")  # as a reader has it set for other lessons
    done = subprocess.run(
        [sys.executable, str(PACKAGE / "scripts" / "avoid.py"), "--seeds", "1",
         "--first-seed", QUICK, "--out", str(tmp_path)],
        capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    (found,) = AvoidTrial().from_values(json.loads((tmp_path / "report.json").read_text()))
    assert found.outcome == drive.REACHED and found.unanswered == 0
    assert (tmp_path / f"halls/hall-{QUICK}.html").stat().st_size > 1_000_000
    assert (tmp_path / "paths.png").exists() and asdict(found)["path"][-1][0] > 8.0
