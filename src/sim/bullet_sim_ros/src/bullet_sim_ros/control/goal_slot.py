"""The active goal of an action server, of which there is one at most; for the loop's thread."""

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
