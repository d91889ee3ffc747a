"""Boxes from stored outputs of both layouts are those of the reference, to a hundredth of a px."""

from pathlib import Path

import numpy as np
import pytest
from ai_robot_tracking.detection.decoding import (
    PADDING,
    V5,
    V8,
    decode,
    layout_of,
    letterbox,
    to_picture,
)
from reference_decoding import reference_boxes

HERE = Path(__file__).resolve().parent


@pytest.fixture(scope="module")
def stored():
    with np.load(HERE / "detection_data" / "outputs.npz") as file:
        return dict(file)


@pytest.mark.parametrize("layout", [V5, V8])
@pytest.mark.parametrize("confidence, iou", [(0.25, 0.45), (0.01, 0.7), (0.6, 0.2), (0.0, 0.0)])
def test_boxes_are_those_of_the_reference(stored, layout, confidence, iou):
    picture, network = tuple(stored["picture"]), tuple(stored["input"])
    expected = reference_boxes(stored[layout], layout, confidence, iou, picture, network)
    assert len(expected) > 5
    empty = np.zeros((*picture, 3), np.uint8)
    _, placement = letterbox(empty, network[1], network[0])
    found = decode(stored[layout], layout, confidence, iou)
    boxes = to_picture(found.boxes, placement, picture[1], picture[0])
    assert len(found) == len(expected)
    assert found.classes.tolist() == [one[5] for one in expected]
    np.testing.assert_allclose(found.scores, [one[4] for one in expected], atol=1e-6)
    np.testing.assert_allclose(boxes, [one[:4] for one in expected], atol=0.01)


def test_both_layouts_of_one_network_say_the_same(stored):
    v5, v8 = decode(stored[V5], V5, 0.3, 0.5), decode(stored[V8], V8, 0.3, 0.5)
    # One is spoilt at candidate 5 and 31 as the other, so the same is left out.
    np.testing.assert_allclose(v5.boxes, v8.boxes, atol=1e-4)
    assert v5.classes.tolist() == v8.classes.tolist()


def test_nothing_above_the_confidence_is_nothing_found(stored):
    for layout in (V5, V8):
        found = decode(stored[layout], layout, 1.0, 0.5)
        assert len(found) == 0 and found.boxes.shape == (0, 4)


def test_what_is_not_finite_is_left_out_without_a_word(recwarn):
    table = np.array([[[50, 50, 20, 20, np.inf, 0.0], [50, 50, 20, 20, 3e38, 3e38],
                       [np.nan, 50, 20, 20, 0.9, 0.9], [90, 50, 20, 20, 0.9, 0.9]]], np.float32)
    found = decode(table, V5, 0.25, 0.5)
    assert found.boxes.tolist() == [[80, 40, 100, 60]] and not recwarn.list


@pytest.mark.parametrize("shape, classes, expected", [
    ((1, 25200, 85), 80, (V5, 80)),
    ((1, 84, 8400), 80, (V8, 80)),
    ((1, 84, 8400), None, (V8, 80)),
    ((1, 25200, 6), None, (V5, 1)),
    ((1, 7, 12), 3, (V8, 3)),  # few candidates: the names decide
    ((1, 12, 7), 2, (V5, 2)),
])
def test_layout_is_told_from_the_shape(shape, classes, expected):
    assert layout_of(shape, classes) == expected


@pytest.mark.parametrize("shape, classes", [
    ((1, 300, 6), 80), ((8400, 84), 80), ((2, 84, 8400), 80), ((1, 4, 100), None),
])
def test_other_shapes_are_refused(shape, classes):
    with pytest.raises(ValueError, match=r"its output has shape \("):
        layout_of(shape, classes)


@pytest.mark.parametrize("size", [(480, 640), (360, 640), (1080, 1920), (37, 1000), (900, 30),
                                  (256, 320), (1, 1)])
def test_a_letterboxed_point_comes_back(size):
    height, width = size
    picture = np.full((height, width, 3), 200, np.uint8)
    padded, placement = letterbox(picture, 320, 256)
    assert padded.shape == (256, 320, 3)
    inside = (padded == 200).all(axis=2)
    assert inside[128, 160]
    assert (padded[~inside] == PADDING).all()
    rows, columns = np.flatnonzero(inside.any(axis=1)), np.flatnonzero(inside.any(axis=0))
    edges = np.array([[columns[0], rows[0], columns[-1] + 1, rows[-1] + 1]], float)
    back = to_picture(edges, placement, width, height)
    np.testing.assert_allclose(back, [[0, 0, width, height]], atol=1 / placement.scale)
    # Grey is as wide on the left as on the right, to a pixel.
    assert abs(columns[0] - (319 - columns[-1])) <= 1 and abs(rows[0] - (255 - rows[-1])) <= 1
