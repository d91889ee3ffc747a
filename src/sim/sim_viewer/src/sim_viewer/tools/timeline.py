"""The images and marks of a run in lockstep, from the log that the simulator writes or repeats, and
the way to another image of a run that `make replay` has gone back into."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any

import rospy
from std_srvs.srv import Trigger

from bullet_sim.formats.run_log import RunLogError, read_run_log
from sim_viewer.registry import Refused, operation, watchable
from sim_viewer.tools import names
from sim_viewer.tools.master import simulator_name
from sim_viewer.tools.paced import Paced
from sim_viewer.tools.services import Calls

MAY = re.compile(r"image:[1-9][0-9]{0,8}|go")
LIMIT = 3600.0  # s, wall; as in make replay


@operation("rewind", control=True)
async def rewind(context: Any, to: str) -> None:
    """Have make replay go to `image:700`, or drive on: `go`. Refused with its reason."""
    if not MAY.fullmatch(to):
        raise Refused(f"to is {to!r:.40}; there are image:N and go")

    def carry_out() -> Any:
        rospy.set_param(names.REPLAY_WORD, to)
        return rospy.ServiceProxy(names.CARRY_OUT, Trigger)()

    answer = await context.node.shared(Calls).run(names.CARRY_OUT, carry_out, LIMIT)
    if not answer.success:
        raise Refused(answer.message)


def timeline(path: Path, replayed: bool) -> dict[str, Any]:
    """What the bar shows: times of images (s), marks, and, of a run that is not a replay, what to
    type to go back into it; {} if there is no log yet, or none of this version."""
    try:
        log = read_run_log(path)
    except (OSError, RunLogError):
        return {}
    if "words" not in log.header.get("run", {}):  # it cannot be gone back to
        return {}
    run = path.parent if path.name == "run.log.gz" else path.with_name(
        path.name.removesuffix(".run.log.gz"))
    return {"times": [round(log.time_of(image), 6) for image in log.images],
            "marks": [list(mark) for mark in log.marks],
            "command": "" if replayed else f"make replay RUN={shlex.quote(str(run))}"}


@watchable("timeline")
class Timeline(Paced):
    """Sends what `timeline` returns when it has changed."""

    PERIOD = 1.0  # s; the simulator writes a part of the log each simulated second
    _seen: tuple = ()

    def collect(self) -> Any:
        name = simulator_name(self.master.state())
        replayed = str(rospy.get_param(name + names.REPLAY, ""))
        path = Path(replayed or str(rospy.get_param(name + names.RUN_LOG, "")))
        if not path.is_file():  # Path("") neither: there is no run, or none any more
            self._seen = ()
            return self.changed({})
        status = path.stat()
        seen = path, status.st_mtime_ns, status.st_size
        if seen == self._seen:
            return None
        self._seen = seen
        return self.changed(timeline(path, bool(replayed)))
