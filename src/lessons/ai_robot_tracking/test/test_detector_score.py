"""The detector's model as shipped, and mean average precision on known answers."""

import hashlib
import json
import math
from pathlib import Path

import numpy as np
import pytest
from ai_robot_tracking.detection.decoding import Detections
from ai_robot_tracking.detection.model import Model
from ai_robot_tracking.training import CLASSES
from ai_robot_tracking.training.dataset import TEST_FIRST
from ai_robot_tracking.training.drawing import draw_picture
from ai_robot_tracking.training.scoring import (
    Judged,
    Truth,
    average_precision,
    confusion,
    judge,
    mean_average_precision,
    overlaps,
    recall_by_size,
)

from bullet_sim.rendering.renderer import open_renderer

HERE, THERE, AWAY = (0, 0, 10, 10), (20, 0, 40, 10), (60, 60, 80, 80)


def found(*boxes, scores=None, classes=None):
    scores = scores or [0.9 - 0.1 * number for number in range(len(boxes))]
    return Detections(np.array(boxes, float).reshape(-1, 4), np.array(scores, float),
                      np.array(classes or [0] * len(boxes), int))


def truth(*boxes, classes=None, counts=None):
    return Truth(np.array(boxes, float).reshape(-1, 4),
                 np.array(classes or [0] * len(boxes), int),
                 np.array(counts or [True] * len(boxes), bool))


def test_overlap_of_known_boxes():
    known = overlaps(np.array([HERE], float),
                     np.array([HERE, (5, 0, 15, 10), (0, 0, 5, 5), AWAY], float))
    np.testing.assert_allclose(known, [[1, 1 / 3, 0.25, 0]])


@pytest.mark.parametrize("seen, real, expected", [
    (found(HERE, THERE), truth(HERE, THERE), 1.0),
    (found(), truth(HERE), 0.0),
    (found(AWAY), truth(HERE), 0.0),
    (found(HERE), truth(HERE, THERE), 0.5),
    # right, wrong, right: precisions 1 and 2/3 at recalls 1/2 and 1
    (found(HERE, AWAY, THERE), truth(HERE, THERE), (1 + 2 / 3) / 2),
    # wrong first: precision is 1/2 all the way
    (found(AWAY, HERE), truth(HERE), 0.5),
    # the same thing twice is wrong the second time, and costs only what comes after it
    (found(HERE, HERE), truth(HERE), 1.0),
    (found(HERE, HERE, THERE), truth(HERE, THERE), (1 + 2 / 3) / 2),
    # what hardly shows is neither to be found nor wrong to find
    (found(AWAY, HERE), truth(HERE, AWAY, counts=[True, False]), 1.0),
    # an overlap of just a half is right, of less is not
    (found((0, 0, 10, 5)), truth(HERE), 1.0),
    (found((0, 0, 10, 4.9)), truth(HERE), 0.0),
    # another class is wrong
    (found(HERE, classes=[1]), truth(HERE), 0.0),
])
def test_average_precision_of_known_answers(seen, real, expected):
    assert average_precision([seen], [real], 0) == pytest.approx(expected)


def test_pictures_are_taken_together_by_score():
    seen = [found(AWAY, scores=[0.8]), found(HERE, scores=[0.9])]
    assert average_precision(seen, [truth(HERE), truth(HERE)], 0) == pytest.approx(0.5)


def test_the_mean_is_over_classes_that_are_there():
    seen, real = [found(HERE)], [truth(HERE, THERE, classes=[0, 2])]
    assert math.isnan(average_precision(seen, real, 1))
    assert mean_average_precision(seen, real, 3) == pytest.approx(0.5)


def test_as_the_definition_says_on_random_answers():
    rng = np.random.default_rng(3)
    for _ in range(20):
        pictures = [random_answers(rng) for _ in range(6)]
        seen, real = zip(*pictures)
        assert average_precision(seen, real, 0) == pytest.approx(by_definition(seen, real))


def random_answers(rng):
    corner = rng.uniform(0, 80, (5, 2))
    boxes = np.hstack([corner, corner + rng.uniform(8, 30, (5, 2))])
    near = np.vstack([boxes + rng.normal(0, 2.5, boxes.shape), boxes[:2] + 40])
    real = truth(*boxes, counts=(rng.random(5) < 0.8).tolist())
    return found(*near, scores=(rng.permutation(7) / 10 + rng.random(7) / 100).tolist()), real


def by_definition(seen, real):
    """Mean over the things to be found of the best precision at no less recall."""
    answers = []
    for one, there in zip(seen, real):
        free = list(there.counts)
        for index in sorted(range(len(one.scores)), key=lambda i: -one.scores[i]):
            common = overlaps(one.boxes[index:index + 1], there.boxes)[0]
            best = max((i for i in range(len(free)) if free[i]), key=lambda i: common[i],
                       default=None)
            if best is not None and common[best] >= 0.5:
                free[best] = False
                answers.append((one.scores[index], 1))
            elif not any(common[i] >= 0.5 for i in range(len(free)) if not there.counts[i]):
                answers.append((one.scores[index], 0))
    answers.sort(key=lambda answer: -answer[0])
    total = sum(int(there.counts.sum()) for there in real)
    points = []
    for count in range(1, len(answers) + 1):
        right = sum(hit for _, hit in answers[:count])
        points.append((right / total, right / count))
    return sum(max((precision for recall, precision in points if recall >= step / total),
                   default=0.0) for step in range(1, total + 1)) / total


def test_what_is_taken_for_what_and_how_large_it_was():
    judged = Judged([found(HERE, THERE, AWAY, classes=[0, 1, 1])],
                    [truth(HERE, THERE, (0, 50, 10, 100), classes=[0, 0, 1])])
    assert confusion(judged, 2).tolist() == [[1, 1, 0], [0, 0, 1], [0, 1, 0]]
    assert recall_by_size(judged, (5.0, 20.0, 60.0)) == [(2, 1), (1, 0)]


LESSON = Path(__file__).resolve().parent.parent
PICTURES = 40
FLOOR = 0.82  # of a few pictures; the report has the score on many
LARGEST = 2 * 10**6  # bytes


@pytest.fixture(scope="module")
def model():
    return Model(LESSON / "models" / "objects.onnx")


def test_it_is_small_and_knows_its_classes(model):
    assert (LESSON / "models" / "objects.onnx").stat().st_size <= LARGEST
    assert tuple(model.names) == CLASSES and model.layout == "v8"


def test_it_finds_things_in_worlds_that_it_never_saw(model):
    renderer = open_renderer()
    first = TEST_FIRST + 100_000  # of no training, and of no report
    judged = judge(model, [draw_picture(renderer, seed)
                           for seed in range(first, first + PICTURES)])
    renderer.close()
    assert mean_average_precision(judged.found, judged.truth, len(CLASSES)) >= FLOOR


def test_the_report_is_of_this_model():
    digest = hashlib.sha256((LESSON / "models" / "objects.onnx").read_bytes()).hexdigest()
    report = (LESSON / "models" / "objects-training.md").read_text(encoding="utf-8")
    log = json.loads((LESSON / "models" / "objects-training.json").read_text(encoding="utf-8"))
    assert log["model_sha256"] == digest and digest[:16] in report
