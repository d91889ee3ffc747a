"""One training, from images to files: the model, its class names, and a log as JSON."""

from __future__ import annotations

import hashlib
import json
import pickle
import platform
import time
from pathlib import Path

import numpy as np
import torch

from ai_robot_tracking.training.classes import CLASSES
from ai_robot_tracking.training.dataset import INPUT_HEIGHT, INPUT_WIDTH, PictureSet, read_sets
from ai_robot_tracking.training.errors import TrainingError
from ai_robot_tracking.training.export import ExportError, export
from ai_robot_tracking.training.network import Detector
from ai_robot_tracking.training.training import Plan, Progress, train


def run_training(
    folder: Path, model: Path, pictures: int, plan: Plan, start: Path | None = None
) -> None:
    """Write MODEL.onnx, .yaml, .pt and -training.json; TrainingError (one line) if it fails.

    `start` is the .pt file of an earlier training to continue from.
    """
    if model.suffix != ".onnx":
        raise TrainingError(f"{model}: the model's name must end with .onnx")
    drawn = read_drawn(folder, pictures)
    network, before = read_start(start) if start else (None, [])
    curve: list[Progress] = []
    began = time.process_time()
    network = train(drawn, plan, lambda point, _: _say(point, plan, curve), network)
    torch.save(network.state_dict(), model.with_suffix(".pt"))
    done = training_round(network, drawn, plan, curve, time.process_time() - began)
    write_files(network, model, [*before, done])


def read_drawn(folder: Path, pictures: int) -> PictureSet:
    """This many training images; TrainingError if there are fewer."""
    try:
        drawn = read_sets(folder, "train", pictures)
    except FileNotFoundError as error:
        raise TrainingError(str(error)) from error
    if len(drawn) < pictures:
        raise TrainingError(f"{folder}: {len(drawn)} images, not {pictures}; draw them first")
    return drawn


def read_start(path: Path) -> tuple[Detector, list[dict]]:
    """The network of an earlier training and its log."""
    log = path.with_name(f"{path.stem}-training.json")
    network = Detector()
    try:
        network.load_state_dict(torch.load(path, weights_only=True))
        return network, json.loads(log.read_text(encoding="utf-8"))["rounds"]
    except (OSError, ValueError, KeyError, RuntimeError, pickle.UnpicklingError) as error:
        reason = (str(error).splitlines() or [type(error).__name__])[0]
        raise TrainingError(
            f"{path} and {log.name}: no training to go on from: {reason}") from error


def training_round(network: Detector, drawn: PictureSet, plan: Plan, curve: list[Progress],
                   cpu_time: float) -> dict:
    """The training's log, for the report."""
    return {
        "plan": plan.as_table(),
        "pictures": len(drawn),
        "first_seed": drawn.first,
        "pictures_sha256": _digest(drawn),
        "boxes": _tally(drawn),
        "weights": sum(value.numel() for value in network.parameters()),
        "cpu_minutes": round(cpu_time / 60, 1),
        "wall_minutes": round(curve[-1].seconds / 60, 1),
        "torch": torch.__version__,
        "processor": _processor(),
        "curve": [[point.step, round(point.loss, 4)] for point in curve],
    }


def write_files(network: Detector, model: Path, rounds: list[dict]) -> None:
    """Write the model, its class names, and its log."""
    try:
        export(network, model, {"description": "trained on pictures of bullet_sim's renderer"})
    except ExportError as error:
        raise TrainingError(str(error)) from error
    names = "".join(f"  - {name}\n" for name in CLASSES)
    model.with_suffix(".yaml").write_text(
        f"# What {model.name} was trained for.\nnames:\n{names}"
        f"imgsz: [{INPUT_HEIGHT}, {INPUT_WIDTH}]  # height, width, px\n", encoding="utf-8")
    done = {"rounds": rounds, "model_sha256": hashlib.sha256(model.read_bytes()).hexdigest()}
    path = model.with_name(f"{model.stem}-training.json")
    path.write_text(json.dumps(done, indent=1) + "\n", encoding="utf-8")


def _say(point: Progress, plan: Plan, curve: list[Progress]) -> None:
    curve.append(point)
    left = point.seconds / point.step * (plan.until - point.step)
    print(f"step {point.step} of {plan.until}: loss {point.loss:.3f}, about {left / 60:.0f} min "
          "left", flush=True)


def _tally(drawn: PictureSet) -> dict[str, int]:
    counted = drawn.labels[drawn.labels[:, 6] > 0, 1].astype(int)
    return {name: int((counted == label).sum()) for label, name in enumerate(CLASSES)}


def _digest(drawn: PictureSet) -> str:
    digest = hashlib.sha256(np.ascontiguousarray(drawn.images))
    digest.update(np.ascontiguousarray(drawn.labels))
    return digest.hexdigest()


def _processor() -> str:
    """The processor's name, and the instruction set that torch uses."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    name = names[0] if names else platform.processor() or platform.machine()
    return f"{name}, {torch.backends.cpu.get_cpu_capability()}"
