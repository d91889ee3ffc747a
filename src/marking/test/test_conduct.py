"""What simulator and master logged, and what of it the rules do not allow."""

from collections import Counter

import pytest
from marking.conduct import Conduct, Course

COURSE = Course(
    nodes=frozenset({"/gazebo", "/rosout"}), topics=frozenset({"/odom", "/cmd_vel", "/rosout"}),
    services=frozenset({"/gazebo/pause_physics"}), parameters=frozenset({"/use_sim_time"}),
    may_publish=frozenset({"/cmd_vel", "/rosout"}), may_call=frozenset({"/gazebo/get_model_state"}),
    own_calls=Counter(["/gazebo/unpause_physics"]))
START = "[rosmaster.master][INFO] 2026-11-24 04:48:48,060: "


@pytest.mark.parametrize(("line", "says"), [
    ("+PUB [/cmd_vel] /follower http://localhost:1/", []),
    ("+PUB [/my/debug] /follower http://localhost:1/", []),
    ("+SUB [/odom] /follower http://localhost:1/", []),
    ("-PUB [/cmd_vel] /follower http://localhost:1/", []),
    ("+PARAM [/my_gain] by /follower", []),
    ("+SERVICE [/follower/get_loggers] /follower http://localhost:1/", []),
    ("+PUB [/odom] /follower http://localhost:1/", ["it published /odom"]),
    ("+PUB [/odom] bare_name http://localhost:1/", ["it published /odom"]),
    ("-PUB [/odom] /gazebo http://localhost:1/", ["it unregistered the node /gazebo"]),
    ("+SUB [/x] /gazebo http://localhost:1/", ["it took the name of the node /gazebo"]),
    ("+SERVICE [/gazebo/pause_physics] /x http://localhost:1/",
     ["it offered the service /gazebo/pause_physics in place of the course's"]),
    ("+PARAM [/use_sim_time] by /x", ["it changed the parameter /use_sim_time"]),
    ("-PARAM [/gazebo/gravity_z] by /x", ["it deleted the parameter /gazebo/gravity_z"]),
    ("+PARAM [/] by /x", ["it changed the parameter /"]),
])
def test_registrations_at_the_master(line, says):
    conduct = Conduct(COURSE)
    conduct.see_registrations([START + line])
    assert conduct.violations == says


@pytest.mark.parametrize(("entries", "says"), [
    ([{"call": "/gazebo/get_model_state", "caller": "/x"}], []),
    ([{"call": "/gazebo/unpause_physics", "caller": "/judge"}], []),
    ([{"call": "/gazebo/unpause_physics", "caller": "/judge"}] * 2,
     ["it called /gazebo/unpause_physics"]),
    ([{"call": "/gazebo/set_model_state", "caller": "/judge"}] * 2,
     ["it called /gazebo/set_model_state"]),
    ([{"shutdown": "external shutdown request from [/x]: [end]"}], ["it ended the node /gazebo"]),
    ([{"shutdown": "the simulation has ended"}], []),
    ([{"time": 1.0, "poses": {}, "contacts": []}], []),
])
def test_calls_of_the_simulator(entries, says):
    conduct = Conduct(COURSE)
    for entry in entries:
        conduct.see_state(entry)
    assert conduct.violations == says
