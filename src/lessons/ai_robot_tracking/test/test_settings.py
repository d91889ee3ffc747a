"""The parameter file, whose mistakes are one line, and a node's own parameters."""

import sys
from dataclasses import fields
from pathlib import Path
from unittest.mock import MagicMock, call

import pytest
import yaml
from ai_robot_tracking import parameters
from ai_robot_tracking.follower import FollowerSettings
from ai_robot_tracking.settings import SettingsError, load_settings
from visual_tracker import PageSettings

CONFIG = Path(__file__).resolve().parents[1] / "config" / "tracking_params.yaml"
SECTIONS = {"visual_tracker": PageSettings, "visual_tracker_pid": FollowerSettings}


@pytest.fixture
def changed(tmp_path):
    """A function that writes the file with changes to the PID tracker's section."""
    def write(**changes):
        values = yaml.safe_load(CONFIG.read_text(encoding="utf-8"))
        section = values["visual_tracker_pid"]
        for key, value in changes.items():
            section[key] = value
            if value is None:
                del section[key]
        path = tmp_path / "mine.yaml"
        path.write_text(yaml.safe_dump(values), encoding="utf-8")
        return path

    return write


@pytest.mark.parametrize("section", SECTIONS)
def test_the_file_has_every_key(section):
    settings = load_settings(SECTIONS[section], CONFIG, section, {})
    assert all(isinstance(getattr(settings, entry.name), float) for entry in fields(settings))


@pytest.mark.parametrize(("changes", "said"), [
    ({"kp_trun": 2.0}, "unknown key 'kp_trun'"),
    ({"kp_turn": None}, "missing key 'kp_turn'"),
    ({"kp_turn": "fast"}, "'kp_turn' must be a number from 0 to 20, not 'fast'"),
    ({"kp_turn": -1}, "'kp_turn' must be"),
    ({"kp_turn": float("nan")}, "'kp_turn' must be"),
    ({"kp_turn": True}, "'kp_turn' must be"),
    ({"kp_turn": 10**400}, "'kp_turn' must be"),
])
def test_mistakes(changed, changes, said):
    path = changed(**changes)
    with pytest.raises(SettingsError) as raised:
        load_settings(FollowerSettings, path, "visual_tracker_pid", {})
    assert said in str(raised.value)
    assert str(path) in str(raised.value)


def test_parameters_win_and_are_checked():
    def load(**given):
        return load_settings(FollowerSettings, CONFIG, "visual_tracker_pid", given)

    assert load(kp_turn=3).kp_turn == 3.0
    for given in ({"kp_turn": "x"}, {"speed": 1.0}):
        with pytest.raises(SettingsError, match="the node's parameters"):
            load(**given)


@pytest.mark.parametrize("text", ["", "visual_tracker_pid: 3", "[1, 2", "\x00", "a: 2026-13-45",
                                  "a: !!timestamp x", "a: !!int ''", "a: !!bool x", "[" * 1000])
def test_no_table(tmp_path, text):
    path = tmp_path / "mine.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SettingsError, match=r"mine\.yaml"):
        load_settings(FollowerSettings, path, "visual_tracker_pid", {})
    with pytest.raises(SettingsError, match=r"none\.yaml"):
        load_settings(FollowerSettings, tmp_path / "none.yaml", "visual_tracker_pid", {})


def test_one_value_in_place_of_all_parameters_is_refused(monkeypatch):
    rospy = MagicMock()
    rospy.get_param.return_value, rospy.get_name.return_value = 3, "/visual_tracker"
    monkeypatch.setattr(parameters, "rospy", rospy)
    with pytest.raises(SettingsError, match="rosparam delete /visual_tracker"):
        parameters.own_parameters()


def test_what_the_command_line_gave_does_not_stay_for_the_next_run(monkeypatch):
    rospy = MagicMock()
    rospy.get_param.return_value = {"kp_turn": 3.0, "config": "mine.yaml"}
    monkeypatch.setattr(parameters, "rospy", rospy)
    monkeypatch.setattr(sys, "argv", ["visual_tracker_pid.py", "_kp_turn:=3.0", "image:=/camera"])
    assert parameters.own_parameters() == {"kp_turn": 3.0, "config": "mine.yaml"}
    assert rospy.delete_param.call_args_list == [call("~kp_turn")]
