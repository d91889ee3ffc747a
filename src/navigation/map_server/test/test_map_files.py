"""Map files: pixels, what is written, each mistake, and names that lead to no plain file."""

import os
import threading
import time
import tracemalloc
from pathlib import Path

import cv2
import numpy as np
import pytest

from map_server import map_files
from map_server.errors import MapFileError, MapImageError, MapMetadataError, MapMissingError
from map_server.map_files import read_map, write_map
from map_server.metadata import read_file
from nav_algorithms.cells import OccupancyGrid

GOOD = {"image": "map.pgm", "resolution": "0.05", "origin": "[-1.0, -2.0, 0.0]", "negate": "0",
        "occupied_thresh": "0.65", "free_thresh": "0.196"}
GREYS = [0, 89, 90, 205, 206, 254, 255]  # 0.65 lies between 89 and 90, 0.196 between 205 and 206


def write(folder, pixels, name="map.pgm", **changes):
    """A map's two files; a key set to None is left out."""
    cv2.imwrite(str(folder / name), np.array(pixels))
    keys = {**GOOD, "image": name, **changes}
    path = folder / "map.yaml"
    path.write_text("".join(f"{k}: {v}\n" for k, v in keys.items() if v is not None))
    return path


def row(folder, pixels, **options):
    """The cells of an image of one row."""
    return read_map(write(folder, pixels, **options))[0].cells[0].tolist()


def greys(values):
    return np.array([values], np.uint8)


@pytest.mark.parametrize("changes, cells", [
    ({}, [100, 100, -1, -1, 0, 0, 0]),
    ({"mode": "trinary"}, [100, 100, -1, -1, 0, 0, 0]),
    ({"negate": 1}, [0, -1, -1, 100, 100, 100, 100]),
    ({"negate": "true"}, [0, -1, -1, 100, 100, 100, 100]),
    # 1 + 98 (p - 0.196) / (0.65 - 0.196), whole numbers below
    ({"mode": "scale"}, [100, 100, 98, 1, 0, 0, 0]),
    ({"mode": "raw"}, [0, 89, 90, 205 - 256, 206 - 256, -2, -1]),
    ({"mode": "raw", "negate": 1}, [-1, 166 - 256, 165 - 256, 50, 49, 1, 0]),
    ({"occupied_thresh": "0.5", "free_thresh": "5e-1"}, [100, 100, 100, 0, 0, 0, 0]),
])
def test_what_grey_becomes(tmp_path, changes, cells):
    assert row(tmp_path, greys(GREYS), **changes) == cells


def test_the_image_s_first_row_has_the_highest_y(tmp_path):
    grid, yaw = read_map(write(tmp_path, np.array([[0, 255, 255], [255, 255, 205]], np.uint8),
                               origin="[-1, 2e-1, 0.5]"))
    assert grid.cells.tolist() == [[0, 0, -1], [100, 0, 0]]
    assert (grid.resolution, grid.origin, yaw) == (0.05, (-1.0, 0.2), 0.5)
    assert grid.cells.flags.c_contiguous


def test_colours_are_averaged(tmp_path):
    bgr = np.array([[[0, 0, 255], [60, 90, 120], [255, 255, 0]]], np.uint8)
    # means 85, 90, 170: occupied, unknown, unknown; scaled: 100, 98, int(1 + 98 * 0.3025)
    assert row(tmp_path, bgr, name="map.png") == [100, -1, -1]
    assert row(tmp_path, bgr, name="map.png", mode="scale") == [100, 98, 30]
    assert row(tmp_path, bgr, name="map.png", mode="raw") == [85, 90, 170 - 256]


@pytest.mark.parametrize("mode", ["trinary", "scale"])
def test_alpha_is_no_colour_and_nothing_is_known_where_it_is_0(tmp_path, mode):
    grey = 205
    bgra = np.array([[[255] * 3 + [0], [0] * 3 + [0], [grey] * 3 + [0], [255] * 4, [0] * 3 + [255],
                      [grey] * 3 + [255]]], np.uint8)
    seen = 1 if mode == "scale" else -1
    assert row(tmp_path, bgra, name="map.png", mode=mode) == [-1, 100, -1, 0, 100, seen]


