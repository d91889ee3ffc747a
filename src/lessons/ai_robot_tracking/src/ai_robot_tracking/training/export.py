"""Writes a trained network as an ONNX file in YOLO's v8 layout, (1, 4 + classes, cells).

Weights are stored in half precision; onnxruntime converts them once when it opens the file.
"""

from __future__ import annotations

import copy
import io
import warnings
from pathlib import Path

import numpy as np
import onnx
import onnxruntime
import torch
from torch import nn
from torch.nn.utils.fusion import fuse_conv_bn_eval
from torchvision.ops import Conv2dNormActivation, box_convert

from ai_robot_tracking.training import CLASSES, TrainingError
from ai_robot_tracking.training.dataset import INPUT_HEIGHT, INPUT_WIDTH
from ai_robot_tracking.training.network import Detector

OPSET = 16
WORST = 0.5  # px, or hundredths of a score: largest allowed difference between torch and ONNX


class _Half(nn.Module):
    """A convolution with its numbers in half precision."""

    def __init__(self, conv: nn.Conv2d):
        super().__init__()
        self.conv = conv.half()

    def forward(self, features: torch.Tensor) -> torch.Tensor:
        conv = self.conv
        return nn.functional.conv2d(features, conv.weight.float(), conv.bias.float(), conv.stride,
                                    conv.padding)


class _Table(nn.Module):
    """Boxes as middle and size, px, and scores, of a network whose numbers it halves."""

    def __init__(self, network: Detector):
        super().__init__()
        self.network = copy.deepcopy(network)
        for parent in list(self.network.modules()):
            for name, part in parent.named_children():
                if isinstance(part, Conv2dNormActivation):
                    setattr(parent, name,
                            nn.Sequential(_Half(fuse_conv_bn_eval(part[0], part[1])), part[2]))
                elif isinstance(part, nn.Conv2d):  # a head
                    setattr(parent, name, _Half(part))

    def forward(self, images: torch.Tensor) -> torch.Tensor:
        return _table(*self.network(images))


def _table(boxes: torch.Tensor, logits: torch.Tensor) -> torch.Tensor:
    return torch.cat([box_convert(boxes, "xyxy", "cxcywh"), logits.sigmoid()], 2).transpose(1, 2)


@torch.no_grad()
def export(network: Detector, path: Path, metadata: dict[str, str]) -> None:
    """Write the file with class names and `metadata`, and check it against torch.

    TrainingError if it does not compute the same as the network.
    """
    noise = np.random.default_rng(0).random((1, 3, INPUT_HEIGHT, INPUT_WIDTH), np.float32)
    images = torch.from_numpy(noise)
    expected = _table(*network(images))[0].numpy()
    file = io.BytesIO()
    with warnings.catch_warnings():  # which the check below makes needless
        warnings.simplefilter("ignore")
        torch.onnx.export(_Table(network).eval(), images, file, input_names=["images"],
                          output_names=["output0"], opset_version=OPSET, do_constant_folding=False)
    model = onnx.load_from_string(file.getvalue())
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
