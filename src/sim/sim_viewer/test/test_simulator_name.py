"""The simulator is found in whatever namespace it runs."""

import pytest
from sim_viewer.tools.master import SystemState, simulator_name


@pytest.mark.parametrize(("services", "name"), [
    ([], "/gazebo"),
    (["/gazebo/pause_physics", "/a/gazebo/pause_physics"], "/gazebo"),
    (["/arena/sim/pause_physics", "/arena/sim/reset_world"], "/arena/sim"),
])
def test_the_one_that_can_be_paused(services, name):
    assert simulator_name(SystemState({}, {}, {one: ["/n"] for one in services})) == name
