"""Work that ROS's threads leave for the loop, which alone touches the pond."""

from __future__ import annotations

import queue
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from typing import Any

import rospy

from turtlesim.pond.pond import PondError


class Inbox:
    """Everything is done in the order of arrival, once a tick."""

    def __init__(self) -> None:
        self._work: queue.SimpleQueue[tuple[Future, Callable, tuple]] = queue.SimpleQueue()
        self._closed = False

    def put(self, function: Callable, *arguments: Any) -> Future:
        """From any thread; does not wait."""
        answer: Future = Future()
        self._work.put((answer, function, arguments))
        if self._closed:
            self.close()
        return answer

    def call(self, function: Callable, *arguments: Any) -> Any:
        """From a service's thread: waits for the answer; ServiceException if there is none."""
        try:
            return self.put(function, *arguments).result()
        except PondError as error:
            raise rospy.ServiceException(str(error)) from error
        except CancelledError:
            raise rospy.ServiceException("turtlesim has ended") from None

    def work(self) -> None:
        """Do what has arrived. The loop calls this."""
        for _ in range(self._work.qsize()):
            answer, function, arguments = self._work.get()
            try:
                answer.set_result(function(*arguments))
            except Exception as error:
                answer.set_exception(error)

    def close(self) -> None:
        """Reject all pending requests, and those that come later."""
        self._closed = True
        while not self._work.empty():
            self._work.get()[0].cancel()
