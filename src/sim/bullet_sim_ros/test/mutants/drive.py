"""Has `check` read spoilt files, each in a process of its own, and says what it did with them.

    python3 drive.py FIRST LAST       the mutants with these seeds; a line for each bad one
"""

from __future__ import annotations

import os
import resource
import signal
import sys
import tempfile
import time
import traceback
from dataclasses import dataclass
from pathlib import Path

import rospkg
from mutations import mutant

from bullet_sim_ros.check import command

PACKAGES = rospkg.RosPack()
LIMIT = 5.0  # s, of processor time: other work on the machine counts nothing
LONGEST_WAIT = 60.0  # s, wall; then it hangs
MEMORY = 1 << 30  # bytes in RAM
LONGEST_LINE = 1000  # characters


def sources() -> list[Path]:
    """The files to spoil: our own robots, worlds and launch files, and the styles of tests."""
    named = {
        "turtlebot3_description": ["urdf/turtlebot3_waffle.urdf.xacro"],
        "racecar_description": ["worlds/racetrack.world", "launch/racecar.launch"],
        "learning_topic": ["worlds/course.world", "launch/0course.launch"],
        "turtlebot3_gazebo": ["worlds/turtlebot3_world.world", "models/turtlebot3_world/model.sdf"],
    }
    here = Path(__file__).resolve().parent
    found = [Path(PACKAGES.get_path(package)) / name
             for package, names in named.items() for name in names]
    return found + sorted((here.parent / "styles").glob("*.*"))


@dataclass
class Outcome:
    """How it went with one file."""

    seed: int
    source: str
    mutation: str
    code: int  # exit code; negative: the signal that ended it
    seconds: float  # of processor time
    memory: int  # bytes, at most
    output: str

    def fault(self) -> str | None:
        """What is wrong with it, if anything."""
        if self.seconds > LIMIT:
            return f"took {self.seconds:.1f} s"
        if self.code not in (0, 1):
            return f"ended with {self.code}"
        if self.memory > MEMORY:
            return f"used {self.memory / 1e6:.0f} MB"
        if "Traceback" in self.output:
            return "a traceback"
        if self.code == 1 and not any(word in self.output for word in ("PROBLEM", "NOT THERE")):
            return "no word about what is wrong"
        if any(len(line) > LONGEST_LINE for line in self.output.splitlines()):
            return "a line of more than a screen"
        return None

    def line(self) -> str:
        """For people."""
        return f"seed {self.seed} ({self.mutation} of {self.source}): {self.fault() or 'well'}"


def run(seed: int, folder: Path) -> Outcome:
    """One mutant."""
    files = sources()
    source = files[(seed // 7) % len(files)]
    mutation, content = mutant(source.read_text(encoding="utf-8"), seed)
    path = folder / f"{seed}{source.suffix}"
    path.write_bytes(content.replace(b"THIS_FILE", str(path).encode()))
    log = folder / f"{seed}.log"
    sys.stdout.flush()
    child = os.fork()
    if child == 0:
        _be_checked(path, log)
    _, status, usage = _wait(child, time.monotonic() + LONGEST_WAIT)
    return Outcome(seed, source.name, mutation, os.waitstatus_to_exitcode(status),
                   usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024,
                   log.read_text(encoding="utf-8", errors="replace") if log.exists() else "")


def _wait(child: int, until: float):
    while True:
        done = os.wait4(child, os.WNOHANG)
        if done[0]:
            return done
        if time.monotonic() > until:
            os.kill(child, signal.SIGKILL)
            return os.wait4(child, 0)
        time.sleep(0.002)


def _be_checked(path: Path, log: Path) -> None:
    """In the child: never returns."""
    # A little beyond what is allowed, so that what wants too much is found out and not the machine.
    resource.setrlimit(resource.RLIMIT_DATA, (2 * MEMORY, 2 * MEMORY))
    output = log.open("w", encoding="utf-8")
    os.dup2(output.fileno(), 1)
    os.dup2(output.fileno(), 2)
    sys.stdout = sys.stderr = output
    os.chdir(path.parent)
    code = 99
    try:
        code = command.main([str(path)])
    except BaseException:
        traceback.print_exc()
    finally:
        output.flush()
        os._exit(code)


def main() -> int:
    """The seeds of the command line."""
    first, last = int(sys.argv[1]), int(sys.argv[2])
    bad = 0
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        for seed in range(first, last):
            outcome = run(seed, Path(folder))
            if outcome.fault():
                bad += 1
                tail = "\n".join(outcome.output.splitlines()[-4:])
                print(f"{outcome.line()}\n{tail[-600:]}", flush=True)
    print(f"{last - first} files, {bad} bad", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
