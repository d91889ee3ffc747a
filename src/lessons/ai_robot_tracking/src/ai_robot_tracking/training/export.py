"""Writes a trained network as an ONNX file in YOLO's v8 layout, (1, 4 + classes, cells).

Weights are stored in half precision; onnxruntime converts them once when it opens the file.
"""

from __future__ import annotations

import io
import warnings
from pathlib import Path

import numpy as np
import onnx
import onnxruntime
import torch
from onnx import numpy_helper
from torch import nn
from torchvision.ops import box_convert

from ai_robot_tracking.training import CLASSES, TrainingError
from ai_robot_tracking.training.dataset import INPUT_HEIGHT, INPUT_WIDTH
from ai_robot_tracking.training.network import Detector

OPSET = 16
WORST = 0.5  # px, or hundredths of a score: largest allowed difference between torch and ONNX


class _Table(nn.Module):
    """Boxes as middle and size, px, and scores: (b, 4 + classes, n)."""

    def __init__(self, network: Detector):
        super().__init__()
        self.network = network

    def forward(self, images: torch.Tensor) -> torch.Tensor:
        boxes, logits = self.network(images)
        rows = torch.cat([box_convert(boxes, "xyxy", "cxcywh"), logits.sigmoid()], 2)
        return rows.transpose(1, 2)


@torch.no_grad()
def export(network: Detector, path: Path, metadata: dict[str, str]) -> None:
    """Write the file with class names and `metadata`, and check it against torch.

    TrainingError if it does not compute the same as the network.
    """
    noise = np.random.default_rng(0).random((1, 3, INPUT_HEIGHT, INPUT_WIDTH), np.float32)
    images, table = torch.from_numpy(noise), _Table(network).eval()
    expected = table(images)[0].numpy()
    file = io.BytesIO()
    with warnings.catch_warnings():  # which the check below makes needless
        warnings.simplefilter("ignore")
        torch.onnx.export(table, images, file, input_names=["images"],
                          output_names=["output0"], opset_version=OPSET, do_constant_folding=False)
    model = onnx.load_from_string(file.getvalue())
    _halve(model.graph)
    onnx.helper.set_model_props(model, {
        "names": repr(dict(enumerate(CLASSES))), "imgsz": repr([INPUT_HEIGHT, INPUT_WIDTH]),
        **metadata})
    onnx.checker.check_model(model)
    path.write_bytes(model.SerializeToString(deterministic=True))
    session = onnxruntime.InferenceSession(str(path), providers=["CPUExecutionProvider"])
    off = np.abs(session.run(None, {"images": noise})[0][0] - expected)
    off[4:] *= 100
    if not off.max() < WORST:
        raise TrainingError(f"{path}: up to {off.max():.3g} px or hundredths off what torch "
                            "computes")


def _halve(graph: onnx.GraphProto) -> None:
    """Store the weights in half precision, each with a node that makes it whole again."""
    for weight in graph.initializer:
        if weight.data_type != onnx.TensorProto.FLOAT:
            continue
        half = numpy_helper.to_array(weight).astype(np.float16)
        node = onnx.helper.make_node("Cast", [f"{weight.name}.half"], [weight.name],
                                     to=onnx.TensorProto.FLOAT)
        graph.node.insert(0, node)
        weight.CopyFrom(numpy_helper.from_array(half, f"{weight.name}.half"))
