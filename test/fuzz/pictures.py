"""Maps and drawings of tracks: images, also a model's texture or shape, and YAML."""

from __future__ import annotations

import random
import struct
import zlib
from contextlib import suppress
from pathlib import Path

import cv2
import numpy as np
from mutating import BINARY, TEXT, spoilt
from racecar_description.track.drawing import Fault, find_mid_line, read_picture
from racecar_description.track.errors import TrackError
from racecar_description.track.track_file import load_centre_line
from target import Target, found

from bullet_sim.description import Heightmap, ImageExtrusion
from bullet_sim.errors import SimulationError
from bullet_sim.meshes.generated import heightmap_parts, image_part
from bullet_sim.meshes.images import PNG, load_image, warn_if_unreadable
from map_server.errors import MapFileError
from map_server.map_files import read_image, read_map

GREY = np.indices((64, 80)).sum(axis=0).astype(np.uint8)
GREY[20:40, 20:60] = 0
COLOUR, DEEP = np.dstack([GREY, GREY // 2, GREY]), GREY.astype(np.uint16) * 256
PICTURES = [(".png", GREY), (".png", COLOUR), (".png", np.dstack([COLOUR, GREY])), (".png", DEEP),
            (".jpg", COLOUR), (".jpg", GREY), (".pgm", GREY), (".pgm", DEEP), (".ppm", COLOUR),
            (".bmp", COLOUR), (".tiff", COLOUR), (".webp", COLOUR)]
FILES = [*(cv2.imencode(kind, pixels)[1].tobytes() for kind, pixels in PICTURES),
         b"P2\n3 2\n255\n0 1 2\n3 4 255\n"]


def sealed(content: bytes, _rng: random.Random) -> bytes:
    """A PNG whose checksums are right again: libpng looks no further where they are wrong."""
    place, done = len(PNG), content[:len(PNG)]
    while content.startswith(PNG) and place + 12 <= len(content):
        end = place + 8 + struct.unpack(">I", content[place:place + 4])[0]
        body = content[place + 4:end]
        done += content[place:place + 4] + body + struct.pack(">I", zlib.crc32(body))
        place = end + 4
    return done + content[place if len(done) > len(PNG) else len(PNG):]


def use_texture(path: Path) -> None:
    """As what is drawn, as a shape cut out of a picture, and as ground."""
    load_image(str(path), 4096)
    warn_if_unreadable(str(path))
    image_part(ImageExtrusion(str(path)))
    heightmap_parts(Heightmap(str(path)))


def read_drawing(path: Path) -> None:
    """As make_track does with a photograph."""
    for colour in (None, "red"):
        with suppress(Fault):
            find_mid_line(read_picture(path), colour)


IMAGES = spoilt(FILES, (*BINARY, *TEXT[:1], sealed, sealed, sealed))


ALIASES = b"a: &a [1]\n" + b"".join(
    b"%c: &%c [%s]\n" % (98 + n, 98 + n, b", ".join([b"*%c" % (97 + n)] * 9)) for n in range(9)
) + b"image: *j\nresolution: *j\norigin: *j\nname: *j\n"

TARGETS = (
    Target("texture", "input.png", IMAGES, use_texture, (SimulationError,)),
    Target("map_image", "input.pgm", IMAGES, read_image, (MapFileError,)),
    Target("drawing", "input.png", IMAGES, read_drawing, (TrackError,)),
    Target("map", "input.yaml", spoilt([*found("**/maps/*.yaml", "**/map/*.yaml"), ALIASES], TEXT),
           read_map, (MapFileError,),
           tuple(found("**/map/*.pgm", "**/maps/*.pgm", largest=1_000_000))),
    Target("track", "input.yaml", spoilt([*found("**/tracks/*.yaml"), ALIASES], TEXT),
           load_centre_line, (TrackError,)),
)
