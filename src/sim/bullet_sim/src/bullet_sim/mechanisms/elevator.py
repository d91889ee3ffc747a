"""A lift: closes its door, goes to a floor, opens, waits, closes."""

from collections.abc import Callable

from bullet_sim.joint import Joint
from bullet_sim.world import World

# ElevatorPlugin.cc, LiftController and DoorController, drives both by forces,
# force = -p gap - d rate, damped so heavily that both approach at a rate of p / d times their
# gap. The motors here hold these rates.
LIFT_GAIN = 1.0  # 1/s
DOOR_GAIN = 2.0  # 1/s
MOTOR_EFFORT = 1e6  # N
LIFT_ARRIVED, DOOR_ARRIVED = 0.15, 0.05  # m
HOLD = 1e-3  # m: closer than this, it is only held
OPEN, CLOSED = 1.0, 0.0  # m, of the door's joint


class Elevator:
    """Call `update` at every step; times are simulated."""

    def __init__(self, world: World, lift: Joint, door: Joint, floor_height: float = 3.0,
                 door_wait: float = 5.0):
        """Height in m, wait in s."""
        self._world, self._lift, self._door = world, lift, door
        self._floor_height, self._door_wait = floor_height, door_wait
        self._height = self._gap = 0.0  # m: wanted positions of lift and door
        self._todo: list[Callable[[], bool]] = []

    def go(self, floor: int) -> bool:
        """Start a ride; False, without any effect, if one is going on."""
        if self._todo:
            return False
        self._floor = floor
        self._todo = [self._close, self._move, self._open, self._wait, self._close]
        self._begun: float | None = None
        return True

    def update(self) -> None:
        """Move on by one step."""
        if self._todo:
            if self._begun is None:
                self._begun = self._world.time
            if self._todo[0]():
                self._todo.pop(0)
                self._begun = None
        _drive(self._lift, self._height, LIFT_GAIN)
        _drive(self._door, self._gap, DOOR_GAIN)

    def reset(self) -> None:
        """Forget the ride."""
        self._todo = []

    def _close(self) -> bool:
        self._gap = CLOSED
        return abs(self._door.position - self._gap) < DOOR_ARRIVED

    def _open(self) -> bool:
        self._gap = OPEN
        return abs(self._door.position - self._gap) < DOOR_ARRIVED

    def _move(self) -> bool:
        self._height = self._floor * self._floor_height
        return abs(self._lift.position - self._height) < LIFT_ARRIVED

    def _wait(self) -> bool:
        return self._world.time - self._begun >= self._door_wait


def _drive(joint: Joint, target: float, gain: float) -> None:
    gap = target - joint.position
    joint.drive_velocity(gain * gap if abs(gap) > HOLD else 0.0, MOTOR_EFFORT)
