"""The one goal of an action that is being pursued; used in the loop's thread alone."""

from actionlib import ServerGoalHandle


class GoalSlot:
    """A new goal preempts the one that is in it."""

    def __init__(self):
        self._handle: ServerGoalHandle | None = None

    @property
    def occupied(self) -> bool:
        """Whether a goal is being pursued."""
        return self._handle is not None

    def accept(self, handle: ServerGoalHandle) -> None:
        """Pursue this one from now on."""
        self.preempt()
        handle.set_accepted()
        self._handle = handle

    def holds(self, handle: ServerGoalHandle) -> bool:
        """Whether it is this one."""
        return self._handle is not None and self._handle == handle

    def preempt(self) -> None:
        """Give it up, if there is one."""
        handle, self._handle = self._handle, None
        if handle:
            handle.set_canceled()

    def finish(self, succeeded: bool, result, text: str = "") -> None:
        """It is over."""
        handle, self._handle = self._handle, None
        if handle and succeeded:
            handle.set_succeeded(result, text)
        elif handle:
            handle.set_aborted(result, text)

    def publish_feedback(self, feedback) -> None:
        """How far it is."""
        if self._handle:
            self._handle.publish_feedback(feedback)
