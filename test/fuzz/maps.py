"""YAML of maps and tracks."""

from __future__ import annotations

from mutating import TEXT, spoilt
from racecar_description.track.errors import TrackError
from racecar_description.track.track_file import load_centre_line
from target import Target, found

from map_server.errors import MapFileError
from map_server.map_files import read_map

ALIASES = b"a: &a [1]\n" + b"".join(
    b"%c: &%c [%s]\n" % (98 + n, 98 + n, b", ".join([b"*%c" % (97 + n)] * 9)) for n in range(9)
) + b"image: *j\nresolution: *j\norigin: *j\nname: *j\n"

TARGETS = (
    Target("map", "input.yaml", spoilt([*found("**/maps/*.yaml", "**/map/*.yaml"), ALIASES], TEXT),
           read_map, (MapFileError,),
           tuple(found("**/map/*.pgm", "**/maps/*.pgm", largest=1_000_000))),
    Target("track", "input.yaml", spoilt([*found("**/tracks/*.yaml"), ALIASES], TEXT),
           load_centre_line, (TrackError,)),
)
