"""The shipped model on worlds that it never saw: a few fresh ones each time, of fixed seeds."""

import hashlib
import json
from pathlib import Path

import pytest
from ai_robot_tracking.detection.model import Model
from ai_robot_tracking.training import CLASSES
from ai_robot_tracking.training.dataset import TEST_FIRST
from ai_robot_tracking.training.drawing import draw_picture
from ai_robot_tracking.training.scoring import judge, mean_average_precision

from bullet_sim.rendering.renderer import open_renderer

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
