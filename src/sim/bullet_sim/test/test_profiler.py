"""What is counted under one stage is not counted under another one as well."""

from bullet_sim import profiler as profiler_module
from bullet_sim.profiler import Profiler


class Clock:
    """One second later whenever it is read."""

    now = 0.0

    def perf_counter(self) -> float:
        self.now += 1.0
        return self.now


def test_a_stage_inside_another_one_is_no_part_of_it(monkeypatch):
    monkeypatch.setattr(profiler_module, "time", Clock())
    profiler = Profiler()
    with profiler.measure("plugins"), profiler.measure("scene"):  # 1 s until 4 s; 2 s until 3 s
        pass
    assert profiler.totals() == {"plugins": 2.0, "scene": 1.0}
