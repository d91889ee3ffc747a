"""Each script, started without ROS: it drives by the first picture."""

import ast
import runpy
from importlib import import_module
from pathlib import Path
from unittest.mock import Mock

import numpy as np
import pytest
import rospkg
import rospy
from learning_autorace.ground import LASER_FORWARD, laser_points, load_calibration
from sensor_msgs.msg import Image, LaserScan

LANE = import_module("02lane")
PACKAGE = Path(__file__).resolve().parent.parent
SCRIPTS = sorted(PACKAGE.glob("scripts/0[2-7]*.py"))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.name)
def test_a_script_drives(script, monkeypatch):
    made = []
    monkeypatch.setattr(LANE, "run", lambda name, missions=(): made.append((name, missions)))
    import_module(script.stem).main()
    ((name, missions),) = made
    assert name.startswith("autorace_")
    driver = LANE.Driver(load_calibration(PACKAGE / "config" / "camera.yaml"), missions)
    image, view = np.zeros((240, 320, 3), np.uint8), np.zeros((100, 160, 3), np.uint8)
    speed, turn = driver.drive(LANE.Seen(0.0, image, view))
    assert speed > 0.0 and turn == 0.0


def test_beams_that_meet_nothing_are_left_out_without_a_warning():
    scan = LaserScan(angle_increment=np.pi / 2, range_min=0.1, range_max=3.5,
                     ranges=[np.inf, 1.0, np.inf, 0.0])
    with np.errstate(all="raise"):
        points = laser_points(scan)
    assert points == pytest.approx(np.array([[LASER_FORWARD, 1.0]]))


@pytest.mark.parametrize("encoding, length", [("bgr8", 3), ("nonsense", 24)])
def test_a_message_that_is_no_picture_is_one_line(monkeypatch, encoding, length):
    said, robot = [], object.__new__(LANE.Node)  # its topics need a master
    robot.bridge = LANE.cv_bridge.CvBridge()
    monkeypatch.setattr(LANE.rospy, "logwarn_throttle", lambda _, line: said.append(line))
    robot.take_image(Image(encoding=encoding, width=4, height=2, step=12, data=bytes(length)))
    assert len(said) == 1 and said[0].startswith("an image that cannot be used: ")


@pytest.mark.parametrize("ending, said", [(True, []), (False, ["no light and no bar: gone"])])
def test_the_mission_of_a_simulator_that_is_gone_is_one_line_at_most(monkeypatch, ending, said):
    script, lines = runpy.run_path(str(PACKAGE / "scripts" / "mission.py")), []
    mission = object.__new__(script["Mission"])  # its services need a simulator
    mission.light, mission.begin, mission.bar_wait, mission.shown = {"red": 1.0}, 0.0, 0.0, {}
    mission.models = Path(rospkg.RosPack().get_path("turtlebot3_gazebo")) / "models" / (
        "turtlebot3_autorace_2020")
    mission.spawn = mission.delete = Mock(side_effect=rospy.ServiceException("gone"))
    monkeypatch.setattr(rospy, "get_time", lambda: 0.0)
    monkeypatch.setattr(rospy, "is_shutdown", lambda: ending)
    monkeypatch.setattr(rospy, "logwarn_throttle", lambda _, line: lines.append(line))
    mission.work()
    assert lines == said


def test_a_mission_that_is_ended_at_its_start_says_nothing(monkeypatch):
    script = runpy.run_path(str(PACKAGE / "scripts" / "mission.py"))
    for name, value in (("init_node", None), ("get_param", 0), ("is_shutdown", True)):
        monkeypatch.setattr(rospy, name, Mock(return_value=value))
    monkeypatch.setitem(script["main"].__globals__, "Mission",
                        Mock(side_effect=rospy.ROSInterruptException("rospy shutdown")))
    with pytest.raises(SystemExit) as ended:
        script["main"]()
    assert ended.value.code is None


def test_all_lessons_are_there_and_small():
    """At most 120 lines without empty ones, comments and docstrings."""
    assert [path.name[:2] for path in SCRIPTS] == ["02", "03", "04", "05", "06", "07"]
    for path in [*PACKAGE.glob("scripts/*.py"), *PACKAGE.glob("src/learning_autorace/*.py")]:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        docstrings = [node.body[0] for node in ast.walk(tree)
                      if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef)
                      and ast.get_docstring(node)]
        documentation = {line for each in docstrings
                         for line in range(each.lineno, each.end_lineno + 1)}
        lines = [line.strip() for line in path.read_text(encoding="utf-8").splitlines()]
        code = [line for number, line in enumerate(lines, 1)
                if line and not line.startswith("#") and number not in documentation]
        assert len(code) <= 120, path
