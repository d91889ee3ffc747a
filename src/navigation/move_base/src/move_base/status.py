"""Publishes the action's status, five times a second, also after the clock was set back."""

from __future__ import annotations

import actionlib
import rospy


def keep_telling(server: actionlib.SimpleActionServer) -> None:
    """Call once, after the server's start: actionlib's own timer ends when the clock goes back."""
    actions = server.action_server
    if actions.status_timer is not None:
        actions.status_timer.shutdown()
        actions.status_timer = rospy.Timer(rospy.Duration(1.0 / actions.status_frequency),
                                           actions.publish_status_async, reset=True)
