"""What the master logged and the nodes refused, and what of it the rules do not allow."""

import pytest
from marking.conduct import Conduct, CourseNodes

COURSE = CourseNodes(
    nodes=frozenset({"/gazebo", "/rosout"}), topics=frozenset({"/odom", "/cmd_vel", "/rosout"}),
    services=frozenset({"/gazebo/pause_physics"}), parameters=frozenset({"/use_sim_time"}),
    may_publish=frozenset({"/cmd_vel", "/rosout"}))
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


@pytest.mark.parametrize(("refused", "name", "says"), [
    ("service", "/gazebo/set_model_state", "it called /gazebo/set_model_state"),
    ("publisher", "/cmd_vel",
     "it fed /gazebo a publisher of /cmd_vel that the master does not know"),
    ("parameter", "/rate", "it sent /gazebo the parameter /rate past the master"),
    ("shutdown", "", "it asked the node /gazebo to end"),
    ("launch", "", "it sent roslaunch a report, which only another roslaunch may"),
])
def test_what_the_nodes_refused(refused, name, says):
    conduct = Conduct(COURSE)
    conduct.see_refusals([{"guarded": 7}, {"node": "/gazebo", "refused": refused, "name": name,
                                           "uri": "http://made:up/"}])
    assert conduct.violations == [says]


def test_many_and_long_names_stay_a_few_short_lines():
    conduct = Conduct(COURSE)
    conduct.see_registrations(f"{START}+PARAM [/gazebo/{each:03}{'x' * 1000}] by /x"
                              for each in range(100))
    assert len(conduct.violations) == 21
    assert conduct.violations[-1] == "and 80 things more"
    assert max(map(len, conduct.violations)) == 300


def test_a_publisher_that_was_registered_and_is_gone_did_nothing_wrong():
    conduct = Conduct(COURSE)
    conduct.see_registrations([START + "+PUB [/cmd_vel] /brief http://localhost:1/",
                               START + "-PUB [/cmd_vel] /brief http://localhost:1/"])
    conduct.see_refusals([{"node": "/gazebo", "refused": "publisher", "name": "/cmd_vel",
                           "uri": "http://localhost:1/"}])
    assert conduct.violations == []
