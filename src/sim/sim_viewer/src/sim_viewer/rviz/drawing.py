"""A drawing: parts that the page knows how to draw, and their encoding in bytes.

A frame is its number (uint32), the length of its head (uint32), the head as JSON, padded to 4
bytes, then the arrays, each at a multiple of 4 bytes. The head is a list of parts with `kind`,
`pose` (x, y, z in m and the quaternion x, y, z, w, in the fixed frame), their fields, and `arrays`:
{name: [kind, offset behind the head, count of numbers]}, kind `f4` or `u1`, little-endian. A part
whose `key` the page has drawn before comes without arrays.
"""

import json
import struct
from collections.abc import Container
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bullet_sim.pose import IDENTITY, Pose

CODES = {"f": "f4", "u": "u1"}
ALIGNED = 4  # bytes


@dataclass
class Part:
    """Things of one kind, with the arrays (float32 or uint8) and fields of that kind.

    points: position (n, 3) m, colour (n, 4); size, unit ("m" or "px"), round
    lines: position (2 n, 3), colour (2 n, 4); width m
    triangles: position (3 n, 3), colour (3 n, 4)
    shapes: rows (n, 10) of pose and scale, colour (n, 4); shape: cube, sphere, cylinder, cone
    texts: texts [{text, position, height m, colour}]
    map: cells (height * width), uint8 views of int8; width, height in cells, size m, ...
    camera: jpeg, the bytes of a file; size px, focal_length, principal_point, ...
    links: rows (n, 7) of poses; links as page_scene has them
    """

    kind: str
    arrays: dict[str, np.ndarray] = field(default_factory=dict)
    fields: dict[str, Any] = field(default_factory=dict)
    pose: Pose = IDENTITY
    key: str = ""  # names arrays that are large and seldom change


def frame(number: int, content: bytes) -> bytes:
    """The bytes of a frame."""
    return struct.pack("<I", number) + content


def encode(parts: list[Part], known: Container[str] = ()) -> bytes:
    """A frame's content; arrays of parts with `known` keys are left out."""
    heads, chunks, at = [], [], 0
    for part in parts:
        head = {"kind": part.kind, "pose": [*part.pose.position, *part.pose.orientation],
                "key": part.key, **part.fields}
        if not part.key or part.key not in known:
            head["arrays"] = {}
            for name, array in part.arrays.items():
                data, code = _plain(array)
                head["arrays"][name] = [code, at, array.size]
                padding = -len(data) % ALIGNED
                chunks += [data, bytes(padding)]
                at += len(data) + padding
        heads.append(head)
    text = json.dumps(heads, allow_nan=False, separators=(",", ":")).encode()
    text += b" " * (-len(text) % ALIGNED)
    return b"".join([struct.pack("<I", len(text)), text, *chunks])


def _plain(array: np.ndarray) -> tuple[bytes, str]:
    code = CODES[array.dtype.kind]
    return np.ascontiguousarray(array, f"<{code}").tobytes(), code


def points_of(parts: list[Part]) -> int:
    """How many points, corners and instances there are to draw."""
    return sum(len(part.arrays["colour"]) for part in parts if "colour" in part.arrays)
