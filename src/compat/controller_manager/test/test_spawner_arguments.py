"""The command line of spawner."""

import pytest
from controller_manager import configuration, spawning


def test_upstreams_options():
    options = spawning.arguments().parse_args(["--namespace=/rrbot", "a", "b"])
    assert (options.namespace, options.controllers, options.timeout) == ("/rrbot", ["a", "b"], 30)
    assert (options.stopped, options.wait_for, options.no_timeout, options.shutdown_timeout) \
        == (False, None, False, None)
    options = spawning.arguments().parse_args(
        "--stopped --wait-for go --timeout 0 --no-timeout --shutdown-timeout 3 a".split())
    assert (options.stopped, options.wait_for, options.timeout, options.no_timeout) \
        == (True, "go", 0.0, True)


def test_a_controller_is_needed(capsys):
    with pytest.raises(SystemExit) as ended:
        spawning.arguments().parse_args([])
    assert ended.value.code == 2
    assert "controller" in capsys.readouterr().err


def test_what_is_a_file(tmp_path):
    (tmp_path / "arm").write_text("")
    assert configuration.is_file_name(str(tmp_path / "arm"))
    assert configuration.is_file_name("none.yaml")
    assert not configuration.is_file_name("joint_state_controller")
