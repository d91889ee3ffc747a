"""Programs that end within a second of a signal, whatever they are doing, without a traceback.

A script imports only this module and calls `run`: slow work, including imports with Numba, then
happens while signals are already handled.

    run("amcl.node")  # its main()
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
import importlib
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NoReturn

# MALLOC_TRIM_THRESHOLD_ and MALLOC_MMAP_THRESHOLD_ of the environment, for GNU's mallopt.
_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
_LARGE = 1 << 17  # bytes; what the C library begins with if nobody says otherwise
LIMIT = 0.5  # s from the signal until the process exits, even if something still hangs

_told: list[int] = []         # the signals received, in order
_begun = threading.Event()    # a node is being made or exists
_closed = threading.Event()   # its topics and services are unregistered from the master


def run(module: str) -> NoReturn:
    """Calls the module's main() and ends the process with the status that it returns (None: 0).

    SIGINT and SIGTERM shut the node down, so that `spin` and loops on rospy.is_shutdown() return;
    the status is then still main's. If main does not return in time, or has no node yet, the
    status is 128 + the signal, as in a shell for a process that was killed.
    """
    give_memory_back()
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    signal.set_wakeup_fd(writing, warn_on_full_buffer=False)  # also while C code runs
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: None)
    threading.excepthook = _of_a_thread
    threading.Thread(target=_watch, args=(reading,), daemon=True).start()
    try:
        status = _status(importlib.import_module(module).main())
    except SystemExit as end:
        status = _status(end.code)
    except BaseException as error:  # at exit anything may be closed already
        if not is_ending() and not isinstance(error, BrokenPipeError):
            traceback.print_exc()
        status = 128 + _told[0] if _told else 1
    if is_ending():
        _closed.wait(LIMIT)
    elif _begun.is_set():
        _shut_down("the program has ended")
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError):  # the reader, as of `roslaunch ... | grep`, has ended
            stream.flush()
    os._exit(status)  # Python's own exit waits for threads, and a second for Numba's objects


def give_memory_back() -> None:
    """Let the C library give freed arrays back to the system at once.

    The workspace's environment lets it keep 64 MiB, for programs that take images apart: a peak of
    that size would stay for ever. Costs a planner a millisecond a plan.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)  # not every C library has it
    if mallopt is not None:
        mallopt(_MMAP_THRESHOLD, _LARGE)
        mallopt(_TRIM_THRESHOLD, _LARGE)


def init_node(name: str) -> None:
    """rospy.init_node in a program started by `run`, after all imports.

    Excludes the imported objects from garbage collection: they stay anyway.
    """
    import rospy

    gc.freeze()
    _begun.set()
    rospy.init_node(name, disable_signals=True)
    rospy.core.add_shutdown_hook(lambda _reason: _closed.set())


def spin() -> None:
    """Wait until the node has been shut down and unregistered from the master."""
    _closed.wait()


def run_node(name: str, package: str, table_file: str,
             make: Callable[[dict[str, Any], list], object], others: Iterable[str] = ()) -> int:
    """Run the node that `make` makes of its parameters' values and table; the exit status.

    `table_file` is below the package's folder; `others` are parameters that are not in it.
    """
    import rospkg
    import rospy

    from nav_nodes.ignored import warn_of_ignored
    from nav_nodes.parameters import ParameterError, load_table, read_parameters

    init_node(name)
    try:
        table = load_table(Path(rospkg.RosPack().get_path(package)) / table_file)
        values = read_parameters(table)
        warn_of_ignored({"": table}, others)
        make(values, table)
    except ParameterError as error:
        rospy.logfatal("%s", error)
        return 1
    spin()
    return 0


def is_ending() -> bool:
    """Whether a signal or the master has asked the program to end."""
    core = sys.modules.get("rospy.core")
    return bool(_told or (_begun.is_set() and core.is_shutdown_requested()))


def _watch(reading: int) -> None:
    """Handles a signal, on a thread of its own, as the main thread may hold any lock."""
    _told.append(os.read(reading, 1)[0])
    if _begun.is_set():
        threading.Thread(target=_shut_down, args=[f"signal {_told[0]}"], daemon=True).start()
        threading.Event().wait(LIMIT)
    os._exit(128 + _told[0])


def _shut_down(reason: str) -> None:
    sys.modules["rospy"].signal_shutdown(reason)
    _closed.set()  # also if the node was never completed


def _of_a_thread(failed: threading.ExceptHookArgs) -> None:
    if not is_ending():
        threading.__excepthook__(failed)


def _status(returned: object) -> int:
    """The exit status for main's return value, as in sys.exit."""
    if returned is None or isinstance(returned, int):
        return returned or 0
    print(returned, file=sys.stderr)
    return 1