@pytest.mark.parametrize("content", [
    b"P5\n# comment\n3 1\n255\n\x00\xcd\xfe", b"P5 3 1 15\n\x00\x0c\x0f",
    b"P2\n3 1\n255\n0 205 254", b"P2\n3 1\n15\n0 12 15\n",
    b"P5\n3 1\n65535\n\x00\x00\xcd\xcd\xff\xff"])
def test_graymaps_of_each_kind(tmp_path, content):
    path = write(tmp_path, greys([0]))
    (tmp_path / "map.pgm").write_bytes(content)
    assert read_map(path)[0].cells.tolist() == [[100, -1, 0]]


def test_an_image_of_16_bits_and_one_elsewhere(tmp_path):
    wide = np.array([[0, 205 * 257, 65535]], np.uint16)
    (tmp_path / "pictures").mkdir()
    assert row(tmp_path, wide, name="pictures/map.png") == [100, -1, 0]
    path = write(tmp_path, wide, name="map.png", image=tmp_path / "pictures" / "map.png")
    (tmp_path / "map.png").unlink()
    assert read_map(path)[0].cells.tolist() == [[100, -1, 0]]


@pytest.mark.parametrize("key, value, said", [
    *[(key, None, f"has no {key}; write for example {key}: ") for key in GOOD],
    ("resolution", "0", "resolution is 0, but must be above 0"),
    ("resolution", "-0.05", "resolution is -0.05, but must be above 0"),
    ("resolution", "1e300", "resolution is '1e300', but must be from 1e-06 to 1000 m a pixel"),
    ("resolution", "1.0e-46", "resolution is 1e-46, but must be from 1e-06 to 1000 m a pixel"),
    ("resolution", "5 cm", "resolution is '5 cm', but must be a number"),
    ("resolution", "true", "resolution is True, but must be a number"),
    ("resolution", ".nan", "resolution is nan, but must be a number"),
    ("resolution", "[1]", "resolution is [1], but must be a number"),
    ("origin", "[0, 0]", "origin is [0, 0], but must be [x, y, yaw]"),
    ("origin", "0", "origin is 0, but must be [x, y, yaw]"),
    ("origin", "[a, 0, 0]", "origin is ['a', 0, 0], but must be"),
    ("origin", "[.inf, 0, 0]", "origin is [inf, 0, 0], but must be"),
    ("origin", "[0, -1.0e+300, 0]", "origin is [0, -1e+300, 0], but its x and y must be from"),
    ("negate", "2", "negate is 2, but must be 0 or 1"),
    ("negate", "maybe", "negate is 'maybe', but must be 0 or 1"),
    ("occupied_thresh", "65", "occupied_thresh is 65, but must be between 0 and 1"),
    ("free_thresh", "0.7", "free_thresh is 0.7, but is above occupied_thresh, 0.65"),
    ("mode", "binary", "mode is 'binary', but must be trinary or scale or raw"),
    ("image", "7", "image is 7, but must be text"),
    ("image", "''", "image is '', but must be text"),
])
def test_each_key_that_is_wrong_is_named(tmp_path, key, value, said):
    path = write(tmp_path, greys([0]))
    keys = {**GOOD, key: value}
    path.write_text("".join(f"{k}: {v}\n" for k, v in keys.items() if v is not None))
    with pytest.raises(MapMetadataError) as error:
        read_map(path)
    assert said in str(error.value)
    assert str(path) in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("typed", ["map", "map.yml"])
def test_a_name_without_its_end_is_completed(tmp_path, typed):
    path = write(tmp_path, greys([0]))
    with pytest.raises(MapMissingError, match=rf"/{typed}: there is no such file; write {path}$"):
        read_map(tmp_path / typed)


@pytest.mark.parametrize("name", ["map.pgm", "map.png"])
def test_an_image_is_no_description_of_one(tmp_path, name):
    """A slip when the two files stand beside each other."""
    write(tmp_path, greys([0]), name=name)
    with pytest.raises(MapMetadataError, match=rf"{name}: is an image; write the YAML file "
                                               r"that belongs to it, such as map\.yaml$"):
        read_map(tmp_path / name)


