"""The shipped parameter file, and a node's own parameters."""

import sys
from dataclasses import fields
from pathlib import Path
from unittest.mock import MagicMock, call

import pytest
from ai_robot_tracking import parameters
from ai_robot_tracking.follower import FollowerSettings
from node_basics.settings import SettingsError, load_settings

CONFIG = Path(__file__).resolve().parents[1] / "config" / "tracking_params.yaml"


def test_the_file_has_every_key():
    settings = load_settings(FollowerSettings, CONFIG, "visual_tracker_pid", {})
    assert all(isinstance(getattr(settings, entry.name), float) for entry in fields(settings))


def test_one_value_in_place_of_all_parameters_is_refused(monkeypatch):
    rospy = MagicMock()
    rospy.get_param.return_value, rospy.get_name.return_value = 3, "/visual_tracker_pid"
    monkeypatch.setattr(parameters, "rospy", rospy)
    with pytest.raises(SettingsError, match="rosparam delete /visual_tracker_pid"):
        parameters.own_parameters()


def test_what_the_command_line_gave_does_not_stay_for_the_next_run(monkeypatch):
    rospy = MagicMock()
    rospy.get_param.return_value = {"kp_turn": 3.0, "config": "mine.yaml"}
    monkeypatch.setattr(parameters, "rospy", rospy)
    monkeypatch.setattr(sys, "argv", ["visual_tracker_pid.py", "_kp_turn:=3.0", "image:=/camera"])
    assert parameters.own_parameters() == {"kp_turn": 3.0, "config": "mine.yaml"}
    assert rospy.delete_param.call_args_list == [call("~kp_turn")]
