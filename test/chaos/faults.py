"""The faults that can be injected into a drive."""

from __future__ import annotations

import contextlib
import fcntl
import signal
import socket
import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from random import Random

from clock import set_clock
from drive import JudgedDrive, Watched
from members import send

LONGEST_JUMP = 7200.0  # s
GET_FLAGS, SET_FLAGS, IS_UP = 0x8913, 0x8914, 1  # <linux/sockios.h>, <linux/if.h>
FILLER = "filler"
CLOCK = "clock"
ENDED, DRIVEN = (2,), (0, 1)  # exit codes of a judge that could not run, and that could


@dataclass(frozen=True)
class Fault:
    """`begin` injects it into a drive, `end` undoes it after a while, if at all."""

    name: str
    begin: Callable[[Watched, Random], object]
    codes: tuple[int, ...]  # allowed exit codes of the judge
    victim: str = ""  # process or node that it affects
    end: Callable[[JudgedDrive], object] | None = None
    on_tmpfs: bool = False  # results are on a small file system of their own
    by_hand: bool = False  # `begin` ends the victim, which is then restarted
    roscore: bool = False  # by hand: the master is not roslaunch's


def _kill(victim: str, codes: tuple[int, ...] = ENDED) -> Fault:
    return Fault(f"kill {victim}", lambda drive, _: send(drive.pids(victim), signal.SIGKILL),
                 codes, victim)


def _kill_driver(victim: str) -> Fault:
    """Kill it while the judge is suspended, which would end the simulation before the car stops."""

    def begin(drive: JudgedDrive, _: Random) -> None:
        send(drive.pids("judge"), signal.SIGSTOP)
        send(drive.pids(victim), signal.SIGKILL)

    return Fault(f"kill {victim}", begin, ENDED, victim,
                 lambda drive: send(drive.pids("judge"), signal.SIGCONT))


def _stop(victim: str) -> Fault:
    return Fault(f"stop {victim}", lambda drive, _: send(drive.pids(victim), signal.SIGSTOP),
                 DRIVEN, victim, lambda drive: send(drive.pids(victim), signal.SIGCONT))


def _restart(victim: str, killed: bool, roscore: bool = False) -> Fault:
    if killed:
        return Fault(f"restart {victim} after kill -9",
                     lambda hands, _: send(hands.pids(victim), signal.SIGKILL), (), victim,
                     by_hand=True, roscore=roscore)
    return Fault(f"restart {victim}", lambda hands, _: hands.interrupt(victim), (), victim,
                 by_hand=True, roscore=roscore)


def fill_disk(drive: JudgedDrive, rng: Random) -> None:
    """Fill the disk until nothing, or a little, is left, so that files are cut off."""
    spare = rng.choice((0, 0, 4096, 16384, 65536, 262144))
    with (drive.results / FILLER).open("wb", buffering=0) as file:
        with contextlib.suppress(OSError):
            while True:
                file.write(bytes(65536))
        file.truncate(max(0, file.tell() - spare))


def empty_disk(folder: Path) -> None:
    """Remove the filler again."""
    (folder / FILLER).unlink(missing_ok=True)


def set_loopback(up: bool) -> None:
    """Set the loopback of this process's network namespace up or down."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        asked = struct.pack("16sh14x", b"lo", 0)
        flags = struct.unpack("16sh14x", fcntl.ioctl(probe, GET_FLAGS, asked))[1]
        flags = flags | IS_UP if up else flags & ~IS_UP
        fcntl.ioctl(probe, SET_FLAGS, struct.pack("16sh14x", b"lo", flags))


def jump_clock(drive: JudgedDrive, rng: Random) -> None:
    """Move the clock forward or back, by seconds or hours, and leave it there."""
    seconds = rng.choice((1.0, LONGEST_JUMP)) * rng.uniform(-1.0, 1.0) * 10.0
    set_clock(drive.folder, seconds)


def faults_of(drivers: tuple[str, ...]) -> list[Fault]:
    """All faults of a drive with these driving nodes."""
    others = ("simulator", "master", "roscore", "roslaunch")
    return [*map(_kill_driver, drivers), *map(_kill, others), _kill("judge", (-signal.SIGKILL,)),
            _kill("encoder", DRIVEN), *map(_stop, (*drivers, *others, "judge")),
            Fault("disk", fill_disk, (*DRIVEN, *ENDED), on_tmpfs=True),
            Fault("interface", lambda *_: set_loopback(False), (*DRIVEN, *ENDED),
                  end=lambda _: set_loopback(True)),
            Fault(CLOCK, jump_clock, DRIVEN),
            *(_restart(driver, killed) for driver in drivers for killed in (False, True)),
            _restart("roslaunch", False), _restart("roslaunch", True, roscore=True),
            _restart("simulator", True), _restart("roscore", False, roscore=True),
            _restart("master", True, roscore=True)]