@pytest.mark.parametrize("content", [b"", b"- 1\n", b"a: [\n", b"\t\x00", b"P5\n\xff\xfe",
                                     b"[" * 5000, b"#" * (1 << 21)])
def test_what_is_no_yaml(tmp_path, content):
    path = tmp_path / "map.yaml"
    path.write_bytes(content)
    with pytest.raises(MapMetadataError, match=r"map\.yaml: [^\n]+$"):
        read_map(path)


def test_missing_files_are_named(tmp_path):
    with pytest.raises(MapMissingError, match=r"map\.yaml: there is no such file"):
        read_map(tmp_path / "map.yaml")
    with pytest.raises(MapMissingError, match="cannot be read: Is a directory"):
        read_map(tmp_path)
    path = write(tmp_path, greys([0]))
    (tmp_path / "map.pgm").unlink()
    with pytest.raises(MapImageError, match=r"map\.pgm: there is no such image"):
        read_map(path)


def png_of(width, height):
    """The beginning of a PNG file that says it is of that size."""
    header = b"IHDR" + width.to_bytes(4, "big") + height.to_bytes(4, "big")
    return b"\x89PNG\r\n\x1a\n\0\0\0\r" + header + b"\x08\0\0\0\0" + bytes(100)


@pytest.mark.parametrize("content, said", [
    (b"", "is not an image, or a damaged one"), (b"hello", "is not an image"),
    (b"P5" + b" " * 1000 + b"x", "is not an image"),
    (b"P5\n40 30\n255\n" + bytes(1000), "is not an image, or a damaged one"),
    (b"P5\n20000 20000\n255\n" + bytes(1000), "20000 x 20000 pixels are too many"),
    (b"P4\n20000 20000\n" + bytes(1000), "20000 x 20000 pixels are too many"),
    (png_of(30000, 30000), "30000 x 30000 pixels are too many"),
    (png_of(30, 30), "is not an image")])
def test_damaged_and_enormous_images(tmp_path, capfd, content, said):
    path = write(tmp_path, greys([0]))
    (tmp_path / "map.pgm").write_bytes(content)
    with pytest.raises(MapImageError) as error:
        read_map(path)
    assert said in str(error.value)
    assert str(tmp_path / "map.pgm") in str(error.value)
    assert capfd.readouterr() == ("", "")  # OpenCV would say more, and less


def test_enormous_is_also_what_only_the_decoded_image_says(tmp_path, monkeypatch):
    monkeypatch.setattr(map_files, "LARGEST", 3)
    with pytest.raises(MapImageError, match="2 x 2 pixels are too many"):
        read_map(write(tmp_path, np.zeros((2, 2), np.uint8), name="map.bmp"))


def grid_of(cells, resolution=0.05, origin=(-1.5, 0.1)):
    return OccupancyGrid(np.array(cells, np.int8), resolution, origin)


def test_the_written_pixels(tmp_path):
    pgm, _ = write_map(tmp_path / "map", grid_of([[-1, 0, 25, 26], [64, 65, 100, 101]]))
    assert cv2.imread(str(pgm), cv2.IMREAD_UNCHANGED).tolist() == [[205, 0, 0, 0],
                                                                  [205, 254, 254, 205]]
    write_map(tmp_path / "map", grid_of([[-1, 0, 10, 11, 49, 50]]), occupied=50, free=10)
    assert cv2.imread(str(pgm), cv2.IMREAD_UNCHANGED).tolist() == [[205, 254, 254, 205, 205, 0]]


