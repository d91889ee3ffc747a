"""What is counted under one stage is not counted under another one as well."""

from io import BytesIO

import numpy as np

from bullet_sim import profiler as profiler_module
from bullet_sim.profiler import Profiler
from bullet_sim_ros.array_messages import ArrayImage


class Clock:
    """One second later whenever it is read."""

    now = 0.0

    def perf_counter(self) -> float:
        self.now += 1.0
        return self.now


def test_serialising_is_no_part_of_sending(monkeypatch):
    monkeypatch.setattr(profiler_module, "time", Clock())
    profiler = Profiler()
    image = ArrayImage(np.zeros((2, 2, 3), np.uint8), profiler, encoding="rgb8")
    with profiler.measure("send"):  # read at 1 s; serialising from 2 to 3 s; until 4 s
        image.serialize(BytesIO())
    assert profiler.totals() == {"send": 2.0, "serialise": 1.0}
