"""The detector's settings and class names: from YAML files, the node's parameters, the network."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from pathlib import Path

from node_basics.records import check_keys, read_yaml
from node_basics.settings import SettingsError, count, number


@dataclass(frozen=True)
class Settings:
    """See config/detector_params.yaml."""

    confidence: float = number(0, 1, "detections with lower scores are dropped")
    iou: float = number(0, 1, "of boxes that overlap more, the best score stays")
    max_rate: float = number(0, 1000, "images per second of wall time; 0: no limit")
    threads: int = count(1, 64, "for inference")


DATA_KEYS = ("download", "imgsz", "names", "nc", "path", "test", "train", "val")  # YOLO's own

SMALLEST, LARGEST = 32, 4096  # px, of a side of the input


@dataclass(frozen=True)
class Sidecar:
    """The contents of the YAML file next to a model; None for what it does not have."""

    names: list[str] | None
    input_size: tuple[int, int] | None  # height, width, px


def read_sidecar(model: Path) -> Sidecar:
    """The contents of MODEL.yaml, if it exists; SettingsError names file and key."""
    path = model.with_suffix(".yaml")
    if not path.is_file():
        return Sidecar(None, None)
    table = read_yaml(path, SettingsError)
    if not isinstance(table, dict):
        raise SettingsError(f"{path}: not a table; write for example: names: [person, cone]")
    check_keys(path, dict.fromkeys(DATA_KEYS) | table, DATA_KEYS, SettingsError)
    names = checked_names(table["names"], f"{path}: names") if "names" in table else None
    size = checked_size(table["imgsz"], f"{path}: imgsz") if "imgsz" in table else None
    if names and "nc" in table and table["nc"] != len(names):
        raise SettingsError(f"{path}: nc is {table['nc']}, but there are {len(names)} names")
    return Sidecar(names, size)


def names_of_export(text: str | None) -> list[str] | None:
    """The entry `names` of an ONNX file's metadata, as YOLO's exports write it."""
    if text is None:
        return None
    return checked_names(_literal(text, "its names"), "its names")


def size_of_export(text: str | None) -> tuple[int, int] | None:
    """The entry `imgsz` of an ONNX file's metadata."""
    return None if text is None else checked_size(_literal(text, "its imgsz"), "its imgsz")


def checked_names(value: object, where: str) -> list[str]:
    """Names as a list, from a list or a table with the numbers from 0 on as keys."""
    if isinstance(value, dict):
        if set(value) != set(range(len(value))):
            raise SettingsError(f"{where}: the numbers must be 0 to {len(value) - 1}")
        value = [value[number] for number in range(len(value))]
    if not isinstance(value, list) or not value:
        raise SettingsError(f"{where}: must be a list, for example [person, cone]")
    for name in value:
        if not isinstance(name, str) or not name:
            raise SettingsError(f"{where}: {name!r} is not a name; write it in quotes")
    return value


def checked_size(value: object, where: str) -> tuple[int, int]:
    """Height and width from one number or two."""
    sides = [value, value] if isinstance(value, int) else value
    right = isinstance(sides, list | tuple) and len(sides) == 2 and all(
        isinstance(side, int) and not isinstance(side, bool) and SMALLEST <= side <= LARGEST
        for side in sides)
    if not right:
        raise SettingsError(f"{where}: must be [height, width] in px, each {SMALLEST} to {LARGEST}")
    return sides[0], sides[1]


def _literal(text: str, where: str) -> object:
    try:
        return ast.literal_eval(text)
    except (TypeError, ValueError, SyntaxError, MemoryError, RecursionError):
        raise SettingsError(f"{where}: {text[:60]!r} is neither a list nor a table") from None
