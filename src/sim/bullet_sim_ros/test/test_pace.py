"""When the loop goes on, what is due then, and what it says about its speed; no master."""

import logging
from itertools import pairwise

import pytest

from bullet_sim.profiler import Profiler
from bullet_sim.world import World
from bullet_sim_ros import real_time_factor as monitor_module
from bullet_sim_ros.real_time_factor import RealTimeFactorMonitor
from bullet_sim_ros.scheduler import CATCH_UP, SLACK, Pacer, Scheduler


class Clock:
    """A wall clock that the test moves."""

    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


def run(pacer, clock, seconds, costs=lambda simulated: 0.0, start=0.0):
    """Batches of 10 ms; wall time and simulated time after each."""
    rows, simulated = [], start
    while simulated < start + seconds - 1e-9:
        clock.now += pacer.ahead(simulated)
        clock.now += costs(simulated)
        simulated += 0.01
        rows.append((clock.now, simulated))
    return rows


@pytest.mark.parametrize("factor", [0.5, 1.0, 2.0])
def test_simulated_time_runs_at_the_factor(factor):
    clock = Clock()
    rows = run(Pacer(factor, clock), clock, 5.0, lambda _: 0.002)
    assert rows[-1][0] - 100.0 == pytest.approx(5.0 / factor, abs=0.02)


def test_factor_0_never_waits():
    assert Pacer(0.0).ahead(1.0) == Pacer(0.0).ahead(2.0) == 0.0


def test_a_short_delay_is_made_good_evenly_and_no_burst():
    clock = Clock()
    pacer = Pacer(1.0, clock)
    rows = run(pacer, clock, 2.0, lambda at: 0.05 if abs(at - 0.5) < 0.001 else 0.001)
    assert rows[-1][0] - 100.0 == pytest.approx(2.0, abs=0.02)
    gaps = sorted(b[0] - a[0] for a, b in pairwise(rows))
    assert gaps[1] >= 0.01 / CATCH_UP - 1e-9  # one batch may follow the late one at once


def test_a_long_delay_is_given_up_but_for_the_slack():
    clock = Clock()
    pacer = Pacer(1.0, clock)
    rows = run(pacer, clock, 5.0, lambda at: 3.0 if abs(at - 0.5) < 0.001 else 0.0)
    assert rows[-1][0] - 100.0 == pytest.approx(5.0 + 3.0 - SLACK, abs=0.02)


def test_too_slow_a_machine_slows_time_evenly():
    clock = Clock()
    rows = run(Pacer(1.0, clock), clock, 2.0, lambda _: 0.02)
    gaps = [b[0] - a[0] for a, b in pairwise(rows)]
    assert min(gaps) == pytest.approx(max(gaps)) == pytest.approx(0.02)


def test_after_a_pause_nothing_is_made_good():
    clock = Clock()
    pacer = Pacer(1.0, clock)
    run(pacer, clock, 1.0)
    clock.now += 60.0
    pacer.restart()
    clock_at = clock.now
    rows = run(pacer, clock, 1.0, start=1.0)
    assert rows[-1][0] - clock_at == pytest.approx(1.0, abs=0.02)


@pytest.fixture
def world():
    made = World()
    yield made
    made.close()


def advance(world, scheduler, until):
    """As the loop does; the ticks at which it stopped."""
    stops = []
    while world.tick < until:
        world.step(scheduler.next_tick() - world.tick)
        scheduler.run()
        stops.append(world.tick)
    return stops


def test_each_duty_is_done_at_its_rate_in_the_order_of_adding(world):
    scheduler, done = Scheduler(world), []
    for name, rate_hz in (("clock", 100.0), ("camera", 30.0), ("odometry", 30.0)):
        scheduler.add(rate_hz, lambda name=name: done.append((world.tick, name)))
    advance(world, scheduler, 100)
    assert [tick for tick, name in done if name == "clock"] == list(range(10, 101, 10))
    assert [tick for tick, name in done if name == "camera"] == [34, 67, 100]
    assert done[-3:] == [(100, "clock"), (100, "camera"), (100, "odometry")]


