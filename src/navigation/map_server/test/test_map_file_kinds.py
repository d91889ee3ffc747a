"""Names that lead to no plain file, or to one without end: one line, and nothing is waited for."""

import os
import threading
import tracemalloc

import pytest

from map_server import image
from map_server.errors import MapImageError, MapMissingError
from map_server.files import read_file
from map_server.map_files import read_map

NO_FILE = "cannot be read: it is a pipe or device, not a file"


@pytest.fixture(params=["pipe", "device"])
def endless(request, tmp_path):
    """A path; of all devices the one that a wrong reader, too, comes to the end of."""
    if request.param == "device":
        yield "/dev/null"
        return
    path = tmp_path / "pipe"
    os.mkfifo(path)
    rescue = threading.Timer(2.0, lambda: os.close(os.open(path, os.O_RDWR)))
    rescue.start()  # of a wrong reader, who would wait for ever
    yield path
    rescue.cancel()


def description(folder, name):
    path = folder / "map.yaml"
    path.write_text(f"image: {name}\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
                    "occupied_thresh: 0.65\nfree_thresh: 0.196\n")
    return path


def test_an_image_that_is_no_plain_file(tmp_path, endless):
    with pytest.raises(MapImageError, match=f"^{endless}: {NO_FILE}$"):
        read_map(description(tmp_path, endless))


def test_a_description_that_is_no_plain_file(endless):
    with pytest.raises(MapMissingError, match=f"^{endless}: {NO_FILE}$"):
        read_map(endless)


def test_a_file_too_large_for_an_image(tmp_path, monkeypatch):
    monkeypatch.setattr(image, "LARGEST_FILE", 1 << 20)
    with open(tmp_path / "map.pgm", "wb") as file:
        file.truncate(1 << 28)  # a hole: takes no room
    with pytest.raises(MapImageError, match="more than 1 MiB; save it as PNG"):
        read_map(description(tmp_path, "map.pgm"))


def test_a_name_that_no_file_can_have(tmp_path):
    with pytest.raises(MapMissingError, match="cannot be read: its name has a zero byte in it"):
        read_map("a\0b")
    with pytest.raises(MapMissingError, match="cannot be read: File name too long"):
        read_map(tmp_path / ("x" * 300))
    with pytest.raises(MapMissingError, match="there is no such file"):
        read_map(tmp_path / ("x" * 252))  # with .yaml behind it, it is too long


def test_a_small_file_takes_little_memory(tmp_path):
    """Python makes room for all that is asked for before it reads."""
    path = tmp_path / "small.pgm"
    path.write_bytes(b"P5 1 1 255 0")
    tracemalloc.start()
    try:
        assert read_file(path, 2**30) == b"P5 1 1 255 0"
        assert tracemalloc.get_traced_memory()[1] < 10**6
    finally:
        tracemalloc.stop()
