"""Action servers of controllers: one goal at a time, in the loop."""

import actionlib
from actionlib import ServerGoalHandle


class GoalSlot:
    """Holds the active goal; a new goal preempts it."""

    def __init__(self):
        self._handle: ServerGoalHandle | None = None

    @property
    def occupied(self) -> bool:
        """Whether there is an active goal."""
        return self._handle is not None

    def accept(self, handle: ServerGoalHandle) -> None:
        """Make this the active goal."""
        self.preempt()
        handle.set_accepted()
        self._handle = handle

    def holds(self, handle: ServerGoalHandle) -> bool:
        """Whether this is the active goal."""
        return self._handle is not None and self._handle == handle

    def preempt(self) -> None:
        """Cancel the active goal, if there is one."""
        handle, self._handle = self._handle, None
        if handle:
            handle.set_canceled()

    def finish(self, succeeded: bool, result, text: str = "") -> None:
        """End the active goal, if there is one, as succeeded or aborted."""
        handle, self._handle = self._handle, None
        if handle and succeeded:
            handle.set_succeeded(result, text)
        elif handle:
            handle.set_aborted(result, text)

    def publish_feedback(self, feedback) -> None:
        """Publish feedback for the active goal, if there is one."""
        if self._handle:
            self._handle.publish_feedback(feedback)


class LoopActionServer(actionlib.ActionServer):
    """Goals and cancels are passed on as they come; the loop calls `publish_status`.

    rospy's timer would end with an exception when simulated time is reset.
    """

    STATUS_RATE = 5.0  # Hz, simulated; actionlib's default

    def initialize(self) -> None:
        """Open the topics; the timer that actionlib starts with them is ended at once."""
        super().initialize()
        if self.status_timer is not None:  # none if actionlib_status_frequency is 0
            self.status_timer.shutdown()
