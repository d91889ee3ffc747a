"""actionlib's server, with its status published by the loop instead of a timer's thread."""

import actionlib


class LoopActionServer(actionlib.ActionServer):
    """Goals and cancels are handed on as they come; `publish_status` is called by the loop.

    rospy's timer would end with an exception when the simulation's time is reset.
    """

    STATUS_RATE = 5.0  # Hz, simulated; actionlib's default

    def initialize(self) -> None:
        """Open the topics; the timer that comes with them is ended at once."""
        super().initialize()
        if self.status_timer is not None:  # none if actionlib_status_frequency is 0
            self.status_timer.shutdown()
