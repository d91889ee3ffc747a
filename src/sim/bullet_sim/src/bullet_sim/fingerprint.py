"""Fingerprints, to tell two runs apart to the bit: of a world's state, and of its description."""

import struct
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from hashlib import blake2b, sha256
from typing import Any
from xml.etree.ElementTree import Element, tostring

from bullet_sim.world import World

BYTES = 4  # by chance two states have the same once in four thousand million


def fingerprint(world: World, before: bytes = b"") -> bytes:
    """Of time, and of the pose and twist of each link that can move; and of those `before`.

    Each bit counts. A fingerprint that is given the one before it is of the whole run so far.
    """
    found = blake2b(before, digest_size=BYTES)
    found.update(struct.pack("<q", world.tick))
    for model in world.models.values():
        if model.static:
            continue
        for name, (pose, twist) in model.link_states().items():
            found.update(f"{model.name}::{name}".encode())
            found.update(struct.pack("<13d", *pose.position, *pose.orientation,
                                     *twist.linear, *twist.angular))
    return found.digest()


def description_hash(description: Any) -> str:
    """SHA-256 of a description (a dataclass) as it was read from its files."""
    found = sha256()
    for text in _texts(description):
        found.update(text.encode() + b"\0")
    return found.hexdigest()


def _texts(value: Any) -> Iterator[str]:
    if is_dataclass(value):
        yield type(value).__name__
        for field in fields(value):
            yield from _texts(getattr(value, field.name))
    elif isinstance(value, (tuple, list, dict)):
        yield f"{type(value).__name__} of {len(value)}"
        for part in value.items() if isinstance(value, dict) else value:
            yield from _texts(part)
    elif isinstance(value, Element):
        yield tostring(value, "unicode")
    else:
        yield repr(value)
