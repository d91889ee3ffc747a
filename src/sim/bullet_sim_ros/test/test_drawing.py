"""Jobs of the drawing thread, and what they hand on."""

import threading

import pytest

from bullet_sim.profiler import Profiler
from bullet_sim_ros import drawing
from bullet_sim_ros.drawing import DrawingThread

LIMIT = 60.0  # s


@pytest.fixture
def thread(monkeypatch):
    monkeypatch.setattr(drawing, "open_renderer", lambda profiler: NoRenderer())
    made = DrawingThread(Profiler())
    yield made
    made.close()


class NoRenderer:
    def close(self): ...


def test_while_the_rest_of_one_picture_is_done_the_next_is_drawn(thread):
    drawn = threading.Event()
    order = []

    def rest_of_the_first():
        assert drawn.wait(LIMIT)
        order.append("rest of the first")

    def draw_the_second():
        drawn.set()
        thread.hand_on(lambda: order.append("rest of the second"))

    thread.submit(lambda: thread.hand_on(rest_of_the_first))
    thread.submit(draw_the_second)
    thread.settle()
    assert order == ["rest of the first", "rest of the second"]


def test_no_more_than_one_rest_waits(thread):
    """Else pictures of 33 MB would heap up behind a slow one."""
    go_on, begun, handed_on = threading.Event(), threading.Event(), threading.Event()

    def slow():
        begun.set()
        assert go_on.wait(LIMIT)

    def next_job():
        thread.hand_on(lambda: None)
        handed_on.set()

    thread.submit(lambda: thread.hand_on(slow))
    thread.submit(next_job)
    assert begun.wait(LIMIT) and not handed_on.wait(0.1)
    go_on.set()
    assert handed_on.wait(LIMIT)


def test_who_hands_on_learns_what_that_failed_with_and_nobody_else(thread):
    def fail():
        raise ValueError("no points")

    thread.settle()
    failed, other = thread.hand_on(fail), thread.hand_on(lambda: None)
    thread.settle()
    assert isinstance(failed.exception(), ValueError) and other.exception() is None
