#!/usr/bin/env python3
"""Makes the files in detection_data: stored outputs of both YOLO layouts, and tiny networks.

Needs the package onnx (Debian's python3-onnx); the same files come out each time.
"""

from pathlib import Path

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

FOLDER = Path(__file__).resolve().parent / "detection_data"
CLASSES, CANDIDATES = 3, 120
PICTURE, INPUT = (300, 500), (320, 416)  # height, width, px
CELL, SIDE = 16, 64  # px of the tiny networks, whose input is a square
COLOURS = np.array([[1.0, -1.0, -1.0], [-1.0, -1.0, 1.0]])  # red and blue, as weights of R, G, B


def main() -> None:
    """Write all files."""
    FOLDER.mkdir(exist_ok=True)
    write_outputs()
    names = {"names": "{0: 'red', 1: 'blue'}", "imgsz": f"[{SIDE}, {SIDE}]"}
    free = ["batch", 3, "height", "width"]
    fixed = [1, 3, SIDE, SIDE]
    cells = (SIDE // CELL) ** 2
    write_network("patches_v8", free, tables("v8"), [1, 6, cells], names)
    write_network("patches_v5", fixed, tables("v5"), [1, cells, 7], {})
    write_network("takes_a_table", [1, 10], [node("Relu", ["images"], "output0")], [1, 10], {})
    maps = [node("Relu", ["images"], "output0")]
    write_network("puts_out_maps", fixed, maps, fixed, names)
    odd = [*tables("v8")[:-1], *padded()]
    write_network("odd_table", fixed, odd, [1, 9, cells], names)
    free[1] = "channels"
    write_network("patches_free", free, tables("v8"), [1, 6, cells], names)
    one = {"names": "{0: 'red'}"}
    write_network("after_nms", fixed, chosen(), [1, cells, 6], one)
    write_network("too_large", [1, 3, 100000, 100000], chosen(), [1, cells, 6], one)


def write_outputs() -> None:
    """Clusters of boxes that overlap, with scores round the usual limits, and some nonsense."""
    rng = np.random.default_rng(7)
    middles = rng.uniform((40, 60), (380, 260), (12, 2)).repeat(CANDIDATES // 12, axis=0)
    sizes = rng.uniform(15, 140, (12, 2)).repeat(CANDIDATES // 12, axis=0)
    boxes = np.hstack([middles + rng.normal(0, 9, middles.shape),
                       sizes * rng.uniform(0.7, 1.4, sizes.shape)])
    boxes[::17, 2] = 0.0  # no area
    scores = rng.uniform(0, 1, (CANDIDATES, CLASSES)) ** 2
    there = rng.uniform(0.2, 1, (CANDIDATES, 1))
    v5 = np.hstack([boxes, there, scores])[None].astype(np.float32)
    v8 = np.hstack([boxes, scores * there]).T[None].astype(np.float32)
    v5[0, 5, 6], v8[0, 5, 5] = np.nan, np.nan
    v5[0, 31, 0], v8[0, 1, 31] = np.inf, np.inf
    np.savez_compressed(FOLDER / "outputs.npz", v5=v5, v8=v8, picture=PICTURE, input=INPUT)


def node(kind, inputs, output, **settings):
    """One node of a graph."""
    return helper.make_node(kind, inputs, [output], **settings)


def tables(layout):
    """Each cell of CELL px is a candidate: how red and how blue it is on average."""
    nodes = [
        node("Conv", ["images", "weights", "bias"], "maps", kernel_shape=[CELL] * 2,
             strides=[CELL] * 2),
        node("Reshape", ["maps", "flat"], "logits"),
        node("Sigmoid", ["logits"], "scores"),
    ]
    if layout == "v8":
        return [*nodes, node("Concat", ["boxes", "scores"], "output0", axis=1)]
    return [*nodes, node("Concat", ["boxes", "sure", "scores"], "columns", axis=1),
            node("Transpose", ["columns"], "output0", perm=[0, 2, 1])]


def padded():
    """A table of neither layout for two classes."""
    return [node("Concat", ["boxes", "sure", "boxes"], "output0", axis=1)]


def chosen():
    """What an export with NMS in it puts out: boxes, score, class. It looks at no picture."""
    return [node("Concat", ["boxes", "sure", "sure"], "columns", axis=1),
            node("Transpose", ["columns"], "output0", perm=[0, 2, 1])]


def constants():
    """Weights, and the boxes of the cells: middle x, middle y, width, height."""
    count = SIDE // CELL
    row, column = np.indices((count, count)).reshape(2, -1)
    size = np.full(count * count, CELL)
    boxes = np.stack([(column + 0.5) * CELL, (row + 0.5) * CELL, size, size])[None]
    weights = 12 / CELL**2 * COLOURS[:, :, None, None] * np.ones((1, 1, CELL, CELL))
    found = {"weights": weights, "bias": np.array([-6.0, -6.0]), "boxes": boxes,
             "sure": np.full((1, 1, count * count), 0.9)}
    arrays = {name: value.astype(np.float32) for name, value in found.items()}
    return {**arrays, "flat": np.array([1, 2, count * count])}


def write_network(name, takes, nodes, puts_out, metadata):
    """An ONNX file with the constants that its nodes use."""
    used = {source for one in nodes for source in one.input}
    weights = [numpy_helper.from_array(value, key) for key, value in constants().items()
               if key in used]
    graph = helper.make_graph(
        nodes, name, [helper.make_tensor_value_info("images", TensorProto.FLOAT, takes)],
        [helper.make_tensor_value_info("output0", TensorProto.FLOAT, puts_out)], weights)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)])
    model.ir_version = 8
    helper.set_model_props(model, metadata)
    onnx.checker.check_model(model)
    (FOLDER / f"{name}.onnx").write_bytes(model.SerializeToString(deterministic=True))


if __name__ == "__main__":
    main()
