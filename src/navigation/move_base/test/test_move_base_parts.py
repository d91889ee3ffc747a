"""The parts of move_base that need no master."""

import math
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
import yaml
from ackermann_msgs.msg import AckermannDriveStamped
from geometry_msgs.msg import Quaternion

from move_base import recoveries
from move_base.base import ackermann, twist
from move_base.global_planners import GLOBAL_PLANNERS
from move_base.goals import fault_of
from move_base.local_planners import LOCAL_PLANNERS
from move_base.plugin import PARAMS, chosen, table
from move_base.recoveries import RECOVERIES
from move_base.services import offsets, square
from nav_algorithms.costmap.costs import Costmap
from nav_nodes.parameters import ParameterError


@pytest.fixture
def costmap():
    """4 m x 4 m of free floor."""
    return Costmap(np.zeros((40, 40), np.uint8), 0.1, (0.0, 0.0))


@pytest.mark.parametrize("path", sorted(PARAMS.glob("*.yaml")), ids=lambda path: path.stem)
def test_every_table_is_sound(path):
    """Types, defaults and ranges fit each other."""
    assert table(path.stem)


@pytest.mark.parametrize("planner", [*GLOBAL_PLANNERS.values(), *LOCAL_PLANNERS.values()],
                         ids=lambda planner: planner.NAME)
def test_every_setting_is_in_the_table(planner):
    """What the algorithm can be told, the node can be."""
    names = {field.name for field in fields(planner.SETTINGS)} - {"controller_frequency"}
    assert names <= {entry.name for entry in table(planner.TABLE)}


def test_a_planner_is_chosen_by_either_name():
    """With its package, or as older launch files have it."""
    for name in ("navfn/NavfnROS", "NavfnROS"):
        assert chosen(name, GLOBAL_PLANNERS, "x").NAME == "NavfnROS"


def test_an_unknown_name_says_what_there_is():
    """And where it was set."""
    with pytest.raises(ParameterError, match=r"~base_local_planner is 'teb'.*DWAPlannerROS"):
        chosen("teb", LOCAL_PLANNERS, "~base_local_planner")


@pytest.mark.parametrize(("q", "words"), [
    (Quaternion(0, 0, math.inf, 1), "nans or infs"), (Quaternion(), "close to zero"),
    (Quaternion(0.5, 0, 0, 0.5), "vertical"), (Quaternion(1, 0, 0, 0), "vertical")])
def test_faults_of_a_quaternion(q, words):
    """Upstream's three."""
    assert words in fault_of(q)


def test_a_turn_about_z_has_no_fault():
    """Of any length that is not nearly 0."""
    assert fault_of(Quaternion(0, 0, 0.3, 0.1)) is None


def test_commands():
    """The car's front wheels turn so that it drives the same arc, backwards as well."""
    message = twist(np.array([0.2, 0.1, -1.0]))
    assert (message.linear.x, message.linear.y, message.angular.z) == (0.2, 0.1, -1.0)
    for speed in (1.0, -1.0):
        drive = ackermann(np.array([speed, 0.0, 0.5]), 0.325, None).drive
        assert drive.speed == speed
        assert speed * math.tan(drive.steering_angle) / 0.325 == pytest.approx(0.5)
    assert ackermann(np.zeros(3), 0.325, None).drive == AckermannDriveStamped().drive


def test_offsets_go_outwards_as_upstreams():
    """Rings of three cells; none beyond the tolerance; both sides of an axis but each once."""
    found = [(round(x / 0.15), round(y / 0.15)) for x, y in offsets(0.3, 0.05)]
    assert len(found) == len(set(found)) == 24
    assert [max(abs(x), abs(y)) for x, y in found] == [1] * 8 + [2] * 16
    assert found[0] == (-1, 0)
    assert list(offsets(0.0, 0.05)) == []
    assert {round(max(abs(x), abs(y)), 3) for x, y in offsets(0.1, 0.05)} == {0.1}


def test_square_stays_in_the_costmap(costmap):
    """Also where the robot stands outside."""
    costmap.cells[square(costmap, np.array([0.05, 2.05, 0.0]), 0.2)] = 1
    assert costmap.cells[18:23, :3].all() and costmap.cells.sum() == 15
    assert costmap.cells[square(costmap, np.array([-9.0, 2.0, 0.0]), 0.2)].size == 0


@pytest.fixture
def loaded(monkeypatch):
    """Names and kinds of the behaviours that move_base's values stand for."""
    monkeypatch.setattr(recoveries.rospy, "set_param", lambda *_: None)
    monkeypatch.setattr(recoveries.rospy, "resolve_name", lambda name: name)
    monkeypatch.setattr(recoveries, "read_parameters",
                        lambda entries, _: {entry.name: entry.default for entry in entries})

    def load(**changes):
        values = {entry.name: entry.default for entry in table("move_base")} | changes
        return [(each.name, type(each)) for each in recoveries.load(values, 0.5)]

    return load


def test_the_usual_recoveries(loaded):
    """A robot that may not turn on the spot does not; a car backs out."""
    assert [name for name, _ in loaded()] == [
        "conservative_reset", "rotate_recovery", "aggressive_reset", "rotate_recovery"]
    assert [name for name, _ in loaded(clearing_rotation_allowed=False)] == [
        "conservative_reset", "aggressive_reset"]
    assert [name for name, _ in loaded(command_type="ackermann")] == [
        "conservative_reset", "escape", "aggressive_reset", "escape"]


def test_with_robust_yaml_the_robot_leaves_what_it_touches_before_it_turns(loaded):
    robust = yaml.safe_load((Path(__file__).parents[1] / "config/robust.yaml").read_text())
    assert [name for name, _ in loaded(**robust)] == [
        "conservative_reset", "escape", "rotate_recovery",
        "aggressive_reset", "escape", "rotate_recovery"]


def test_a_list_of_ones_own(loaded):
    """Any of the types; with one that there is not, nothing begins."""
    own = [{"name": kind.__name__, "type": name} for name, kind in RECOVERIES.items()]
    assert [kind for _, kind in loaded(recovery_behaviors=own)] == list(RECOVERIES.values())
    with pytest.raises(ParameterError, match="RotateRecovery"):
        loaded(recovery_behaviors=[{"name": "a", "type": "b/C"}])


@pytest.mark.parametrize("broken", [
    [{"name": "a"}], ["a"], [{"name": "a", "type": "rotate_recovery/RotateRecovery"}] * 2])
def test_a_list_that_makes_no_sense_is_passed_over(loaded, broken):
    """As upstream: the usual ones are taken."""
    assert loaded(recovery_behaviors=broken) == loaded()
