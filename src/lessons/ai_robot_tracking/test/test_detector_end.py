"""object_detector.py when its topics are closed while it looks at an image."""

import runpy
from pathlib import Path
from types import SimpleNamespace

import pytest
import rospy

PROGRAM = Path(__file__).resolve().parents[1] / "scripts" / "object_detector.py"


@pytest.mark.parametrize("ending", [True, False])
def test_closed_topics_are_a_fault_only_while_it_runs(monkeypatch, ending):
    answers = iter([False, ending, True])
    monkeypatch.setattr(rospy, "is_shutdown", lambda: next(answers))

    def closed(_message):
        raise rospy.ROSException("publish() to a closed topic")

    detector = object.__new__(runpy.run_path(str(PROGRAM))["ObjectDetector"])
    vars(detector).update(settings=SimpleNamespace(max_rate=0.0), topic="/image", work=closed,
                          next_picture=lambda _due: "an image")
    if ending:
        detector.run()
    else:
        with pytest.raises(rospy.ROSException, match="closed topic"):
            detector.run()
