"""Images that say a size nobody can unpack, or an odd one: one line, and no crash."""

import struct
import subprocess
import sys
import zlib

import cv2
import numpy as np
import pytest

from bullet_sim.description import Heightmap, ImageExtrusion
from bullet_sim.errors import FormatError
from bullet_sim.meshes.generated import generated_parts
from bullet_sim.meshes.images import (
    check_image,
    image_size,
    load_image,
    read_image,
    shrunk,
    warn_if_unreadable,
)


@pytest.fixture
def said(tmp_path):
    """A PNG or JPEG that says a size, and has no pixels."""
    def write(kind: str, width: int, height: int) -> str:
        path = tmp_path / f"said.{kind}"
        header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
        chunk = struct.pack(">I", 13) + b"IHDR" + header
        png = b"\x89PNG\r\n\x1a\n" + chunk + struct.pack(">I", zlib.crc32(chunk[4:]))
        preview = b"\xff\xe0" + struct.pack(">H", 502) + bytes(500)
        frame = b"\xff\xc0\x00\x0b\x08" + struct.pack(">HH", height % 65536, width % 65536)
        path.write_bytes(png if kind == "png" else b"\xff\xd8" + preview + frame + bytes(20))
        return str(path)
    return write


@pytest.mark.parametrize("kind", ["png", "jpg"])
def test_a_size_beyond_what_memory_holds_is_seen_before_unpacking(said, kind):
    path = said(kind, 30_000, 20_000)
    words = f"{path} cannot be read: 30000 x 20000 pixels, more than 100 million; make it smaller"
    with pytest.raises(FormatError) as caught:
        check_image(path)
    assert str(caught.value) == words
    check_image(said(kind, 10_000, 10_000))
    with pytest.raises(FormatError, match="it has no pixels"):
        check_image(said(kind, 0, 9))


@pytest.mark.parametrize("shape", [
    lambda path: Heightmap(path, (9.0, 9.0, 1.0)),
    lambda path: ImageExtrusion(path, 1.0, 100, 1.0)])
def test_ground_and_blocks_refuse_it(said, shape):
    with pytest.raises(FormatError, match="30000 x 20000 pixels"):
        generated_parts(shape(said("png", 30_000, 20_000)))


@pytest.fixture
def line(tmp_path):
    """Far longer than wide: shrunk to fit, its short side would be no pixel at all."""
    image = np.zeros((2, 100_000), np.uint8)
    image[:, 50_000:] = 255
    cv2.imwrite(str(tmp_path / "line.png"), image)
    return str(tmp_path / "line.png")


def test_a_line_of_pixels_is_ground_blocks_and_a_texture(line):
    ground = generated_parts(Heightmap(line, (9.0, 9.0, 1.0)))
    assert max(part.vertices[:, 2].max() for part in ground) == pytest.approx(1.0)
    blocks = generated_parts(ImageExtrusion(line, 1.0, 100, 1.0))
    assert blocks[0].vertices[:, 0].max() == pytest.approx(0.0, abs=100)
    assert load_image(line, 4096).shape == (1, 4096, 4)
    assert shrunk(np.zeros((1, 1)), 0.5).shape == (1, 1)


def test_ground_between_its_pixels_keeps_sixteen_bits(tmp_path):
    slope = np.linspace(0, 65535, 1001).astype(np.uint16)
    cv2.imwrite(str(tmp_path / "slope.png"), np.tile(slope, (1001, 1)))
    (part,) = generated_parts(Heightmap(str(tmp_path / "slope.png"), (10.0, 10.0, 2.0)))
    x, z = part.vertices[:, 0], part.vertices[:, 2]
    assert z == pytest.approx((x + 5) / 10 * 2, abs=1e-4)


def test_other_kinds_are_no_bombs_either(tmp_path):
    side = 12_000  # px
    pixels = zlib.compress(bytes(side * side), 1)
    values = [(256, side), (257, side), (258, 8), (259, 8), (262, 1), (273, 8), (277, 1),
              (278, side), (279, len(pixels))]  # tags of a grey, deflated TIFF in one strip
    entries = b"".join(struct.pack("<HHII", tag, 4, 1, value) for tag, value in values)
    path = tmp_path / "a.tif"
    path.write_bytes(b"II*\0" + struct.pack("<I", 8 + len(pixels)) + pixels
                     + struct.pack("<H", len(values)) + entries + bytes(4))
    script = (f"from bullet_sim.meshes.images import *\ntry: read_image({str(path)!r}, 1)\n"
              "except FormatError as error: print(error)")
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.stdout == (
        f"{path} cannot be read: it has more than 100 million pixels, or a long side; "
        "make it smaller\n")
    assert not done.stderr


def test_what_opencv_refuses_is_one_line(tmp_path, capfd):
    path = tmp_path / "a.bmp"
    path.write_bytes(b"BM" + bytes(100))
    with pytest.raises(FormatError) as caught:
        read_image(path, cv2.IMREAD_COLOR)
    assert str(caught.value) == (
        f"{path} cannot be read: it is damaged, or no image; give a PNG or JPEG")
    (tmp_path / "a.pgm").write_bytes(b"P5\n100 100\n255\nfew")
    with pytest.raises(FormatError, match="it is damaged, or no image; give a PNG or JPEG"):
        read_image(tmp_path / "a.pgm", cv2.IMREAD_COLOR)
    assert not capfd.readouterr().err


def test_a_texture_that_will_not_be_seen_is_one_warning(tmp_path, caplog):
    path = tmp_path / "a.png"
    path.write_text("no image")
    warn_if_unreadable(str(path))
    assert [record.getMessage() for record in caplog.records] == [
        f"texture {path} cannot be read: it is not an image; give a PNG or JPEG; left out"]
    cv2.imwrite(str(path), np.zeros((4, 4), np.uint8))
    caplog.clear()
    warn_if_unreadable(str(path))
    assert not caplog.records


def test_the_size_is_read_from_the_header():
    picture = cv2.imencode(".jpg", np.zeros((45, 123, 3), np.uint8))[1].tobytes()
    assert image_size(picture) == (123, 45)
    for spoilt in (b"", b"\xff\xd8", b"\xff\xd8\xff\xe0\x00\x00" * 3, picture[:20]):
        assert image_size(spoilt) is None
