"""Which client drives which topic, and a thread that stops those left alone. Without ROS."""

import threading
import time
from collections.abc import Callable, Hashable

from sim_viewer.dead_man import Command, DeadMan


class Handles:
    """A DeadMan for each topic. All methods may be called from any thread."""

    def __init__(self, publish: Callable[[str, Command], None],
                 clock: Callable[[], float] = time.monotonic) -> None:
        self._publish = publish
        self._clock = clock
        self._handles: dict[str, DeadMan] = {}
        self._changed = threading.Condition()
        self._closed = False
        self._timer = threading.Thread(target=self._stop_in_time, name="dead man", daemon=True)
        self._timer.start()

    def press(self, client: Hashable, topic: str, command: Command) -> None:
        """Pass a command on; DrivenByAnother if another client drives this topic.

        A client drives one topic: what it drove before is stopped.
        """
        with self._changed:
            self._release(client, besides=topic)
            handle = self._handles.setdefault(topic, DeadMan())
            self._send(topic, handle.press(client, command, self._clock()))
            self._changed.notify()

    def release(self, client: Hashable) -> None:
        """The client released the controls, or disconnected."""
        with self._changed:
            self._release(client)

    def close(self) -> None:
        """Stop everything that is driven, and the thread."""
        with self._changed:
            self._closed = True
            for topic, handle in self._handles.items():
                self._send(topic, handle.release(handle.driver))
            self._changed.notify()
        self._timer.join()

    def _release(self, client: Hashable, besides: str = "") -> None:
        for topic, handle in self._handles.items():
            if topic != besides:
                self._send(topic, handle.release(client))

    def _send(self, topic: str, commands: list[Command]) -> None:
        for command in commands:
            self._publish(topic, command)

    def _stop_in_time(self) -> None:
        with self._changed:
            while not self._closed:
                now = self._clock()
                for topic, handle in self._handles.items():
                    self._send(topic, handle.expire(now))
                due = min((handle.until for handle in self._handles.values()), default=float("inf"))
                self._changed.wait(None if due == float("inf") else max(due - now, 0.0))
