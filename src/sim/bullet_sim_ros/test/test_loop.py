"""The loop's wait, without ROS's master."""

from types import SimpleNamespace

import pytest

from bullet_sim_ros.loop import IDLE, wait
from bullet_sim_ros.scheduler import Pacer, Scheduler
from bullet_sim_ros.simulation import Simulation


class ImpatientMailbox:
    """Keeps how long the loop would have waited, and tells it to stop after a few times."""

    def __init__(self, simulation):
        self._simulation, self.waits = simulation, []

    def run_pending(self, wait=0.0):
        self.waits.append(wait)
        if len(self.waits) == 3:
            self._simulation.stop()


@pytest.mark.parametrize("factor", [1e-4, 1e-14])
def test_however_slow_time_runs_the_loop_soon_sees_that_it_is_to_end(factor):
    """A timed wait of Python's goes on after a signal; one of centuries is an OverflowError."""
    simulation = Simulation.__new__(Simulation)
    simulation.world = SimpleNamespace(paused=False, tick=0, timestep=0.001)
    simulation.scheduler = Scheduler(simulation.world)
    simulation.pacer = Pacer(factor)
    simulation.mailbox = ImpatientMailbox(simulation)
    simulation._stop_requested = False
    simulation.pacer.ahead(0.0)
    wait(simulation)
    assert max(simulation.mailbox.waits) <= IDLE


def test_what_is_due_at_different_rates_is_done_when_its_time_has_come_on_the_wall():
    simulation, wall, done = Simulation.__new__(Simulation), SimpleNamespace(now=50.0), []
    world = SimpleNamespace(paused=False, tick=0, timestep=0.001)
    simulation.world, simulation.scheduler = world, Scheduler(world)
    simulation.pacer = Pacer(1.0, lambda: wall.now)
    simulation._stop_requested = False

    def run_pending(wait=0.0):
        wall.now += wait

    simulation.mailbox = SimpleNamespace(run_pending=run_pending)
    for rate_hz in (100.0, 30.0):
        simulation.scheduler.add(rate_hz, lambda: done.append(wall.now - world.tick / 1000))
    for _ in range(100):
        wait(simulation)
        world.tick = simulation.scheduler.next_tick()
        simulation.scheduler.run()
    assert done == pytest.approx([done[0]] * len(done), abs=1e-6)


@pytest.mark.parametrize("rate_hz", [50, 400])
def test_triggers_that_come_while_the_loop_waits_cost_no_time(rate_hz):
    simulation, wall = Simulation.__new__(Simulation), SimpleNamespace(now=50.0)
    world = SimpleNamespace(paused=False, tick=0, timestep=0.001)
    simulation.world, simulation.scheduler = world, Scheduler(world)
    simulation.pacer = Pacer(1.0, lambda: wall.now)
    simulation._stop_requested = False
    triggered = []

    def run_pending(wait=0.0):
        """Comes back at a trigger."""
        after = 1 / rate_hz - wall.now % (1 / rate_hz) + 1e-6
        wall.now += min(wait, after)
        if after < wait:
            triggered.append(wall.now)
        return after < wait

    simulation.mailbox = SimpleNamespace(run_pending=run_pending)
    simulation.scheduler.add(100.0, lambda: None)
    simulation.scheduler.add(0.0, triggered.clear, lambda: bool(triggered))
    while wall.now < 60.0:
        wait(simulation)
        world.tick = simulation.scheduler.next_tick()
        simulation.scheduler.run()
    assert world.tick / 1000 == pytest.approx(10.0, abs=0.03)


@pytest.mark.parametrize("whole_steps, due", [(False, [34, 67, 100]), (True, [34, 68, 102])])
def test_a_changed_rate_is_counted_as_the_one_before(whole_steps, due):
    world, ticks = SimpleNamespace(tick=0, timestep=0.001), []
    scheduler = Scheduler(world)
    task = scheduler.add(50.0, lambda: ticks.append(world.tick), whole_steps=whole_steps)
    scheduler.change_rate(task, 30.0)
    while len(ticks) < len(due):
        world.tick = scheduler.next_tick()
        scheduler.run()
    assert ticks == due
