"""Notices that the ROS master with which a node registered has ended; rospy does not."""

from __future__ import annotations

import threading

import rosgraph


class MasterWatch:
    """Asks once a second, in its own thread. Create it after the node is initialised."""

    PERIOD = 1.0  # s

    def __init__(self, node_name: str):
        self.gone = False
        self._master = rosgraph.Master(node_name)
        self.uri = self._master.getUri()
        threading.Thread(target=self._watch, daemon=True).start()

    def _watch(self) -> None:
        known, waiting = self._pid(), threading.Event()
        while not self.gone:
            waiting.wait(self.PERIOD)
            # Another process at the same address is a new roscore, which does not know this node.
            self.gone = self._pid() != known

    def _pid(self) -> int | None:
        try:
            return self._master.getPid()
        except (OSError, rosgraph.MasterException):
            return None
