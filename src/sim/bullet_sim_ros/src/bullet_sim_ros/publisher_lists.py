"""Makes rospy's subscribers connect to all publishers, in whatever order it learns of them.

The master answers a subscription with the publishers of that moment, and reports later ones by a
call. rospy takes the list that it has read last for the newest: if it reads the answer after the
call, it never connects to the call's publisher. So one wheel of a car stood still whose controllers
had started at the same moment as the node that drives it.
"""

from rospy.impl.registration import RegManager


def keep_every_publisher() -> None:
    """Do so for every subscription of this process from now on."""
    RegManager.publisher_update = _add_update


def _add_update(manager: RegManager, topic: str, uris: list[str]) -> None:
    """Replaces rospy's: merges the waiting lists. Publishers that have ended refuse connections."""
    with manager.cond:
        waiting = [uri for name, known in manager.updates if name == topic for uri in known]
        manager.updates.append((topic, list(dict.fromkeys([*waiting, *uris]))))
        manager.cond.notify_all()
