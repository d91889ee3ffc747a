"""The simulator behind Gazebo's services: its time and speed, pause, step and reset.

Its node's `name` is /gazebo, unless the simulator is in another namespace.
"""

import threading
import time
from typing import Any

import rospy
from gazebo_msgs.srv import GetPhysicsProperties, GetWorldProperties
from std_srvs.srv import Empty

from sim_viewer.registry import Refused, operation, watchable
from sim_viewer.tools import names
from sim_viewer.tools.clock import FactorMeter, SharedClock
from sim_viewer.tools.master import MasterView, simulator_name
from sim_viewer.tools.paced import Paced
from sim_viewer.tools.services import Calls

PAUSE_ASKED = 1.0  # s between two queries whether it is paused
ANSWER_TIME = 0.5  # s to wait for an answer
MOST_STEPS = 100_000
STEP_LIMIT = 10.0  # s of wall time for all steps asked for at once
RESETS = {"world": names.RESET_WORLD, "simulation": names.RESET_SIMULATION}


@operation("pause", control=True)
async def pause(context: Any, paused: bool = True) -> None:
    """Pause simulated time, or let it go on. Refused if no simulator answers."""
    name = await _find_simulator(context)
    await _call(context, name + (names.PAUSE if paused else names.UNPAUSE))
    context.node.shared(SharedPause).forget()


@operation("reset", control=True)
async def reset(context: Any, what: str = "world") -> None:
    """`world`: set models back to the start; `simulation`: also time to 0; else Refused."""
    if what not in RESETS:
        raise Refused(f"what is {what!r:.40}; there are {', '.join(RESETS)}")
    await _call(context, await _find_simulator(context) + RESETS[what])


@operation("step", control=True)
async def step(context: Any, steps: int = 1) -> dict[str, float]:
    """Go on for this many physics steps, then pause; answers with `{"from", "to"}` in s.

    Gazebo's own ROS interface cannot step, so there physics is unpaused until the first /clock that
    is late enough: with /clock at 100 Hz a single step is 0.01 s or a little more.
    Refused: a number of steps out of bounds, no simulator.
    """
    if not 0 < steps <= MOST_STEPS:
        raise Refused(f"steps is {steps}; give 1 to {MOST_STEPS}")
    name = await _find_simulator(context)
    state = await context.run_in_thread(context.node.shared(MasterView).state)
    clock = context.node.shared(SharedClock)
    exact = name + names.STEP in state.services
    try:
        return await context.node.shared(Calls).run(
            name, lambda: (_step_exactly(name, steps) if exact
                           else _step_by_clock(name, clock, steps)))
    finally:
        context.node.shared(SharedPause).forget()


async def _call(context: Any, name: str) -> None:
    try:
        await context.node.shared(Calls).call(name, Empty)
    except Refused as error:
        raise Refused(f"{error}; is a simulator running?") from None


async def _find_simulator(context: Any) -> str:
    master = context.node.shared(MasterView)
    return simulator_name(await context.run_in_thread(master.state))


def _step_exactly(name: str, steps: int) -> dict[str, float]:
    one = rospy.ServiceProxy(name + names.STEP, Empty, persistent=True)
    world = rospy.ServiceProxy(name + names.WORLD, GetWorldProperties)
    limit = time.monotonic() + STEP_LIMIT
    try:
        call(name + names.PAUSE)
        begin = world().sim_time
        for _ in range(steps):
            one()
            if time.monotonic() > limit:
                break
        return {"from": begin, "to": world().sim_time}
    except (rospy.ServiceException, rospy.ROSException) as error:
        raise Refused(f"{name + names.STEP}: {error}; is a simulator running?") from None
    finally:
        one.close()


def _step_by_clock(name: str, clock: SharedClock, steps: int) -> dict[str, float]:
    duration = steps * call(name + names.PHYSICS, GetPhysicsProperties).time_step
    with clock.held():
        call(name + names.PAUSE)
        begin = clock.simulated
        limit = time.monotonic() + STEP_LIMIT
        call(name + names.UNPAUSE)
        while time.monotonic() < limit:
            now = clock.simulated
            if begin is None:
                begin = now
            elif now is not None and now >= begin + duration and now > begin:
                break
            time.sleep(0.001)
        call(name + names.PAUSE)
        time.sleep(0.02)
        return {"from": begin, "to": clock.simulated}


def call(name: str, kind: type = Empty) -> Any:
    """A service's answer to a request without fields; Refused if there is no simulator."""
    try:
        return rospy.ServiceProxy(name, kind)()
    except (rospy.ServiceException, rospy.ROSException) as error:
        raise Refused(f"{name}: {error}; is a simulator running?") from None


class SharedPause:
    """Whether the simulator is paused, queried at most once a second for any number of pages.

    It is queried in a thread of its own: a simulator whose process is stopped does not answer.
    """

    def __init__(self, node: Any = None):
        self._lock = threading.Lock()
        self._asked = -PAUSE_ASKED
        self._answered = threading.Event()  # whether the last query was
        self._answered.set()
        self._paused: bool | None = None

    def read(self, name: str) -> bool | None:
        """Its state of at most a second ago; None if there is no answer."""
        with self._lock:
            since = time.monotonic() - self._asked
            if not self._answered.is_set():
                return self._paused if since < ANSWER_TIME else None
            if since < PAUSE_ASKED:
                return self._paused
            self._asked = time.monotonic()
            self._answered.clear()
        threading.Thread(target=self._ask, args=(name,), daemon=True).start()
        return self._paused if self._answered.wait(ANSWER_TIME) else None

    def forget(self) -> None:
        """Query again at the next `read`, since the state has just been changed."""
        with self._lock:
            self._asked = -PAUSE_ASKED

    def _ask(self, name: str) -> None:
        try:
            self._paused = call(name + names.PHYSICS, GetPhysicsProperties).pause
        except Refused:
            self._paused = None
        self._answered.set()


@watchable("status")
class Status(Paced):
    """Sends `{time: s, factor: real-time factor, paused, simulator}`; null where unknown."""

    PERIOD = 0.4  # s: each change makes a browser draw, on the simulator's processor perhaps

    def __init__(self, context: Any, args: dict[str, Any], send: Any):
        super().__init__(context, args, send)
        self._clock: SharedClock = context.node.shared(SharedClock)
        self._pause: SharedPause = context.node.shared(SharedPause)
        self._meter = FactorMeter()

    def open(self) -> None:
        self.closing.enter_context(self._clock.held())

    def collect(self) -> Any:
        simulated = self._clock.simulated
        factor = self._meter.add(time.monotonic(), simulated)
        state = self.master.state()
        name = simulator_name(state)
        paused = self._pause.read(name) if name + names.PAUSE in state.services else None
        return self.changed({
            "time": simulated, "factor": None if factor is None else round(factor, 3),
            "paused": bool(paused), "simulator": paused is not None})
