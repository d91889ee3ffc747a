"""Programs that end within a second of being told to, whatever they are doing, without a traceback.

A script imports nothing but this module and calls `run`: what takes long, the imports with Numba
among them, then happens where a signal is already waited for.

    run("amcl.node")  # its main()
"""

from __future__ import annotations

import gc
import importlib
import os
import signal
import sys
import threading
import traceback
from typing import NoReturn

LIMIT = 0.5  # s from the signal until the process goes, even if something still hangs

_told: list[int] = []         # the signals that came, the first one first
_begun = threading.Event()    # a node is being made or is there
_closed = threading.Event()   # its topics and services are gone from the master


def run(module: str) -> NoReturn:
    """Calls the module's main() and ends the process with the status that it returns (None: 0).

    SIGINT and SIGTERM shut the node down, by which `spin` and all that asks rospy.is_shutdown()
    return; then the status is still main's. Where main does not return in time, or has no node
    yet, the status is 128 + the signal, as a shell says it of a process that was killed.
    """
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
    except BaseException:  # on the way out anything may be closed already
        if not is_ending():
            traceback.print_exc()
        status = 128 + _told[0] if _told else 1
    if is_ending():
        _closed.wait(LIMIT)
    elif _begun.is_set():
        _shut_down("the program has ended")
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    os._exit(status)  # Python's own end waits for threads, and a second for Numba's objects


def init_node(name: str) -> None:
    """rospy.init_node in a program that `run` runs; all imports are done.

    What they made is left out of Python's search for garbage from now on: it stays anyway.
    """
    import rospy

    gc.freeze()
    _begun.set()
    rospy.init_node(name, disable_signals=True)
    rospy.core.add_shutdown_hook(lambda _reason: _closed.set())


def spin() -> None:
    """Until the node is told to end, and has left the master."""
    _closed.wait()


def is_ending() -> bool:
    """Whether the program was told to end, by a signal or by the master."""
    core = sys.modules.get("rospy.core")
    return bool(_told or (_begun.is_set() and core.is_shutdown_requested()))


def _watch(reading: int) -> None:
    """On a thread: what a signal begins. The main thread may hold any lock then."""
    _told.append(os.read(reading, 1)[0])
    if _begun.is_set():
        threading.Thread(target=_shut_down, args=[f"signal {_told[0]}"], daemon=True).start()
        threading.Event().wait(LIMIT)
    os._exit(128 + _told[0])


def _shut_down(reason: str) -> None:
    sys.modules["rospy"].signal_shutdown(reason)
    _closed.set()  # also where the node was never finished


def _of_a_thread(failed: threading.ExceptHookArgs) -> None:
    if not is_ending():
        threading.__excepthook__(failed)


def _status(returned: object) -> int:
    """As sys.exit takes it."""
    if returned is None or isinstance(returned, int):
        return returned or 0
    print(returned, file=sys.stderr)
    return 1
