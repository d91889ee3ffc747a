"""Has `check` read spoilt files, each in a process of its own, and says what it did with them.

    python3 malformed.py FIRST LAST       those with these seeds; a line for each bad one
    python3 malformed.py parts [WORD]     files with spoilt parts, or those with WORD in the name
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
from functools import partial
from pathlib import Path

import rospkg
from large_texts import LARGE
from spoilt_parts import PARTS
from workspace_needs.check import command

from bullet_sim_ros.interface import documented
from bullet_sim_ros.plugins import register_plugins

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "test/fuzz"))

from mutating import malformed  # noqa: E402

register_plugins()  # once, and not in the process of each file
documented()
PACKAGES = rospkg.RosPack()
STYLES = ROOT / "src/sim/bullet_sim_ros/test/styles"
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
    found = [Path(PACKAGES.get_path(package)) / name
             for package, names in named.items() for name in names]
    return found + sorted(STYLES.glob("*.*"))


@dataclass
class Outcome:
    """How it went with one file."""

    name: str
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
        return f"{self.name}: {self.fault() or 'well'}"


def run(seed: int, folder: Path) -> Outcome:
    """One malformed file."""
    files = sources()
    source = files[(seed // 7) % len(files)]
    mutation, content = malformed(source.read_text(encoding="utf-8"), seed)
    path = _beside(source, folder / str(seed))
    path.write_bytes(content.replace(b"THIS_FILE", str(path).encode()))
    if source.suffix == ".yaml":
        launch = path.with_name("of_the_parameters.launch")
        launch.write_text(f'<launch><rosparam file="{path}"/></launch>', encoding="utf-8")
        path = launch
    return checked(path, f"seed {seed} ({mutation} of {source.name})")


def _beside(source: Path, folder: Path) -> Path:
    """Where the source would stand in a folder that has all that stands beside it."""
    folder.mkdir()
    for other in source.parent.iterdir():
        if other != source:
            (folder / other.name).symlink_to(other)
    return folder / source.name


def run_case(name: str, folder: Path) -> Outcome:
    """A file with spoilt parts, or with very many."""
    inner = Path(tempfile.mkdtemp(dir=folder))
    if name in PARTS:
        return checked(PARTS[name](inner), name)
    file, text = LARGE[name]
    path = inner / file
    path.write_text(text, encoding="utf-8")
    return checked(path, name)


def checked(path: Path, name: str) -> Outcome:
    """What `check` makes of a file."""
    log = path.with_suffix(".log")
    sys.stdout.flush()
    child = os.fork()
    if child == 0:
        _be_checked(path, log)
    _, status, usage = _wait(child, time.monotonic() + LONGEST_WAIT)
    return Outcome(name, os.waitstatus_to_exitcode(status),
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
    models = os.environ.get("GAZEBO_MODEL_PATH", "")
    os.environ["GAZEBO_MODEL_PATH"] = f"{STYLES / 'models'}:{models}"
    code = 99
    try:
        code = command.main([str(path)])
    except BaseException:
        traceback.print_exc()
    finally:
        output.flush()
        os._exit(code)


def main() -> int:
    """The seeds of the command line, or all files with spoilt parts."""
    with tempfile.TemporaryDirectory(prefix="malformed-") as name:
        folder, bad = Path(name), 0
        if sys.argv[1] == "parts":
            outcomes = [partial(run_case, case, folder) for case in (*PARTS, *LARGE)
                        if all(word in case for word in sys.argv[2:])]
        else:
            first, last = int(sys.argv[1]), int(sys.argv[2])
            outcomes = [partial(run, seed, folder) for seed in range(first, last)]
        for make in outcomes:
            outcome = make()
            if outcome.fault():
                bad += 1
                tail = "\n".join(outcome.output.splitlines()[-4:])
                print(f"{outcome.line()}\n{tail[-600:]}", flush=True)
    print(f"{len(outcomes)} files, {bad} bad", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
