"""A simulator that is halted answers no service: what its pages cost the server then."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor

from sim_viewer.registry import WORKERS
from sim_viewer.tools import sim

ANSWER_TIME, DEADLINE = 2.0, 15.0  # s; between them is what a busy machine may take


def test_a_halted_simulator_is_asked_once_and_keeps_no_worker(monkeypatch):
    asked, going_on = [], threading.Event()

    def halted(name, kind):
        asked.append(name)
        going_on.wait()
        raise sim.Refused("gone")

    monkeypatch.setattr(sim, "call", halted)
    monkeypatch.setattr(sim, "ANSWER_TIME", ANSWER_TIME)
    pause = sim.SharedPause()
    with ThreadPoolExecutor(WORKERS) as workers:
        for _ in range(2):
            began = time.monotonic()
            assert set(workers.map(pause.read, ["/gazebo"] * WORKERS)) == {None}
            assert time.monotonic() - began < DEADLINE
    assert len(asked) == 1
    going_on.set()
