"""What is counted under one stage is not counted under another one as well."""

import time
from io import BytesIO

import numpy as np
import pytest

from bullet_sim.profiler import Profiler
from bullet_sim_ros.array_image import ArrayImage


def test_serialising_is_no_part_of_sending():
    profiler = Profiler()
    image = ArrayImage(np.zeros((2000, 2000, 3), np.uint8), profiler, encoding="rgb8")
    start = time.perf_counter()
    with profiler.measure("send"):
        image.serialize(BytesIO())
    elapsed = time.perf_counter() - start
    totals = profiler.totals()
    assert set(totals) == {"send", "serialise"}
    assert sum(totals.values()) <= elapsed
    assert totals["send"] < totals["serialise"] == pytest.approx(elapsed, rel=0.5)
