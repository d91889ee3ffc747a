"""What is done at rates of simulated time, and when the next of it is due."""

from __future__ import annotations

from collections.abc import Callable

from bullet_sim.tick_rate import Schedule
from bullet_sim.world import World

# s, wall: at the wanted pace nothing is looked at less often, so that new listeners and commands
# need not wait.
LONGEST = 0.01
UNPACED = 0.05  # s, simulated: nor less often than this, however fast time is to run


def always() -> bool:
    """For what is done whether or not anybody listens."""
    return True


class Duty:
    """One thing to be done again and again, while it is wanted."""

    def __init__(self, schedule: Schedule, tick: int, action: Callable[[], None],
                 wanted: Callable[[], bool]):
        self.schedule = schedule
        self.action = action
        self.wanted = wanted
        self.next_tick = schedule.next_tick(tick)
        self.count = 0  # how often it has been done


class Agenda:
    """All duties, done in the order in which they were added."""

    def __init__(self, world: World):
        self._world = world
        self._duties: list[Duty] = []
        self._longest = LONGEST

    def set_pace(self, factor: float) -> None:
        """The real-time factor aimed at; 0: as fast as it goes."""
        self._longest = min(factor * LONGEST, UNPACED) if factor > 0 else UNPACED

    def add(self, rate_hz: float, action: Callable[[], None],
            wanted: Callable[[], bool] = always, whole_steps: bool = False) -> Duty:
        """Do something `rate_hz` times a simulated second from now on; 0: every step.

        `whole_steps` as a `Schedule` has it.
        """
        tick = self._world.tick
        schedule = Schedule(rate_hz, self._world.timestep, tick, whole_steps)
        self._duties.append(Duty(schedule, tick, action, wanted))
        return self._duties[-1]

    def change_rate(self, duty: Duty, rate_hz: float) -> None:
        """Do it at another rate, counted from now on."""
        tick = self._world.tick
        duty.schedule = Schedule(rate_hz, self._world.timestep, tick)
        duty.next_tick = duty.schedule.next_tick(tick)

    def remove(self, duty: Duty) -> None:
        """Not any more."""
        self._duties = [other for other in self._duties if other is not duty]

    def restart(self) -> None:
        """Count every rate from this tick, in steps of the present length."""
        tick, timestep = self._world.tick, self._world.timestep
        for duty in self._duties:
            duty.schedule.restart(tick, timestep)
            duty.next_tick = duty.schedule.next_tick(tick)

    def next_tick(self) -> int:
        """When to look again: the first tick at which something is due that is wanted now."""
        now = self._world.tick
        first = now + max(1, round(self._longest / self._world.timestep))
        for duty in self._duties:
            if duty.next_tick <= now:
                duty.next_tick = duty.schedule.next_tick(now)
            if duty.next_tick < first and duty.wanted():
                first = duty.next_tick
        return first

    def run(self) -> None:
        """Do what is due at this tick."""
        now = self._world.tick
        for duty in self._duties:
            if duty.next_tick == now and duty.wanted():
                duty.count += 1
                duty.action()
