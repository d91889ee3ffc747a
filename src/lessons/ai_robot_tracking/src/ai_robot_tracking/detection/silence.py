"""Why no image comes on a topic, in a line."""

from __future__ import annotations

from collections.abc import Iterable

IMAGE = "sensor_msgs/Image"
COURSE = "roslaunch ai_robot_tracking start_tracking.launch"


def why_silent(topic: str, published: Iterable[Iterable[str]], own: str) -> str:
    """What is wrong with the topic and what to type; empty if images are published on it.

    published: the master's topics, each with its type. Topics below the node's `own` name are not
    offered.
    """
    types = dict(published)
    kind = types.get(topic)
    if kind == IMAGE:
        return ""
    images = ", ".join(sorted(name for name, its in types.items()
                              if its == IMAGE and not name.startswith(f"{own}/")))
    if not images:
        return (f"no image on {topic}: nobody publishes images. Start the course in another "
                f"terminal: {COURSE}; this program then goes on by itself")
    reason = f"it carries messages of type {kind}" if kind else "nobody publishes it"
    return (f"no image on {topic}: {reason}. Topics with images: {images}. End this program and "
            "start it with one of them: image:=TOPIC")
