"""An actionlib server whose status is published by the loop instead of a timer's thread."""

import actionlib


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
