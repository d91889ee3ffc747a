"""Subscribers of this process hear every publisher, in whatever order they are told of them.

The master answers a subscription with the publishers of that moment and tells of later ones by a
call. rospy takes what it has read last for the newest: when it reads the answer after the call, it
never connects to the publisher of the call. So one wheel of a car stood still whose controllers had
started at the same moment as what drives it.
"""

from rospy.impl.registration import RegManager


def keep_every_publisher() -> None:
    """For every subscription of this process from now on."""
    RegManager.publisher_update = _add_update


def _add_update(manager: RegManager, topic: str, uris: list[str]) -> None:
    """In the place of rospy's: lists that wait become one. Who has ended meanwhile refuses."""
    with manager.cond:
        waiting = [uri for name, known in manager.updates if name == topic for uri in known]
        manager.updates.append((topic, list(dict.fromkeys([*waiting, *uris]))))
        manager.cond.notify_all()
