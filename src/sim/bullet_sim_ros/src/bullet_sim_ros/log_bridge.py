"""Carries the core's log to rosout, so that one console shows all."""

import logging

import rospy

_SENDERS = {
    logging.DEBUG: rospy.logdebug,
    logging.INFO: rospy.loginfo,
    logging.WARNING: rospy.logwarn,
    logging.ERROR: rospy.logerr,
    logging.CRITICAL: rospy.logfatal,
}


class _ToRosout(logging.Handler):
    def emit(self, record: logging.LogRecord) -> None:
        _SENDERS.get(record.levelno, rospy.loginfo)("%s", record.getMessage())


def forward_core_log(verbose: bool) -> None:
    """Call once, after init_node."""
    core = logging.getLogger("bullet_sim")
    core.setLevel(logging.INFO if verbose else logging.WARNING)
    core.addHandler(_ToRosout())
    core.propagate = False
