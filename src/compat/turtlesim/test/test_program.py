"""How turtlesim_node ends when its topics are closed while it publishes."""

import runpy
from pathlib import Path

import pytest
import rospy

PROGRAM = Path(__file__).resolve().parents[1] / "nodes" / "turtlesim_node"


def closed(*_args, **_kwargs):
    raise rospy.ROSException("publish() to a closed topic")


@pytest.mark.parametrize("ending", [True, False])
def test_closed_topics_are_a_fault_only_while_it_runs(monkeypatch, ending):
    monkeypatch.setattr(rospy, "init_node", closed)
    monkeypatch.setattr(rospy, "is_shutdown", lambda: ending)
    if ending:  # another node has taken its name
        runpy.run_path(str(PROGRAM), run_name="__main__")
    else:
        with pytest.raises(rospy.ROSException, match="closed topic"):
            runpy.run_path(str(PROGRAM), run_name="__main__")