def test_the_written_description(tmp_path):
    _, description = write_map(tmp_path / "house", grid_of([[0]]))
    assert description.read_text() == (
        "image: house.pgm\nresolution: 0.05\norigin: [-1.5, 0.1, 0.0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["house.pgm", "house.yaml"]


@pytest.mark.parametrize("name", ["map", "map.v2", "a b", "it's: \"1\"", "-f", "地图"])
def test_round_trip_is_exact(tmp_path, name):
    cells = np.random.default_rng(1).choice([-1, 0, 100], (31, 17))
    grid = grid_of(cells, float(np.float32(1 / 30)), (-1 / 3, 1e-7))
    write_map(tmp_path / name, grid, yaw=-2 / 3)
    again, yaw = read_map(tmp_path / f"{name}.yaml")
    assert np.array_equal(again.cells, grid.cells)
    assert np.float32(again.resolution) == np.float32(grid.resolution)
    assert (again.origin, yaw) == (grid.origin, -2 / 3)


def test_where_nothing_can_be_written(tmp_path):
    (tmp_path / "taken.pgm").mkdir()
    for name, said in ((tmp_path / "no" / "map", "there is no such folder; make it first: mkdir"),
                       (tmp_path / "taken", "is a folder"), (tmp_path / "a\nb", "is not a name")):
        with pytest.raises(MapFileError, match=said):
            write_map(name, grid_of([[0]]))


@pytest.mark.parametrize("typed, written", [
    ("~/maps/home", "~ is not expanded here: write /people/ann/maps/home"),
    ("~", "~ is not expanded here: write /people/ann"),
    ("$HOME/m", r"$HOME is not expanded here: write /people/ann/m"),
    ("${HOME}/m", r"${HOME} is not expanded here: write /people/ann/m"),
    ("$NO_SUCH/m", "$NO_SUCH is not expanded here: write the path itself"),
    ("$(find my_car)/maps/m", '$(find my_car) is expanded in launch files only: write '
                              '"$(rospack find my_car)/maps/m"'),
    ("$(env HOME)/m", "$(env HOME) is not expanded here: write the path itself")])
def test_a_name_that_no_shell_has_expanded(monkeypatch, typed, written):
    monkeypatch.setenv("HOME", "/people/ann")
    for attempt in (map_files.check_target, read_map):
        with pytest.raises(MapFileError) as caught:
            attempt(Path(typed))
        assert str(caught.value) == written


def test_a_full_disk_leaves_what_was_there(tmp_path, monkeypatch):
    write_map(tmp_path / "map", grid_of([[0]]))
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    def full(_file):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(map_files.os, "fsync", full)
    with pytest.raises(MapFileError, match=r"map\.pgm: cannot be written: No space left"):
        write_map(tmp_path / "map", grid_of([[100]]))
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


@pytest.mark.parametrize("text", [
    "a: !!int ''", "a: !!bool x", "a: &a {x: 1}\n" + "".join(
        f"{new}: &{new} {{<<: [{', '.join([f'*{old}'] * 9)}]}}\n"
        for old, new in zip("abcdefghi", "bcdefghij"))])
def test_what_the_yaml_parser_gives_up_on_is_no_yaml(tmp_path, text):
    (tmp_path / "map.yaml").write_text(text)
    with pytest.raises(MapMetadataError, match=r"map\.yaml: is not valid YAML: [^\n]{1,300}$"):
        read_map(tmp_path / "map.yaml")


def test_a_number_of_thousands_of_digits_is_not_spelt_out(tmp_path):
    with pytest.raises(MapMetadataError, match="a number of more than 1000 characters"):
        read_map(write(tmp_path, greys(GREYS), resolution="0x" + "f" * 5000))


def test_a_list_of_aliases_is_named_and_not_spelt_out(tmp_path):
    bomb = ", ".join(f"&b{n} [{', '.join([f'*b{n - 1}' if n else 'a'] * 10)}]" for n in range(9))
    began = time.process_time()
    with pytest.raises(MapMetadataError, match=r"resolution is .*, but must be a number"):
        read_map(write(tmp_path, greys(GREYS), resolution=f"[{bomb}]"))
    assert time.process_time() - began < 2


def test_a_name_of_thousands_of_letters_is_not_spelt_out(tmp_path):
    with pytest.raises(MapMetadataError, match="has more than 1024 characters") as caught:
        read_map(write(tmp_path, greys(GREYS), image="x" * 5000))
    assert len(str(caught.value)) < 500


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
    monkeypatch.setattr(map_files, "LARGEST_FILE", 1 << 20)
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
