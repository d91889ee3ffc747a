"""What a marked course's node does on the word of others, and what it records."""

import json
import os
import subprocess
import sys
import threading
from collections import Counter
from types import SimpleNamespace
from xmlrpc.server import SimpleXMLRPCServer

import pytest

from marking import guard
from run_session.failure import RunError

MAY_CALL, OWN = "/gazebo/get_model_state", "/gazebo/unpause_physics"


@pytest.fixture
def sealed(tmp_path, monkeypatch):
    """A guarded node while a submission runs; the master lists http://a of /cmd_vel."""
    monkeypatch.setattr(guard, "_node", lambda: "/gazebo")
    monkeypatch.setattr(guard, "listed_publishers", lambda _caller, topic: (
        {"http://a"} if topic == "/cmd_vel" else set()))
    made = guard.Guard(tmp_path)
    guard.seal(tmp_path, [MAY_CALL], Counter([OWN]))
    return made


def record(folder):
    lines = (folder / guard.RECORD).read_text(encoding="utf-8").splitlines()
    assert json.loads(lines[0]) == {"guarded": os.getpid()}
    return [json.loads(line) for line in lines[1:]]


def test_before_the_submission_starts_anything_goes(tmp_path):
    made = guard.Guard(tmp_path)
    assert made.allows("publisher", "/odom", "http://b")
    assert made.allows("shutdown", "", "")
    assert record(tmp_path) == []


def test_publishers_are_those_of_the_master_by_topic_and_address(sealed, tmp_path):
    assert sealed.allows("publisher", "/cmd_vel", "http://a")
    assert not sealed.allows("publisher", "/cmd_vel", "http://b")
    assert not sealed.allows("publisher", "/odom", "http://a")
    assert not sealed.allows("publisher", "/odom", "http://a")  # is recorded once
    assert record(tmp_path) == [
        {"node": "/gazebo", "refused": "publisher", "name": "/cmd_vel", "uri": "http://b"},
        {"node": "/gazebo", "refused": "publisher", "name": "/odom", "uri": "http://a"}]


def test_the_judge_s_own_call_counts_once(sealed, tmp_path):
    assert sealed.allows("service", MAY_CALL, "") and sealed.allows("service", MAY_CALL, "")
    assert sealed.allows("service", OWN, "")
    assert not sealed.allows("service", OWN, "")
    assert not sealed.allows("service", "/gazebo/set_model_state", "")
    assert [each["name"] for each in record(tmp_path)] == [OWN, "/gazebo/set_model_state"]


@pytest.mark.parametrize("kind", ["parameter", "shutdown", "launch"])
def test_the_rest_is_the_master_s(sealed, kind):
    assert not sealed.allows(kind, "/x", "")


def test_the_environment_empties_an_earlier_try_s_record(sealed, tmp_path):
    environment = guard.environment(tmp_path)
    assert list(tmp_path.iterdir()) == []
    assert environment["PYTHONPATH"].split(os.pathsep)[0].endswith("guarded")


@pytest.mark.parametrize("imported", ["rospy", "roslaunch.server"])
def test_each_program_that_is_a_node_or_roslaunch_loads_the_guard(tmp_path, monkeypatch, imported):
    monkeypatch.setenv("PYTHONNOUSERSITE", "1")
    subprocess.run([sys.executable, "-c", f"import {imported}"], check=True,
                   env={**os.environ, **guard.environment(tmp_path)})
    lines = (tmp_path / guard.RECORD).read_text(encoding="utf-8").splitlines()
    assert lines and all(json.loads(line)["guarded"] for line in lines)


def test_a_course_with_a_node_that_is_not_guarded_is_not_driven(tmp_path):
    guard.Guard(tmp_path)
    with SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False) as node:
        pids = [os.getpid(), -1]
        node.register_function(lambda _caller: (1, "", pids.pop(0)), "getPid")
        threading.Thread(target=node.serve_forever, daemon=True).start()
        master = SimpleNamespace(lookupNode=lambda _: f"http://127.0.0.1:{node.server_address[1]}")
        guard.check_guarded(master, ["/gazebo"], tmp_path)
        with pytest.raises(RunError, match="/motor_control obeys whoever finds its port"):
            guard.check_guarded(master, ["/motor_control"], tmp_path)
        node.shutdown()
