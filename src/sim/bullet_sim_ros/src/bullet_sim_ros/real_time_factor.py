"""Measures how fast simulated time runs and what slows it down, and logs that."""

import time

import rospy

from bullet_sim.profiler import Profiler

WINDOW = 1.0  # s, wall, over which the real-time factor is taken
REPORT_PERIOD = 10.0  # s, wall
SLOW = 0.95  # of the wanted speed; below it there is a warning
BUSY = 0.5  # of wall time; if all stages together took less, other programs had the processor
WAITING = "wait"  # for the previous image, the cost of which is counted under drawing
# What a person can type or change, by the stage that costs most; IMAGES for all others.
IMAGES = ("use fewer cameras or smaller images, in our courses by camera_width:=640 "
          "camera_height:=480 behind the roslaunch command")
ADVICE = {
    "physics": "use fewer models, or a larger max_step_size in the world file",
    "plugins": "use fewer robots and sensors, or lower rates in their files",
    "lockstep": "make the program faster that answers each image",
}
OTHERS = "end other programs, which have the processor most of the time: type top"


class RealTimeFactorMonitor:
    """Updated by the loop after every batch of steps."""

    def __init__(self, profiler: Profiler, profile: bool):
        self.measured = 0.0
        self._profiler = profiler
        self._profile = profile
        self._began = time.monotonic()
        self.restart(0.0)

    def restart(self, simulated: float) -> None:
        """Count from here: after a pause, a reset or a change of pace."""
        now = time.monotonic()
        self._window = self._report = (now, simulated)
        self._totals = self._profiler.totals()

    def update(self, simulated: float, wanted: float) -> None:
        """`simulated` in s; `wanted` is the real-time factor aimed at, 0: as fast as possible."""
        now = time.monotonic()
        if now - self._window[0] >= WINDOW:
            self.measured = _factor(self._window, (now, simulated))
            self._window = (now, simulated)
        if now - self._report[0] >= REPORT_PERIOD:
            self._log_factor(_factor(self._report, (now, simulated)), wanted)
            self._report, self._totals = (now, simulated), self._profiler.totals()

    def close(self) -> None:
        """Log the profile at the end, if that is wanted."""
        if self._profile:
            self._log_stages()

    def _log_factor(self, factor: float, wanted: float) -> None:
        if factor < SLOW * wanted:
            name, share, all_shares = self._costliest()
            advice = OTHERS if all_shares < BUSY else ADVICE.get(name, IMAGES)
            rospy.logwarn(
                "simulated time runs at %.2f of real time, not %g, and nothing is skipped; what "
                "costs most is %s: %.0f ms of each second. For more speed: %s", factor, wanted,
                name, share * 1e3, advice)
        if self._profile:
            self._log_stages()

    def _log_stages(self) -> None:
        elapsed = time.monotonic() - self._began
        rospy.loginfo("stages of the work in %.0f s\n%s", elapsed, self._profiler.table(elapsed))

    def _costliest(self) -> tuple[str, float, float]:
        """The costliest stage and its share of wall time since the last report; that of all."""
        spent = {name: total - self._totals.get(name, 0.0)
                 for name, total in self._profiler.totals().items()}
        spent.pop(WAITING, None)
        name = max(spent, key=spent.get)
        return name, spent[name] / REPORT_PERIOD, sum(spent.values()) / REPORT_PERIOD


def _factor(start: tuple[float, float], end: tuple[float, float]) -> float:
    return (end[1] - start[1]) / (end[0] - start[0])