def test_what_nobody_wants_neither_runs_nor_stops_the_loop(world):
    scheduler, wanted, done = Scheduler(world), [False], []
    scheduler.add(0.0, lambda: done.append(world.tick), lambda: wanted[0])
    assert advance(world, scheduler, 20) == [10, 20]
    wanted[0] = True
    assert advance(world, scheduler, 25) == [21, 22, 23, 24, 25]
    assert done == [21, 22, 23, 24, 25]


def test_a_duty_may_be_removed_while_another_runs(world):
    scheduler, done = Scheduler(world), []
    scheduler.add(1000.0, lambda: scheduler.remove(second))
    second = scheduler.add(1000.0, lambda: done.append(world.tick))
    advance(world, scheduler, 3)
    assert done == [1]  # it was under way when it was removed


def test_rates_follow_a_new_step_length(world):
    scheduler, done = Scheduler(world), []
    scheduler.add(100.0, lambda: done.append(world.time))
    advance(world, scheduler, 20)
    world.configure_physics(max_step_size=0.002)
    scheduler.restart()
    advance(world, scheduler, 20)
    assert done == pytest.approx([0.01, 0.02, 0.03, 0.04])


@pytest.mark.parametrize(("stage", "cost", "advice"), [
    ("draw", 0.008, monitor_module.IMAGES),
    ("physics", 0.008, "use fewer models, or a larger max_step_size in the world file"),
    ("plugins", 0.008, "use fewer robots and sensors, or lower rates in their files"),
    ("lockstep", 0.008, "make the program faster that answers each image"),
    ("draw", 0.002, "end other programs, which have the processor most of the time: type top")])
def test_slow_time_is_one_warning_in_ten_seconds_with_its_cause_and_what_to_do(
        monkeypatch, caplog, stage, cost, advice):
    clock = Clock()
    monkeypatch.setattr(monitor_module.time, "monotonic", clock)
    profiler = Profiler()
    speed = RealTimeFactorMonitor(profiler, profile=False)
    with caplog.at_level(logging.WARNING, logger="rosout"):
        for number in range(1, 2501):  # 25 s at half of real time
            clock.now += 0.01
            profiler.add(stage, cost)
            profiler.add("scene", 0.001)
            profiler.add("wait", 0.009)
            speed.update(number * 0.005, 1.0)
    assert speed.measured == pytest.approx(0.5, abs=0.01)
    messages = [record.getMessage() for record in caplog.records]
    assert len(messages) == 2
    assert messages[0].startswith("simulated time runs at 0.50 of real time, not 1, and nothing is "
                                  f"skipped; what costs most is {stage}: ")
    assert messages[0].endswith(f" ms of each second. For more speed: {advice}")


@pytest.mark.parametrize(("each", "wanted"), [(0.01, 1.0), (0.02, 2.0), (0.005, 0.5), (0.001, 0.0)])
def test_time_that_keeps_up_is_no_warning(monkeypatch, caplog, each, wanted):
    clock = Clock()
    monkeypatch.setattr(monitor_module.time, "monotonic", clock)
    speed = RealTimeFactorMonitor(Profiler(), profile=False)
    with caplog.at_level(logging.WARNING, logger="rosout"):
        for number in range(1, 2501):
            clock.now += 0.01
            speed.update(number * each, wanted)
    assert not caplog.records


def test_stages_inside_others_count_once(monkeypatch):
    clock = Clock()
    monkeypatch.setattr("bullet_sim.profiler.time.perf_counter", clock)
    profiler = Profiler()
    with profiler.measure("plugins"):
        clock.now += 1.0
        for _ in range(2):
            with profiler.measure("scene"):
                clock.now += 0.25
    assert profiler.totals() == {"scene": 0.5, "plugins": 1.0}
    lines = profiler.table(2.0).splitlines()
    assert lines[1].split() == ["plugins", "1", "1000.000", "1000.00", "50.0%"]
    assert lines[2].split() == ["scene", "2", "250.000", "250.00", "25.0%"]
