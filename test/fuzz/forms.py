"""Requests of services as a person fills them in on the page."""

from __future__ import annotations

import io
from pathlib import Path

from gazebo_msgs.srv import SetModelState, SetPhysicsProperties, SpawnModel
from mutating import TEXT, spoilt
from sensor_msgs.msg import Joy, LaserScan
from sim_viewer.registry import Refused
from sim_viewer.tools.forms import fill, template
from target import Target

KINDS = (SpawnModel._request_class, SetModelState._request_class,
         SetPhysicsProperties._request_class, LaserScan, Joy)


def fill_in(path: Path) -> None:
    """A form of the kind that takes it, and the message as it would be sent."""
    text = path.read_text("utf-8", errors="replace")
    kind = next((one for one in KINDS if one.__slots__[0] in text), KINDS[0])
    fill(kind, text).serialize(io.BytesIO())


TARGETS = (
    Target("form", "form.yaml", spoilt([template(kind).encode() for kind in KINDS], TEXT), fill_in,
           (Refused,)),
)
