"""What is done at rates of simulated time, and when the next of it is due."""

from collections.abc import Callable

from bullet_sim.tick_rate import TickRate
from bullet_sim.world import World

# s, wall: at the wanted pace nothing is looked at less often, so that new listeners and commands
# need not wait.
LONGEST = 0.01
UNPACED = 0.05  # s, simulated: nor less often than this, however fast time is to run


def always() -> bool:
    """For what is done whether or not anybody listens."""
    return True


class PeriodicTask:
    """One thing to be done again and again, while it is wanted."""

    def __init__(self, tick_rate: TickRate, tick: int, action: Callable[[], None],
                 wanted: Callable[[], bool]):
        self.tick_rate = tick_rate
        self.action = action
        self.wanted = wanted
        self.next_tick = tick_rate.next_tick(tick)
        self.count = 0  # how often it has been done


class Scheduler:
    """All periodic tasks, run in the order in which they were added."""

    def __init__(self, world: World):
        self._world = world
        self._tasks: list[PeriodicTask] = []
        self._longest = LONGEST

    def set_pace(self, factor: float) -> None:
        """The real-time factor aimed at; 0: as fast as it goes."""
        self._longest = min(factor * LONGEST, UNPACED) if factor > 0 else UNPACED

    def add(self, rate_hz: float, action: Callable[[], None],
            wanted: Callable[[], bool] = always, whole_steps: bool = False) -> PeriodicTask:
        """Do something `rate_hz` times a simulated second from now on; 0: every step.

        `whole_steps` as a `TickRate` has it.

        SimulationError of a rate that is negative or not finite.
        """
        tick = self._world.tick
        tick_rate = TickRate(rate_hz, self._world.timestep, tick, whole_steps)
        self._tasks.append(PeriodicTask(tick_rate, tick, action, wanted))
        return self._tasks[-1]

    def change_rate(self, task: PeriodicTask, rate_hz: float) -> None:
        """Do it at another rate, counted from now on.

        SimulationError of a rate that is negative or not finite.
        """
        tick = self._world.tick
        task.tick_rate = TickRate(rate_hz, self._world.timestep, tick, task.tick_rate.whole_steps)
        task.next_tick = task.tick_rate.next_tick(tick)

    def remove(self, task: PeriodicTask) -> None:
        """Not any more."""
        self._tasks = [other for other in self._tasks if other is not task]

    def restart(self) -> None:
        """Count every rate from this tick, in steps of the present length."""
        tick, timestep = self._world.tick, self._world.timestep
        for task in self._tasks:
            task.tick_rate.restart(tick, timestep)
            task.next_tick = task.tick_rate.next_tick(tick)

    def next_tick(self) -> int:
        """When to look again: the first tick at which something is due that is wanted now."""
        now = self._world.tick
        first = now + max(1, round(self._longest / self._world.timestep))
        for task in self._tasks:
            if task.next_tick <= now:
                task.next_tick = task.tick_rate.next_tick(now)
            if task.next_tick < first and task.wanted():
                first = task.next_tick
        return first

    def run(self) -> None:
        """Do what is due at this tick."""
        now = self._world.tick
        for task in self._tasks:
            if task.next_tick == now and task.wanted():
                task.count += 1
                task.action()
