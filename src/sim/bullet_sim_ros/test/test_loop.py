"""The loop's wait, without ROS's master."""

from types import SimpleNamespace

import pytest

from bullet_sim_ros.pacer import Pacer
from bullet_sim_ros.scheduler import Scheduler
from bullet_sim_ros.simulation import IDLE, Simulation


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
    simulation.world = SimpleNamespace(paused=False, time=0.0)
    simulation.pacer = Pacer(factor)
    simulation.mailbox = ImpatientMailbox(simulation)
    simulation._stop_requested = False
    simulation.pacer.ahead(0.0)
    simulation.world.time = 0.01
    simulation._wait()
    assert max(simulation.mailbox.waits) <= IDLE


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
