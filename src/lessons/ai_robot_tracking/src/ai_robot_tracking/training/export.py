"""Writes a trained network as an ONNX file in YOLO's v8 layout, (1, 4 + classes, cells).

Weights are stored in half precision; onnxruntime converts them once when it opens the file.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import onnx
import torch
from onnx import TensorProto, helper, numpy_helper

from ai_robot_tracking.training import CLASSES
from ai_robot_tracking.training.dataset import INPUT_HEIGHT, INPUT_WIDTH
from ai_robot_tracking.training.layers import (
    ADD,
    CONCAT,
    CONV,
    DOUBLE,
    HEAD,
    POOL,
    POOL_SIDE,
    STRIDES,
)
from ai_robot_tracking.training.network import Detector, cell_centres

OPSET, IR_VERSION = 17, 8
WORST = 0.5  # px, or hundredths of a score: largest allowed difference between torch and ONNX


class ExportError(Exception):
    """The file does not compute the same as the network."""


def export(network: Detector, path: Path, metadata: dict[str, str]) -> None:
    """Write the file with class names and `metadata`, and check it against torch."""
    graph = _Graph()
    for layer in network.layers:
        graph.layer(layer, network)
    graph.tables()
    model = helper.make_model(graph.finished(), opset_imports=[helper.make_opsetid("", OPSET)],
                              producer_name="train_detector.py")
    model.ir_version = IR_VERSION
    helper.set_model_props(model, {
        "names": repr(dict(enumerate(CLASSES))), "imgsz": repr([INPUT_HEIGHT, INPUT_WIDTH]),
        **metadata})
    onnx.checker.check_model(model)
    path.write_bytes(model.SerializeToString(deterministic=True))
    _compare(network, path)


class _Graph:
    """Collects nodes and weights."""

    def __init__(self) -> None:
        self._nodes, self._weights = [], []

    def layer(self, layer, network: Detector) -> None:
        """The nodes of one layer; the output has the layer's name."""
        if layer.kind in (CONV, HEAD):
            self._convolution(layer, *network.convolution(layer))
        elif layer.kind == ADD:
            self._node("Add", layer.inputs, layer.name)
        elif layer.kind == CONCAT:
            self._node("Concat", layer.inputs, layer.name, axis=1)
        elif layer.kind == DOUBLE:
            scales = self._constant(f"{layer.name}.scales", np.array([1, 1, 2, 2], np.float32))
            self._node("Resize", (*layer.inputs, "", scales), layer.name, mode="nearest",
                       coordinate_transformation_mode="asymmetric", nearest_mode="floor")
        elif layer.kind == POOL:
            self._node("MaxPool", layer.inputs, layer.name, kernel_shape=[POOL_SIDE] * 2,
                       strides=[1, 1], pads=[POOL_SIDE // 2] * 4)

    def tables(self) -> None:
        """Heads to one table: box centres and sizes in px of the input, and scores."""
        boxes, scores = [], []
        for stride in STRIDES:
            rows, columns = INPUT_HEIGHT // stride, INPUT_WIDTH // stride
            for head, count, found in (("box", 4, boxes), ("class", len(CLASSES), scores)):
                shape = self._constant(f"{head}{stride}.shape",
                                       np.array([1, count, rows * columns], np.int64))
                flat = f"{head}{stride}.flat"
                self._node("Reshape", (f"{head}{stride}", shape), flat)
                found.append(flat)
        cells = [(INPUT_HEIGHT // s, INPUT_WIDTH // s, s) for s in STRIDES]
        centres = np.concatenate([cell_centres(*cell).numpy() for cell in cells])
        strides = np.concatenate([np.full(rows * columns, s) for rows, columns, s in cells])
        self._constant("centres", centres.T[None].astype(np.float32))
        self._constant("strides", strides[None, None].astype(np.float32))
        self._constant("two", np.array([2], np.float32))
        self._node("Concat", boxes, "raw", axis=2)
        self._node("Softplus", ("raw",), "soft")
        self._node("Mul", ("soft", "strides"), "reach")
        self._node("Split", ("reach",), "before", "after", axis=1)
        self._node("Sub", ("after", "before"), "shift")
        self._node("Div", ("shift", "two"), "half")
        self._node("Add", ("centres", "half"), "middles")
        self._node("Add", ("before", "after"), "sizes")
        self._node("Concat", scores, "logits", axis=2)
        self._node("Sigmoid", ("logits",), "scores")
        self._node("Concat", ("middles", "sizes", "scores"), "output0", axis=1)

    def finished(self) -> onnx.GraphProto:
        count = sum((INPUT_HEIGHT // s) * (INPUT_WIDTH // s) for s in STRIDES)
        image = helper.make_tensor_value_info("images", TensorProto.FLOAT,
                                              [1, 3, INPUT_HEIGHT, INPUT_WIDTH])
        table = helper.make_tensor_value_info("output0", TensorProto.FLOAT,
                                              [1, 4 + len(CLASSES), count])
        return helper.make_graph(self._nodes, "detector", [image], [table], self._weights)

    def _convolution(self, layer, weight: torch.Tensor, bias: torch.Tensor) -> None:
        names = [self._half(f"{layer.name}.{what}", value.numpy())
                 for what, value in (("weight", weight), ("bias", bias))]
        source = "images" if layer.inputs[0] == "image" else layer.inputs[0]
        plain = layer.name if layer.kind == HEAD else f"{layer.name}.linear"
        self._node("Conv", (source, *names), plain, kernel_shape=[layer.side] * 2,
                   strides=[layer.stride] * 2, pads=[layer.side // 2] * 4)
        if layer.kind == CONV:
            self._node("Relu", (plain,), layer.name)

    def _half(self, name: str, value: np.ndarray) -> str:
        half = self._constant(f"{name}.half", value.astype(np.float16))
        self._node("Cast", (half,), name, to=TensorProto.FLOAT)
        return name

    def _constant(self, name: str, value: np.ndarray) -> str:
        self._weights.append(numpy_helper.from_array(np.ascontiguousarray(value), name))
        return name

    def _node(self, kind: str, inputs, *outputs: str, **settings) -> None:
        self._nodes.append(helper.make_node(kind, list(inputs), list(outputs), outputs[0],
                                            **settings))


def _compare(network: Detector, path: Path) -> None:
    """Compare boxes and scores of torch and of the file on an image of noise."""
    import onnxruntime

    noise = np.random.default_rng(0).random((1, 3, INPUT_HEIGHT, INPUT_WIDTH), np.float32)
    with torch.no_grad():
        boxes, logits = network(torch.from_numpy(noise))
    middles, sizes = (boxes[..., :2] + boxes[..., 2:]) / 2, boxes[..., 2:] - boxes[..., :2]
    expected = torch.cat([middles, sizes, 100 * logits.sigmoid()], 2)[0].T.numpy()
    session = onnxruntime.InferenceSession(str(path), providers=["CPUExecutionProvider"])
    got = session.run(None, {"images": noise})[0][0]
    got[4:] *= 100
    worst = float(np.abs(got - expected).max())
    if not worst < WORST:
        raise ExportError(f"{path}: up to {worst:.3g} px or hundredths off what torch computes")
