"""Requests of services as a person fills them in on the page."""

from __future__ import annotations

import io
from pathlib import Path

from gazebo_msgs.srv import SetModelState, SetPhysicsProperties, SpawnModel
from mutating import TEXT, spoilt
from sensor_msgs.msg import Joy, LaserScan
from sim_viewer.registry import Refused
from sim_viewer.tools.messages import fill, template
from target import Target

KINDS = (SpawnModel._request_class, SetModelState._request_class,
         SetPhysicsProperties._request_class, LaserScan, Joy)


def fill_in(path: Path) -> None:
    """A form of the kind that takes it, and the message as it would be sent."""
    text = path.read_text("utf-8", errors="replace")
    fill(kind_of(text), text).serialize(io.BytesIO())


def kind_of(text: str) -> type:
    """The kind of which the text has the most fields, for how many there are."""
    return max(KINDS, key=lambda kind: sum(
        f"{name}:" in text for name in kind.__slots__) / len(kind.__slots__))


TARGETS = (
    Target("form", "form.yaml", spoilt([template(kind).encode() for kind in KINDS], TEXT), fill_in,
           (Refused,)),
)
