"""Mapping and navigation with the real simulator, in one small room: passed, and interrupted."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import cv2
import pytest

pytestmark = pytest.mark.processes
SCRIPT = Path(__file__).parent.parent / "scripts" / "navigate.py"
LIMIT = 240.0  # s, wall, for all of it on a slow machine
START_LIMIT = 120.0  # s, wall
END_LIMIT = 60.0  # s, wall, to end all and write what there is
WALL = """<model name="{name}"><static>true</static><pose>{x} {y} 0.5 0 0 0</pose><link name="l">
<collision name="c"><geometry><box><size>{dx} {dy} 1</size></box></geometry></collision></link>
</model>"""
WALLS = (("north", 0, 1.5, 4.2, 0.2), ("south", 0, -1.5, 4.2, 0.2), ("east", 2, 0, 0.2, 3),
         ("west", -2, 0, 0.2, 3), ("post", 1.2, 0.2, 0.3, 0.3), ("box", -1.6, 1.1, 0.6, 0.4))
HOUSE = """world: {world}
model: waffle
start: [-0.8, -0.4, 0.0]
laser_height: 0.132
laser_reach: 3.0
passable: 0.26
max_speed: 0.26
goal_clearance: 0.45
goal_distance: 0.8
way_points: [[0.3, -0.4], [0.0, 0.6]]
"""


class Run:
    """navigate.py as a process, with its output in a file."""

    def __init__(self, folder: Path, *arguments: str):
        world, house, self.out = folder / "room.world", folder / "room.yaml", folder / "out"
        walls = "".join(WALL.format(name=name, x=x, y=y, dx=dx, dy=dy)
                        for name, x, y, dx, dy in WALLS)
        world.write_text("<sdf version='1.6'><world name='room'>"
                         f"<include><uri>model://ground_plane</uri></include>{walls}</world></sdf>")
        house.write_text(HOUSE.format(world=world))
        self._log = folder / "output.txt"
        command = [sys.executable, str(SCRIPT), "--house", str(house), "--out", str(self.out)]
        with self._log.open("wb") as output:
            self.process = subprocess.Popen([*command, *arguments], stdout=output,
                                            stderr=subprocess.STDOUT, start_new_session=True)

    @property
    def output(self) -> str:
        return self._log.read_text()

    def wait_for(self, what: str) -> None:
        until = time.monotonic() + START_LIMIT
        while what not in self.output:
            assert self.process.poll() is None, self.output
            assert time.monotonic() < until, self.output
            time.sleep(0.05)

    def processes(self) -> dict[int, str]:
        """Command lines of everything that this run started, by process id."""
        needle, found = f"ROS_LOG_DIR={self.out}/".encode(), {}
        for folder in Path("/proc").glob("[0-9]*"):
            try:
                if needle in (folder / "environ").read_bytes():
                    found[int(folder.name)] = (folder / "cmdline").read_bytes().decode()
            except OSError:
                continue
        return found


@pytest.fixture
def start(tmp_path) -> Iterator[Callable[..., Run]]:
    """Starts a run, and ends what a failed test leaves."""
    runs = []

    def start_run(*arguments: str) -> Run:
        runs.append(Run(tmp_path, *arguments))
        return runs[-1]

    yield start_run
    for run in runs:
        run.process.kill()
        run.process.wait()
        for pid in run.processes():
            with contextlib.suppress(ProcessLookupError):  # it ended meanwhile
                os.kill(pid, signal.SIGKILL)


@pytest.mark.timeout(LIMIT + 30)
def test_a_room_is_mapped_and_a_goal_in_it_reached(start):
    run = start("--goals", "1", "--seed", "1", "--real-time-factor", "2")
    code = run.process.wait(LIMIT)
    assert code in (0, 1), run.output
    report = json.loads((run.out / "report.json").read_text())
    # So short a way is too little for amcl's mean error to keep its limit every time.
    assert all(fault.startswith("localisation: ") for fault in report["faults"]), run.output
    assert code == bool(report["faults"])
    assert report["outcome"] == ("not passed" if code else "passed")
    assert report["goals_reached"] == 1
    mapping, navigation = report["mapping"], report["navigation"]
    assert [point["reached"] for point in mapping["way_points"]] == [True, True]
    assert 1.5 < mapping["distance_m"] < 6.0 and mapping["ate_rmse_m"] < 0.05
    assert mapping["wall_cells"] > 100
    assert 0.0 < navigation["told_off"]["m"] < 0.43
    assert navigation["mean_off"]["m"] < 0.1
    assert navigation["goals"][0]["off_m"] < 0.12
    for part, node in ((mapping, "turtlebot3_slam_gmapping"), (navigation, "amcl")):
        assert part["cpu_percent_of_a_core"][node] > 0.0
        assert part["cpu_percent_of_a_core"]["move_base"] > 0.0
    assert cv2.imread(str(run.out / "map.png")).shape[1] == 1400
    assert cv2.VideoCapture(str(run.out / "run.mp4")).read()[0]
    assert sorted(path.name for path in run.out.glob("*map*")) == [
        "map.json", "map.pgm", "map.png", "map.yaml"]
    assert run.processes() == {}


def test_ctrl_c_ends_everything_and_keeps_what_there_was(start, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "map.yaml").write_text("of the run before")
    run = start("--goals", "1")
    run.wait_for("way-point 1/2")
    run.process.send_signal(signal.SIGINT)
    assert run.process.wait(END_LIMIT) == 130, run.output
    assert run.output.splitlines()[-1] == "navigate: interrupted; all processes ended"
    assert json.loads((run.out / "report.json").read_text())["outcome"] == "ended early"
    assert (out / "map.yaml").read_text() == "of the run before"
    assert run.processes() == {}
