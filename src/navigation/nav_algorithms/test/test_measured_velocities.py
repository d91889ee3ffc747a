"""What odometry says must not lead to commands beyond the limits, nor to late ones."""

import numpy as np
import pytest
from defaults import of

from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.local_planning.dwa import DwaPlanner, DwaSettings
from nav_algorithms.local_planning.pure_pursuit import PurePursuit, PurePursuitSettings
from nav_algorithms.local_planning.trajectory_rollout import (
    TrajectoryRollout,
    TrajectoryRolloutSettings,
)
from nav_algorithms.local_planning.velocities import Limits

SQUARE = np.array([[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]])
ALONG = np.linspace(0.0, 1.5, 40)
STRAIGHT = np.column_stack((ALONG, 0 * ALONG, 0 * ALONG))
TURNED = np.array([[0.0, 0.0, 0.0], [0.01, 0.0, 2.0]])  # there already, but for the yaw

MAKERS = [
    lambda: DwaPlanner(of(DwaSettings, max_vel_trans=0.3, max_vel_x=0.3, min_vel_x=-0.2)),
    lambda: DwaPlanner(of(DwaSettings, use_dwa=False, min_vel_x=0.05)),
    lambda: TrajectoryRollout(of(TrajectoryRolloutSettings)),
    lambda: TrajectoryRollout(of(TrajectoryRolloutSettings, dwa=False, holonomic_robot=False)),
    lambda: PurePursuit(of(PurePursuitSettings)),
    lambda: PurePursuit(of(PurePursuitSettings, turn_in_place=True))]
MEASURED = [(100.0, 0.0, 0.0), (-50.0, 0.0, 0.0), (0.0, 0.0, 1e5), (0.3, 0.0, -1e5),
            (1e5, 2.0, 3.0), (0.9, 0.0, 2.0), (-0.3, -0.3, 0.0)]


@pytest.fixture
def costmap():
    """5 m x 5 m of free floor around the robot."""
    return Costmap(np.zeros((100, 100), np.uint8), 0.05, (-2.5, -2.5))


@pytest.mark.parametrize("path", [STRAIGHT, TURNED], ids=["on the way", "at the goal"])
@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("measured", MEASURED)
def test_no_command_exceeds_the_limits(costmap, make, measured, path):
    """Nor is it looked at in more steps: 1e5 rad/s took seconds, and one answer was 1e5 rad/s."""
    planner = make()
    planner.set_path(path)
    command = planner.command(costmap, SQUARE, np.zeros(3), np.array(measured))
    limits = planner.limits()
    if command is not None:
        assert command.velocity == pytest.approx(limits.clip(command.velocity), abs=1e-12)
        assert len(command.trajectory) < 200


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("measured", [(np.nan, 0, 0), (0, 0, np.inf), (-np.inf, 0, 0)])
def test_no_command_by_what_is_no_number(costmap, make, measured):
    """Instead of a traceback, or a command that is none either."""
    planner = make()
    planner.set_path(STRAIGHT)
    assert planner.command(costmap, SQUARE, np.zeros(3), np.array(measured)) is None


def test_limits():
    """Standing is always within them; a slower robot keeps its direction."""
    limits = Limits((0.1, -0.2, -1.0), (0.5, 0.2, 2.0), 0.25)
    assert limits.clip(np.zeros(3)).tolist() == [0.0, 0.0, 0.0]
    assert limits.clip(np.array([-1.0, 0.1, 9.0])).tolist() == [0.0, 0.1, 2.0]
    assert limits.clip(np.array([0.4, 0.3, -9.0])) == pytest.approx(
        [0.1 * 5 ** 0.5, 0.05 * 5 ** 0.5, -1.0])
    assert limits.fastest == (0.25, 2.0)
    assert Limits((-0.3, -0.1, -1.0), (0.2, 0.4, 0.5)).fastest == pytest.approx((0.5, 1.0))


@pytest.mark.parametrize("slowest", [0.0, -0.2])
def test_a_turn_at_the_goal_goes_to_the_right_too(costmap, slowest):
    """min_vel_theta is of the way; clipped to it, such a turn would never come."""
    planner = TrajectoryRollout(of(TrajectoryRolloutSettings, min_vel_theta=slowest))
    planner.set_path(np.array([[0.0, 0.0, 0.0], [0.01, 0.0, -1.0]]))
    velocity = np.zeros(3)
    for _ in range(5):  # it speeds up
        velocity = planner.command(costmap, SQUARE, np.zeros(3), velocity).velocity
    assert velocity[2] <= -0.4
