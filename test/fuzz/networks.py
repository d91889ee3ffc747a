"""ONNX files, as the detector opens and asks them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from ai_robot_tracking.detection.model import Model, ModelError
from mutating import BINARY, spoilt
from target import Target, found

PICTURE = np.indices((48, 64, 3)).sum(axis=0).astype(np.uint8)


def detect(path: Path) -> None:
    """Open it, and look at a picture."""
    Model(path).detect(PICTURE, 0.1, 0.5)


TARGETS = (
    Target("onnx", "input.onnx", spoilt(found("**/detection_data/*.onnx"), BINARY), detect,
           (ModelError,)),
)
