"""A fingerprint of the world's state, to tell two runs apart to the bit."""

import struct
from hashlib import blake2b

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
