"""Base class of the tools' watchables: polls at a period and sends what has changed."""

import abc
import asyncio
import contextlib
import threading
from typing import Any

import rospy

from sim_viewer.registry import Refused
from sim_viewer.tools.master import MasterView


class Paced(abc.ABC):
    """Subclasses define `open` and `collect`; both run in worker threads, may block and may raise
    Refused. An error of `collect` is sent as `{"error": line}`; `closing` undoes `open`."""

    PERIOD = 0.2  # s between two polls
    KEEP = False  # whether each event counts, not only the newest

    def __init__(self, context: Any, args: dict[str, Any], send: Any):
        self.context = context
        self.args = args
        self.master: MasterView = context.node.shared(MasterView)
        self._send = send
        self._task: asyncio.Task | None = None
        self._lock = threading.Lock()  # a browser may disconnect while its watch is being opened
        self._ended = False
        self._last_error = ""
        self._last: Any = None
        self.closing = contextlib.ExitStack()  # what to undo, also if `open` failed half way

    def open(self) -> None:  # noqa: B027 (not every tool subscribes)
        """Subscribe to what `collect` needs."""

    @abc.abstractmethod
    def collect(self) -> Any:
        """The data to send, or None if nothing is new."""

    def changed(self, data: Any) -> Any:
        """`data`, or None if it is the same as at the last call."""
        if data == self._last:
            return None
        self._last = data
        return data

    async def start(self) -> None:
        await self.context.run_in_thread(self._open)
        self._task = self.context.loop.create_task(self._run())

    async def stop(self) -> None:
        if self._task:
            self._task.cancel()
        await self.context.run_in_thread(self._close)

    def _open(self) -> None:
        with self._lock:
            if not self._ended:
                self.open()

    def _close(self) -> None:
        with self._lock:
            if not self._ended:
                self._ended = True
                self.closing.close()

    async def _run(self) -> None:
        while True:
            data = await self.context.run_in_thread(self._look)
            if data is not None:
                self._send(data, keep=self.KEEP)
            await asyncio.sleep(self.PERIOD)

    def _look(self) -> Any:
        """The data to send; an error is sent once, until `collect` works again."""
        try:
            data = self.collect()
            self._last_error = ""
            return data
        except Refused as error:
            line = str(error)
        except Exception as error:
            line = f"{type(error).__name__}: {error}"
            if line != self._last_error:
                rospy.logwarn("%s: %s", type(self).__name__, line)
        if line == self._last_error:
            return None
        self._last_error = line
        return {"error": line}
