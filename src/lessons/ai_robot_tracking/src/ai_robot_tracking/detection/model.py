"""A network in an ONNX file: checked when opened, run image by image."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import onnxruntime
from node_basics.settings import SettingsError

from ai_robot_tracking.detection.decoding import (
    PADDING,
    V5,
    Detections,
    decode,
    layout_of,
    letterbox,
    to_picture,
)
from ai_robot_tracking.detection.settings import (
    LARGEST,
    names_of_export,
    read_sidecar,
    size_of_export,
)

USUAL_SIZE = (640, 640)  # px, if neither model nor YAML file gives a size
LARGEST_FILE = 1 << 30  # bytes
CELL = 8  # px: YOLO has at least one candidate per cell of this size; after NMS there are fewer
SILENT = 4  # onnxruntime's log level: its errors are in our own message
TYPES = {"tensor(float)": np.float32, "tensor(float16)": np.float16}
EXPORT = "export it again: yolo export model=best.pt format=onnx"


class ModelError(Exception):
    """The file contains no usable network; one line."""


class Model:
    """A YOLO network; ModelError (one line) if the file does not contain one."""

    def __init__(self, path: Path | str, threads: int = 1):
        self.path = Path(path)
        self._session = _open(self.path, threads)
        try:
            beside = read_sidecar(self.path)
            held = self._session.get_modelmeta().custom_metadata_map
            names = beside.names or names_of_export(held.get("names"))
            size = beside.input_size or size_of_export(held.get("imgsz"))
            self._input, self._type = self._checked_input()
            self._output = self._checked_output()
        except SettingsError as error:
            raise ModelError(str(error) if str(self.path.parent) in str(error)
                             else f"{self.path}: {error}") from None
        except UnicodeDecodeError as error:
            raise ModelError(f"{self.path}: is damaged, or no ONNX file: {error}; "
                             f"{EXPORT}") from None
        self.height, self.width = self._size(size or USUAL_SIZE)
        self.layout, count = self._layout(names)
        self.names = names or [f"class {number}" for number in range(count)]

    def detect(self, rgb: np.ndarray, confidence: float, iou: float) -> Detections:
        """The detections in a (h, w, 3) uint8 RGB image; boxes are in its px and within it.

        Returns what scores above `confidence` (0..1); of overlapping boxes of a class (by more
        than `iou`, 0..1) only the one with the highest score.
        """
        padded, placement = letterbox(rgb, self.width, self.height)
        found = decode(self.run(padded), self.layout, confidence, iou)
        boxes = to_picture(found.boxes, placement, rgb.shape[1], rgb.shape[0])
        inside = (boxes[:, 2:] > boxes[:, :2]).all(axis=1)
        return Detections(boxes[inside], found.scores[inside], found.classes[inside])

    def run(self, padded: np.ndarray) -> np.ndarray:
        """The raw output for a (height, width, 3) uint8 RGB input."""
        blob = cv2.dnn.blobFromImage(padded, 1 / 255).astype(self._type, copy=False)
        return self._session.run([self._output], {self._input: blob})[0]

    def _checked_input(self) -> tuple[str, type]:
        inputs = self._session.get_inputs()
        shape = inputs[0].shape if inputs else []
        if len(inputs) != 1 or len(shape) != 4 or _fixed(shape[1]) not in (3, None) or _fixed(
                shape[0]) not in (1, None):
            said = " and ".join(str(one.shape) for one in inputs) or "nothing"
            raise ModelError(f"{self.path}: takes {said}, not one image (1, 3, height, width); "
                             f"{EXPORT}")
        if inputs[0].type not in TYPES:
            raise ModelError(f"{self.path}: takes {inputs[0].type}, not float; {EXPORT}")
        return inputs[0].name, TYPES[inputs[0].type]

    def _size(self, wanted: tuple[int, int]) -> tuple[int, int]:
        """Height and width: as fixed by the file, else as wanted."""
        fixed = [_fixed(side) for side in self._session.get_inputs()[0].shape[2:]]
        if max(side or 0 for side in fixed) > LARGEST:
            raise ModelError(f"{self.path}: takes {fixed[1]}x{fixed[0]} px, more than {LARGEST}; "
                             f"{EXPORT}")
        return fixed[0] or wanted[0], fixed[1] or wanted[1]

    def _checked_output(self) -> str:
        """The one output of rank 3; older exports also have raw maps of rank 5 as outputs."""
        outputs = self._session.get_outputs()
        tables = [one for one in outputs if len(one.shape) in (0, 3)]
        if len(tables) != 1:
            said = ", ".join(str(one.shape) for one in outputs)
            raise ModelError(f"{self.path}: puts out {said}, not YOLO's one table of boxes; "
                             f"{EXPORT}")
        return tables[0].name

    def _layout(self, names: list[str] | None) -> tuple[str, int]:
        """Determined by a run on an empty image: exports need not state their output's size."""
        empty = np.full((self.height, self.width, 3), PADDING, np.uint8)
        try:
            shape = self.run(empty).shape
        except Exception as error:  # onnxruntime has a class for each reason
            raise ModelError(f"{self.path}: does not run on {self.width}x{self.height} px: "
                             f"{_line(error)}") from None
        try:
            layout, count = layout_of(shape, len(names) if names else None)
            if layout == V5 and count == 1 and shape[1] < self.width * self.height / CELL**2:
                raise ValueError(f"its output has shape {shape}: boxes after NMS")
        except ValueError as error:
            raise ModelError(f"{self.path}: {error}; wanted are YOLO's (1, N, 5 + classes) or "
                             f"(1, 4 + classes, N), without NMS in it") from None
        return layout, count


def _open(path: Path, threads: int) -> onnxruntime.InferenceSession:
    if not path.is_file():  # not pipes and devices, which may never end
        reason = "there is no such file"
        if path.exists():
            reason = "is a folder" if path.is_dir() else "is not a regular file"
        raise ModelError(f"{path}: {reason}; give the path of an .onnx file")
    if path.suffix.lower() in (".pt", ".pth"):
        raise ModelError(f"{path}: is for PyTorch; export it: yolo export model={path.name} "
                         "format=onnx")
    if path.stat().st_size > LARGEST_FILE:
        raise ModelError(f"{path}: is larger than {LARGEST_FILE >> 20} MiB")
    options = onnxruntime.SessionOptions()
    options.log_severity_level = SILENT
    options.intra_op_num_threads, options.inter_op_num_threads = threads, 1
    try:
        return onnxruntime.InferenceSession(path.read_bytes(), options,
                                            providers=["CPUExecutionProvider"])
    except OSError as error:
        raise ModelError(f"{path}: cannot be read: {error.strerror}") from None
    except Exception as error:  # onnxruntime has a class for each reason
        raise ModelError(f"{path}: is damaged, or no ONNX file: {_line(error)}; "
                         f"{EXPORT}") from None


def _fixed(side: int | str | None) -> int | None:
    """A side if the file fixes it; None for a name or nothing, which mean any size."""
    return side if isinstance(side, int) and side > 0 else None


def _line(error: Exception) -> str:
    """onnxruntime's message in one line, without its own file names and line numbers."""
    text = " ".join(str(error).split()) or type(error).__name__
    return text.split(" : ", 2)[-1][:160]
