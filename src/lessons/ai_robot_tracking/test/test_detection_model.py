"""Networks in files: both layouts find what is there; what is no network is one clear line."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from ai_robot_tracking.detection.messages import PictureError, annotated, rgb_of
from ai_robot_tracking.detection.model import Model, ModelError
from ai_robot_tracking.detection.newest import Newest
from ai_robot_tracking.detection.settings import Settings, names_of_export
from node_basics.settings import SettingsError, load_settings
from sensor_msgs.msg import Image

DATA = Path(__file__).resolve().parent / "detection_data"
CONFIG = Path(__file__).resolve().parent.parent / "config" / "detector_params.yaml"
GIVEN = {"confidence": 0.25, "iou": 0.45, "max_rate": 0, "threads": 1}


def picture_with_patches():
    """256 x 192: a cell of the tiny networks is 64 px wide, and 32 px are grey above and below."""
    picture = np.full((192, 256, 3), 90, np.uint8)
    picture[32:96, 64:128] = (255, 0, 0)
    picture[96:160, 192:256] = (0, 0, 255)
    return picture


@pytest.mark.parametrize("layout", ["v5", "v8"])
def test_both_layouts_find_the_patches(layout, tmp_path):
    path = Path(shutil.copy(DATA / f"patches_{layout}.onnx", tmp_path))
    if layout == "v5":  # it holds no names
        path.with_suffix(".yaml").write_text("names: {0: red, 1: blue}\n")
    model = Model(path)
    found = model.detect(picture_with_patches(), 0.25, 0.45)
    assert (model.layout, model.width, model.height) == (layout, 64, 64)
    assert [model.names[label] for label in found.classes] == ["red", "blue"]
    np.testing.assert_allclose(found.boxes, [[64, 32, 128, 96], [192, 96, 256, 160]], atol=0.01)
    assert (found.scores > 0.8).all()


def test_without_names_classes_have_numbers():
    assert Model(DATA / "patches_v5.onnx").names == ["class 0", "class 1"]


def test_all_sides_of_the_input_may_be_free():
    assert Model(DATA / "patches_free.onnx").names == ["red", "blue"]


@pytest.mark.parametrize("text", ["{[]: 1}", "{{}}", "[" * 5000, "__import__('os')", "{0: 'a'",
                                  "\0", "7"])
def test_names_in_an_export_are_read_as_data_alone(text):
    with pytest.raises(SettingsError, match=r"^its names: "):
        names_of_export(text)


def test_a_yaml_beside_the_model_wins(tmp_path):
    path = Path(shutil.copy(DATA / "patches_v8.onnx", tmp_path))
    path.with_suffix(".yaml").write_text("nc: 2\nnames: [rot, blau]\n")
    assert Model(path).names == ["rot", "blau"]


@pytest.mark.parametrize("text, said", [
    ("name: [a, b]", "unknown key 'name'"),
    ("names: [a, b, c]", "its names are 3"),
    ("names: {1: a, 2: b}", "the numbers must be 0 to 1"),
    ("names: [a, 7]", "7 is not a name"),
    ("names: [no, yes]", "False is not a name; write it in quotes"),
    ("names: []", "must be a list"),
    ("nc: 3\nnames: [a, b]", "nc is 3, but there are 2 names"),
    ("imgsz: [0, 9]", "imgsz: must be [height, width]"),
    ("names: [a, b", "not valid YAML"),
    ("names: 2026-13-45", "not valid YAML: month must be in 1..12"),
    ("names: !!timestamp x", "not valid YAML"),
    ("[" * 1000, "not valid YAML"),
    ("7", "not a table"),
])
def test_a_wrong_yaml_is_named(text, said, tmp_path):
    path = Path(shutil.copy(DATA / "patches_v8.onnx", tmp_path))
    path.with_suffix(".yaml").write_text(text)
    assert said in complaint(path)


@pytest.mark.parametrize("name, said", [
    ("takes_a_table", "takes [1, 10], not one image (1, 3, height, width)"),
    ("puts_out_maps", "puts out [1, 3, 64, 64], not YOLO's one table"),
    ("odd_table", "its output has shape (1, 9, 16), and its names are 2"),
    ("after_nms", "its output has shape (1, 16, 6): boxes after NMS"),
    ("too_large", "takes 100000x100000 px, more than 4096"),
])
def test_a_network_of_another_kind_is_refused(name, said):
    assert said in complaint(DATA / f"{name}.onnx")


@pytest.mark.parametrize("content", [b"", b"no network", bytes(range(256)) * 40, "half"])
def test_a_damaged_file_is_one_line(content, tmp_path):
    path = tmp_path / "spoilt.onnx"
    whole = (DATA / "patches_v8.onnx").read_bytes()
    path.write_bytes(whole[:len(whole) // 2] if content == "half" else content)
    said = complaint(path)
    assert "is damaged, or no ONNX file" in said and "yolo export" in said


def test_every_cut_of_a_file_is_refused(tmp_path):
    whole = (DATA / "patches_v8.onnx").read_bytes()
    path = tmp_path / "cut.onnx"
    for length in range(0, len(whole) - 200, 331):  # at the end is what a reader may do without
        path.write_bytes(whole[:length])
        assert str(path) in complaint(path)


@pytest.mark.parametrize("name", [b"images", b"output0", b"names"])
def test_a_name_that_is_no_text_is_one_line(name, tmp_path):
    path = tmp_path / "spoilt.onnx"
    whole = (DATA / "patches_v8.onnx").read_bytes()
    assert name in whole
    path.write_bytes(whole.replace(name, b"\xc3" * len(name)))
    assert "is damaged, or no ONNX file" in complaint(path)


def test_missing_files_folders_and_torch_files_are_told(tmp_path):
    assert "there is no such file" in complaint(tmp_path / "none.onnx")
    assert "is a folder" in complaint(tmp_path)
    os.mkfifo(tmp_path / "pipe.onnx")  # to read it would wait for ever
    assert "is not a regular file" in complaint(tmp_path / "pipe.onnx")
    (tmp_path / "best.pt").write_bytes(b"PK")
    assert "yolo export model=best.pt format=onnx" in complaint(tmp_path / "best.pt")


def complaint(path):
    with pytest.raises(ModelError) as caught:
        Model(path)
    text = str(caught.value)
    assert "\n" not in text and len(text) < 500
    return text


def image(encoding="rgb8", depth=3, **changes):
    fields = {"height": 4, "width": 5, "encoding": encoding, "step": 5 * depth,
              "data": bytes(range(20 * depth))}
    return Image(**{**fields, **changes})


def test_encodings_give_the_same_colours():
    first = [(0, 1, 2), (2, 1, 0), (0, 1, 2), (2, 1, 0), (0, 0, 0)]
    kinds = [("rgb8", 3), ("bgr8", 3), ("rgba8", 4), ("bgra8", 4), ("mono8", 1)]
    for (encoding, depth), colour in zip(kinds, first):
        rgb = rgb_of(image(encoding, depth))
        assert rgb.shape == (4, 5, 3) and tuple(rgb[0, 0]) == colour
    padded = image(step=20, data=bytes(80))
    assert rgb_of(padded).shape == (4, 5, 3)


@pytest.mark.parametrize("changes, said", [
    ({"encoding": "yuv422"}, "encoding 'yuv422' is not among"),
    ({"encoding": "bgra8"}, "need 20 bytes a row, but step is 15"),
    ({"data": b"123"}, "there are 3 bytes in all"),
    ({"width": 0}, "an image of 0x4 px"),
])
def test_a_wrong_picture_is_said(changes, said):
    with pytest.raises(PictureError, match=said):
        rgb_of(image(**changes))


def test_settings_come_from_the_file_and_the_node_wins():
    settings = load_settings(Settings, CONFIG, given={"confidence": 0.5})
    assert (settings.confidence, settings.iou, settings.threads) == (0.5, 0.45, 1)


@pytest.mark.parametrize("change, said", [
    ("confidance: 0.3", "unknown key 'confidance'"),
    ("confidence: 1.5", "'confidence' must be a number from 0 to 1, not 1.5"),
    ("iou: high", "'iou' must be a number from 0 to 1, not 'high'"),
    ("threads: 1" + "0" * 400, "'threads' must be a whole number from 1 to 64"),
    ("iou: 2026-13-45", "not valid YAML: month must be in 1..12"),
    ("threads: 1.5", "'threads' must be a whole number from 1 to 64"),
    ("max_rate: .nan", "'max_rate' must be a number from 0 to 1000, not nan"),
])
def test_wrong_settings_name_file_and_key(change, said, tmp_path):
    path = tmp_path / "detector.yaml"
    key = change.split(":")[0]
    lines = [f"{name}: {value}" for name, value in GIVEN.items() if name != key]
    path.write_text("\n".join([*lines, change]))
    with pytest.raises(SettingsError, match=said) as caught:
        load_settings(Settings, path)
    assert str(path) in str(caught.value)
    path.write_text("iou: 0.4")
    with pytest.raises(SettingsError, match="missing key 'confidence'"):
        load_settings(Settings, path)


def test_only_the_newest_picture_is_taken_and_the_others_are_counted():
    box = Newest()
    for number in range(5):
        box.put(number)
    assert box.take(0.0) == 4 and box.take(0.0) is None
    assert box.counts() == (1, 4) and box.counts() == (0, 0)


def test_boxes_at_the_edges_are_drawn():
    model = Model(DATA / "patches_v8.onnx")
    picture = picture_with_patches()
    picture[32:96, 192:] = (255, 0, 0)
    before = picture.copy()
    drawn = annotated(picture, model.detect(picture, 0.25, 0.45), model.names)
    assert (picture == before).all() and drawn.shape == picture.shape
    assert (drawn[33:95, 192] != before[33:95, 192]).any()
