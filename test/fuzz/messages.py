"""Messages with spoilt fields: by their definition, as a stranger's node may send them."""

from __future__ import annotations

import io
import math
import random
from typing import Any

import genpy
from roslib.message import get_message_class
from sensor_msgs.msg import PointField

FLOATS = (float("nan"), float("inf"), -float("inf"), 0.0, -0.0, -1.0, 1e-320, 1e9, 1e38, 1e308)
TEXTS = ("", "no_such", "x" * 200, "a b", "/", "a::b", "名", "\0", "..", "%s", " ", "~a", "/a//b")
STAMPS = (0, 1, 1_700_000_000, 2**31 - 1, 2**31, 2**32 - 1)  # s: 1970, today, 2038, 2106
LENGTHS = (0, 1, 2, 7, 1000)
MOST_DEPTH = 4


def spoil(message: genpy.Message, rng: random.Random, names: tuple[str, ...] = ()) -> genpy.Message:
    """The same message with some fields changed; `names` are texts that mean something."""
    for slot, kind in zip(message.__slots__, message._slot_types):
        setattr(message, slot, _value(kind, getattr(message, slot), rng, names))
    if message._type in FITTING and rng.random() < 0.7:  # else its sizes do not fit together
        FITTING[message._type](message, rng)
    if message._type in ALWAYS:
        ALWAYS[message._type](message, rng)
    return message


def fit_image(image: Any, rng: random.Random) -> None:
    """As many bytes as its size and encoding say."""
    image.width, image.height = rng.choice(((0, 0), (1, 1), (64, 48), (3, 200)))
    image.step = image.width * {"mono8": 1, "16UC1": 2, "32FC1": 4}.get(image.encoding, 3)
    image.data = rng.randbytes(image.step * image.height)


def fit_cloud(cloud: Any, rng: random.Random) -> None:
    """Points of three float32."""
    cloud.fields = [PointField(name, 4 * place, PointField.FLOAT32, 1)
                    for place, name in enumerate("xyz")]
    cloud.width, cloud.height, cloud.point_step = rng.choice((0, 1, 50)), 1, 12
    cloud.row_step = cloud.width * cloud.point_step
    cloud.data = rng.randbytes(cloud.row_step)


def fit_grid(grid: Any, rng: random.Random) -> None:
    """As many cells as its size says."""
    grid.info.width, grid.info.height = rng.choice(((0, 0), (1, 1), (20, 30)))
    grid.data = [rng.randint(-1, 100) for _ in range(grid.info.width * grid.info.height)]


def keep_clock(tree: Any, _rng: random.Random) -> None:
    """tf2 ends a process whose tree is dated at the end of ROS's clock, in 2106."""
    for transform in tree.transforms:
        transform.header.stamp.secs = min(transform.header.stamp.secs, 2**32 - 1000)


FITTING = {"sensor_msgs/Image": fit_image, "sensor_msgs/PointCloud2": fit_cloud,
           "nav_msgs/OccupancyGrid": fit_grid}
ALWAYS = {"tf2_msgs/TFMessage": keep_clock, "tf/tfMessage": keep_clock}


def carried(message: genpy.Message) -> genpy.Message | None:
    """As it arrives at the other end; None where it cannot be sent."""
    buffer = io.BytesIO()
    try:
        message.serialize(buffer)
    except (genpy.SerializationError, OverflowError, TypeError, ValueError):
        return None
    return type(message)().deserialize(buffer.getvalue())


def _value(kind: str, now: Any, rng: random.Random, names: tuple[str, ...], depth: int = 0) -> Any:
    if kind.endswith("]"):
        return _list(kind, now, rng, names, depth)
    if "/" in kind:
        inner = now if now is not None else get_message_class(kind)()
        if depth < MOST_DEPTH and rng.random() < 0.8:
            for slot, of in zip(inner.__slots__, inner._slot_types):
                setattr(inner, slot, _value(of, getattr(inner, slot), rng, names, depth + 1))
        return inner
    if rng.random() < 0.5:
        return now
    if kind in ("float32", "float64"):
        special = [one for one in FLOATS if kind == "float64" or not 1e39 < one < math.inf]
        return rng.choice((*special, rng.uniform(-10, 10), rng.uniform(-1, 1)))
    if kind == "string":
        return rng.choice(names if names and rng.random() < 0.7 else TEXTS)
    if kind in ("time", "duration"):
        made = genpy.Time if kind == "time" else genpy.Duration
        seconds = rng.choice(STAMPS if kind == "time" else (0, -1, 1, 5, 2**31 - 1, -(2**31)))
        return made(seconds, rng.choice((0, 1, 999_999_999)))
    if kind == "bool":
        return rng.random() < 0.5
    unsigned = kind in ("byte", "char") or kind.startswith("u")
    bits = int(kind.lstrip("uint")) if kind[-1].isdigit() else 8
    low, high = (0, 2**bits - 1) if unsigned else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    return rng.choice((low, high, 0, 1, min(high, rng.randint(0, 100))))


def _list(kind: str, now: Any, rng: random.Random, names: tuple[str, ...], depth: int) -> Any:
    element, _, count = kind[:-1].rpartition("[")
    length = int(count) if count else rng.choice((len(now), *LENGTHS))
    if element in ("uint8", "char"):
        return bytes(rng.choices(range(256), k=length))
    if element in ("float32", "float64") and rng.random() < 0.7:  # numbers, and one that is none
        values = [rng.uniform(0.1, 4.0) for _ in range(length)]
        if values and rng.random() < 0.5:
            values[rng.randrange(length)] = rng.choice(FLOATS)
        return values
    empty = get_message_class(element)() if "/" in element else None
    length = min(length, 20) if "/" in element else length
    return [_value(element, type(empty)() if empty is not None else _zero(element), rng, names,
                   depth + 1) for _ in range(length)]


def _zero(kind: str) -> Any:
    return {"string": "", "bool": False, "time": genpy.Time(), "duration": genpy.Duration(),
            "float32": 0.0, "float64": 0.0}.get(kind, 0)
