"""Passes calls from ROS threads to the loop's thread, the only one that may use the physics."""

import logging
import queue
import threading
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import TimeoutError as NotYet
from typing import Any

from bullet_sim_ros.inputs import Input

log = logging.getLogger("bullet_sim.mailbox")


class Closed(Exception):
    """The loop has ended: there will be no answer."""


class Mailbox:
    """Calls wait here until the loop runs them between two steps."""

    def __init__(self):
        # Not SimpleQueue: if a slow signal handler interrupts its timed get, that waits for ever.
        self._calls: queue.Queue[
            tuple[Callable[[], Any], Future | None, Input | None]] = queue.Queue()
        self._closed = threading.Event()
        self.each_call: list[Callable[[str, str], None]] = []  # called with name and caller
        self.each_input: list[Callable[[Input], None]] = []  # called in the loop, before it acts
        self.deaf = False  # whether messages from topics are dropped

    def call(self, function: Callable[[], Any], source: Input | None = None) -> Any:
        """From any thread: run `function` in the loop, and return or raise what it does.

        `source`: what it does to the world, if anything.

        Closed if the simulator ends first.
        """
        future: Future = Future()
        self._calls.put((function, future, source))
        while True:
            try:
                return future.result(timeout=0.5)
            except NotYet:
                if future.done():
                    raise  # the function itself timed out
                if self._closed.is_set():
                    raise Closed("the simulator is shutting down") from None

    def post(self, function: Callable[[], Any], source: Input | None = None) -> None:
        """From any thread: have `function` run in the loop, without waiting; errors are logged."""
        self._calls.put((function, None, source))

    def announce(self, name: str, message: Any) -> None:
        """From any thread: a service or topic that acts on the world was called by this message."""
        if self.each_call:
            header = getattr(message, "_connection_header", None) or {}
            caller = header.get("callerid", "")
            self.post(lambda: [observe(name, caller) for observe in self.each_call])

    def note(self, source: Input) -> None:
        """From the loop: something is about to act on the world."""
        for observe in self.each_input:
            observe(source)

    def run_pending(self, wait: float = 0.0) -> bool:
        """From the loop: run the waiting calls; `wait` for a first one (s, wall). False: none came.
        """
        ran = False
        try:
            item = self._calls.get(timeout=wait) if wait else self._calls.get_nowait()
            while True:
                ran = True
                self._run(*item)
                item = self._calls.get_nowait()
        except queue.Empty:
            return ran

    def close(self) -> None:
        """From the loop: refuse calls that still wait, with Closed."""
        self._closed.set()

    def _run(self, function: Callable[[], Any], future: Future | None,
             source: Input | None) -> None:
        if source is not None:
            if self.deaf and not source.called:
                return
            self.note(source)
        try:
            result = function()
        except Exception as error:
            if future is None:
                log.error("%s: %s", type(error).__name__, error)
            else:
                future.set_exception(error)
            return
        if future is not None:
            future.set_result(result)
