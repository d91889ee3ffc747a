"""send_goal.py: what is no place is said before anything is asked."""

import importlib.util
from pathlib import Path

import pytest

SCRIPT = Path(__file__).resolve().parents[1] / "scripts" / "send_goal.py"


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("send_goal", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("words, place", [
    (["1.5", "-1.5", "90"], (1.5, -1.5, 90.0)), (["1", "2"], (1.0, 2.0, 0.0))])
def test_a_place(script, words, place):
    assert script.place_of(words) == place


@pytest.mark.parametrize("words", [[], ["1"], ["1", "two"], ["nan", "1"], ["1", "inf"],
                                   ["1", "1", "90", "5"]])
def test_no_place(script, words):
    with pytest.raises(SystemExit, match=r"which place is .*\? e\.g\. rosrun nav_demo "):
        script.place_of(words)


@pytest.mark.parametrize("word", ["-h", "--help"])
def test_help(script, word, capsys):
    with pytest.raises(SystemExit) as end:
        script.place_of([word])
    assert end.value.code == 0 and "send_goal.py X Y [DEGREES]" in capsys.readouterr().out


@pytest.fixture
def grid(script):
    """4 x 2 cells of 0.5 m: the first unknown, the second occupied, all others free."""
    made = script.OccupancyGrid(data=[-1, 100, 0, 0, 0, 0, 0, 0])
    made.info.width, made.info.height, made.info.resolution = 4, 2, 0.5
    made.info.origin.position.x, made.info.origin.position.y = -1, -2
    return made


@pytest.mark.parametrize(("place", "why"), [
    ((30, 0), "30, 0 is off the map, which has x -1.0 to 1.0 m and y -2.0 to -1.0 m"),
    ((-0.1, -1.9), "the map has an obstacle at -0.1, -1.9")])
def test_where_no_car_can_be_no_goal_is_sent(script, grid, monkeypatch, place, why):
    monkeypatch.setattr(script, "newest_map", lambda: grid)
    with pytest.raises(SystemExit) as end:
        script.refuse_at_once(*place)
    assert end.value.code == f"the goal was not sent: {why}"


@pytest.mark.parametrize("place", [(-0.9, -1.9), (0.9, -1.1)])  # unknown, free
def test_elsewhere_and_without_a_map_move_base_decides(script, grid, monkeypatch, place):
    for found in (grid, None):
        monkeypatch.setattr(script, "newest_map", lambda found=found: found)
        script.refuse_at_once(*place)


def test_ctrl_c_before_there_is_a_clock_asks_nobody_any_more(script, monkeypatch):
    """The master may have ended: whatever asks it then ends with a traceback."""
    monkeypatch.setattr(script.sys, "argv", ["send_goal.py", "1", "1"])
    monkeypatch.setattr(script.rospy, "init_node", lambda *_, **__: None)
    monkeypatch.setattr(script.rospy, "is_shutdown", lambda: True)
    monkeypatch.setattr(script.rospy, "get_time", lambda: 0)
    monkeypatch.setattr(script.actionlib, "SimpleActionClient", None)
    with pytest.raises(SystemExit, match=r"^stopped before the goal was sent$"):
        script.main()


def test_ctrl_c_while_the_map_is_waited_for_sends_no_goal(script, monkeypatch):
    def interrupted(*_):
        raise script.rospy.ROSInterruptException("rospy shutdown")

    monkeypatch.setattr(script.rospy, "wait_for_message", interrupted)
    monkeypatch.setattr(script.rospy, "is_shutdown", lambda: True)
    with pytest.raises(SystemExit, match=r"^stopped before the goal was sent$"):
        script.refuse_at_once(1, 2)


def test_ctrl_c_on_the_way_says_that_the_goal_is_cancelled(script, monkeypatch):
    """Not move_base's text of when the goal was accepted."""
    is_over = []
    client = type("Client", (), {
        "send_goal": lambda *_, **__: None, "wait_for_result": lambda _: is_over.append(True)})
    monkeypatch.setattr(script.sys, "argv", ["send_goal.py", "1", "1"])
    monkeypatch.setattr(script.rospy, "init_node", lambda *_, **__: None)
    monkeypatch.setattr(script.rospy, "is_shutdown", lambda: bool(is_over))
    monkeypatch.setattr(script.rospy, "on_shutdown", lambda _: None)
    monkeypatch.setattr(script.rospy, "get_time", lambda: 1.0)
    monkeypatch.setattr(script.rospy.Time, "now", lambda: script.rospy.Time(1))
    monkeypatch.setattr(script.actionlib, "SimpleActionClient", lambda *_: client())
    monkeypatch.setattr(script, "wait_for_move_base", lambda _: None)
    monkeypatch.setattr(script, "refuse_at_once", lambda *_: None)
    with pytest.raises(SystemExit, match=r"^stopped on the way: the goal is cancelled$"):
        script.main()


def test_a_move_base_that_does_not_run_is_said_soon(script, monkeypatch):
    said, waited = [], []
    client = type("Client", (), {"wait_for_server": lambda _, time: waited.append(time.to_sec())})
    monkeypatch.setattr(script.rospy, "is_shutdown", lambda: False)
    monkeypatch.setattr(script.rospy, "loginfo", lambda line: said.append((line, *waited)))
    with pytest.raises(SystemExit, match="nobody answers as move_base: roslaunch nav_demo"):
        script.wait_for_move_base(client())
    assert said == [("waiting for move_base, for 30 s: roslaunch nav_demo nav05_test.launch", 2.0)]
    assert waited == [2.0, 30.0]
