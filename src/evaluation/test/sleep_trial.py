"""A trial whose cases sleep, in place of simulators.

--naps N: so many cases. --seconds S: how long each sleeps. --fails, --dies NAME: a case that cannot
be run, and one whose process is killed. --enough N: so many results are enough.
"""

import os
import signal
import time
from dataclasses import asdict, dataclass

from evaluation.trial import Case, Trial
from run_session.failure import RunError


@dataclass(frozen=True)
class Nap:
    """A result."""

    name: str
    files: int  # in the folder that the case got


class SleepTrial(Trial):
    """Each case starts a process in a session of its own, notes its number, and sleeps."""

    program = "sleep_trial"
    does = "Sleep."
    good = "some slept"
    writes = "report.json and a note of each nap"

    def add_options(self, parser):
        parser.add_whole("--naps", 4, "how many", variable="")
        parser.add_argument("--seconds", type=float, default=0.1)
        parser.add_argument("--fails", default="")
        parser.add_argument("--dies", default="")
        parser.add_whole("--enough", 0, "results that are enough; 0: all", variable="")

    def check(self, options):
        self.open_ended = bool(options.enough)

    def cases(self, options):
        return [Case(f"nap-{number}") for number in range(options.naps)]

    def is_needed(self, case, results):
        return not self.options.enough or len(results) < self.options.enough

    def drive(self, session, case):
        child = session.family.start(
            "sleep", ["sleep", f"{self.options.seconds + 60}"], os.environ, session.out / "log")
        note = session.out / "naps" / case.name
        note.parent.mkdir(exist_ok=True)
        note.write_text(f"{child.process.pid}\n")
        if case.name == self.options.fails:
            raise RunError(f"the bed broke; log: {session.out / 'log'}", "a creak")
        if case.name == self.options.dies:
            os.kill(os.getpid(), signal.SIGKILL)
        time.sleep(self.options.seconds)
        return Nap(case.name, sum(path.is_file() for path in note.parent.iterdir()))

    def passed(self, results):
        return bool(results)

    def line(self, result):
        return f"{result.name} slept"

    def table(self, results):
        return f"{len(results)} slept"

    def values(self, results):
        return {"naps": [asdict(each) for each in results]}

    def from_values(self, values):
        return [Nap(**each) for each in values["naps"]]
