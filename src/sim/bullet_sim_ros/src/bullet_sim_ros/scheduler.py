"""The loop's time: tasks at rates of simulated time, when the next is due, and the pace."""

import time
from collections.abc import Callable

from bullet_sim.tick_rate import TickRate
from bullet_sim.world import World

SLACK = 0.1  # s, wall: how much lost time is made up for; more than that is given up
CATCH_UP = 1.25  # lost time is made up for at this many times the wanted speed, not in a burst


class Pacer:
    """Simulated time runs at `factor` times real time or slower, and evenly; 0 never waits.

    Only here does the wall clock decide.
    """

    def __init__(self, factor: float = 1.0, clock: Callable[[], float] = time.monotonic):
        self.factor = factor
        self._clock = clock
        self.restart()

    def restart(self) -> None:
        """Forget the past: after a pause, a reset or a change of factor."""
        self._simulated: float | None = None  # s, the argument of the last `ahead`
        self._until = self._fair = 0.0  # s, wall: when that is due, with and without delays

    def ahead(self, simulated: float) -> float:
        """Seconds of wall time to wait before going on from this simulated time; 0: go on."""
        if self.factor <= 0:
            return 0.0
        now = self._clock()
        if self._simulated is None:
            self._simulated, self._until, self._fair = simulated, now, now
        elif simulated != self._simulated:
            step = (simulated - self._simulated) / self.factor
            self._simulated = simulated
            self._fair = max(self._fair + step, now - SLACK)
            if step < 0:  # something that is due earlier was added: waiting has lost no time
                self._until += step
            else:
                self._until = max(self._fair, self._until + step / CATCH_UP, now)
        return max(0.0, self._until - now)


# s, wall: at the wanted pace the loop checks for new subscribers and commands at least this often.
LONGEST = 0.01
UNPACED = 0.05  # s, simulated: and at least this often, however fast time is to run


def always() -> bool:
    """For tasks that run with and without subscribers."""
    return True


class PeriodicTask:
    """A task that is repeated at a rate, while it is wanted."""

    def __init__(self, tick_rate: TickRate, tick: int, action: Callable[[], None],
                 wanted: Callable[[], bool]):
        self.tick_rate = tick_rate
        self.action = action
        self.wanted = wanted
        self.next_tick = tick_rate.next_tick(tick)
        self.count = 0  # how often it has run


class Scheduler:
    """All periodic tasks, run in the order in which they were added."""

    def __init__(self, world: World):
        self._world = world
        self._tasks: list[PeriodicTask] = []
        self._longest = LONGEST
        self.heard = True  # whether tasks run that only listeners want: they leave the world as is

    def set_pace(self, factor: float) -> None:
        """Set the real-time factor aimed at; 0: as fast as possible."""
        self._longest = min(factor * LONGEST, UNPACED) if factor > 0 else UNPACED

    def add(self, rate_hz: float, action: Callable[[], None],
            wanted: Callable[[], bool] = always, whole_steps: bool = False) -> PeriodicTask:
        """Run `action` `rate_hz` times per simulated second from now on; 0: every step.

        For `whole_steps` see `TickRate`.

        SimulationError if the rate is negative or not finite.
        """
        tick = self._world.tick
        tick_rate = TickRate(rate_hz, self._world.timestep, tick, whole_steps)
        self._tasks.append(PeriodicTask(tick_rate, tick, action, wanted))
        return self._tasks[-1]

    def change_rate(self, task: PeriodicTask, rate_hz: float) -> None:
        """Run a task at another rate, counted from now on.

        SimulationError if the rate is negative or not finite.
        """
        tick = self._world.tick
        task.tick_rate = TickRate(rate_hz, self._world.timestep, tick, task.tick_rate.whole_steps)
        task.next_tick = task.tick_rate.next_tick(tick)

    def remove(self, task: PeriodicTask) -> None:
        """Stop running a task."""
        self._tasks = [other for other in self._tasks if other is not task]

    def restart(self) -> None:
        """Count every rate from this tick, in steps of the present length."""
        tick, timestep = self._world.tick, self._world.timestep
        for task in self._tasks:
            task.tick_rate.restart(tick, timestep)
            task.next_tick = task.tick_rate.next_tick(tick)

    def next_tick(self) -> int:
        """The first tick at which a task that is wanted now is due, or the loop has to check."""
        now = self._world.tick
        first = now + max(1, round(self._longest / self._world.timestep))
        for task in self._tasks:
            if task.next_tick <= now:
                task.next_tick = task.tick_rate.next_tick(now)
            if task.next_tick < first and self._wanted(task):
                first = task.next_tick
        return first

    def run(self) -> None:
        """Run the tasks that are due at this tick."""
        now = self._world.tick
        for task in self._tasks:
            if task.next_tick == now and self._wanted(task):
                task.count += 1
                task.action()

    def for_listeners(self) -> list[PeriodicTask]:
        """The tasks that only listeners want."""
        return [task for task in self._tasks if task.wanted is not always]

    def is_due(self, task: PeriodicTask) -> bool:
        """Whether a task is due at this tick, also if nobody listened."""
        now = self._world.tick
        return task.tick_rate.next_tick(now - 1) == now

    def _wanted(self, task: PeriodicTask) -> bool:
        return task.wanted is always or (self.heard and task.wanted())
