"""One training, from images to files: the network, its class names, and a log as JSON.

It runs on one thread: the same images and seed give the same bytes. The ONNX file has YOLO's v8
layout, (1, 4 + classes, cells); its weights are in half precision, which onnxruntime converts once
when it opens the file.
"""

from __future__ import annotations

import hashlib
import io
import itertools
import json
import math
import pickle
import platform
import re
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from itertools import chain, islice
from pathlib import Path

import numpy as np
import onnx
import onnxruntime
import torch
from onnx import numpy_helper
from torch import nn
from torch.optim.lr_scheduler import LambdaLR
from torch.optim.swa_utils import AveragedModel
from torchvision.ops import box_convert

from ai_robot_tracking.training import CLASSES, TrainingError
from ai_robot_tracking.training.dataset import (
    INPUT_HEIGHT,
    INPUT_WIDTH,
    PICTURE,
    PictureSet,
    augmented,
    read_sets,
)
from ai_robot_tracking.training.loss import detection_loss
from ai_robot_tracking.training.network import Detector, cells

OPSET = 16
WORST = 0.5  # px, or hundredths of a score: largest allowed difference between torch and ONNX
SMALL = (160, 192)  # height, width, px
WHOLE = (INPUT_HEIGHT, INPUT_WIDTH)
MOST_BOXES = 16  # per image that are used
REPORT_STEPS = 50


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


@dataclass(frozen=True)
class Plan:
    """The training's parameters, all listed in the report."""

    seed: int = 0
    steps: int = 5200
    until: int = 5200  # the step at which it stops; the rates are planned for all `steps`
    batch: int = 16  # images per step
    learning_rate: float = 3e-3  # the highest; rises during `warm_steps`, then falls as a cosine
    last_rate: float = 0.01  # share of the highest
    warm_steps: int = 100
    weight_decay: float = 0.02
    averaging: float = 0.995  # decay of the running mean of the weights, which is the result
    small: float = 0.55  # first share of the steps, with images of size SMALL: faster
    calm: float = 0.1  # last share of the steps, with images that are not augmented


FIRST = Plan()
FURTHER = Plan(steps=1500, until=1500, learning_rate=1e-3, small=0.0, calm=0.15)


@dataclass(frozen=True)
class Progress:
    """One point of the curve."""

    step: int
    loss: float  # mean since the last point
    seconds: float  # wall, since the start


def train(pictures: PictureSet, plan: Plan, say: Callable[[Progress], None],
          start: Detector | None = None) -> Detector:
    """The averaged network, ready for export.

    With `start` it continues from that network, which is modified.
    """
    torch.manual_seed(plan.seed)
    torch.use_deterministic_algorithms(True)
    torch.set_num_threads(1)
    network = (start or Detector()).to(memory_format=torch.channels_last)
    averaged = AveragedModel(network, avg_fn=_mean(plan.averaging), use_buffers=True)
    optimiser = torch.optim.AdamW(_groups(network, plan.weight_decay), lr=plan.learning_rate)
    rates = LambdaLR(optimiser, lambda step: _rate(step, plan))
    began, losses = time.monotonic(), []
    network.train()
    for step, (images, truth) in enumerate(_batches(pictures, plan), start=1):
        boxes, logits = network(images)
        loss = detection_loss(boxes, logits, cells(*images.shape[2:])[0], truth)
        optimiser.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 10.0)
        optimiser.step()
        rates.step()
        averaged.update_parameters(network)
        losses.append(loss.item())
        if step % REPORT_STEPS == 0 or step == plan.until:
            say(Progress(step, float(np.mean(losses)), time.monotonic() - began))
            losses.clear()
    return averaged.module.eval()


def _batches(pictures: PictureSet, plan: Plan) -> Iterator[tuple[torch.Tensor, torch.Tensor]]:
    """For each step images (b, 3, h, w) float 0..1 and truth (b, MOST_BOXES, 6), -1 where there is
    none; in an order that only depends on the seed."""
    count, rows = len(pictures), pictures.labels[:, PICTURE].astype(int)
    ends = np.searchsorted(rows, np.arange(count + 1))
    order = chain.from_iterable(np.random.default_rng((plan.seed, 1, turn)).permutation(count)
                                for turn in itertools.count())
    for step in range(plan.until):
        calm = step >= plan.steps * (1 - plan.calm)
        shape = SMALL if step < plan.steps * plan.small else WHOLE
        images = np.empty((plan.batch, *shape, 3), np.uint8)
        truth = np.full((plan.batch, MOST_BOXES, 6), -1, np.float32)
        for place, index in enumerate(islice(order, plan.batch)):
            image = pictures.images[index]
            labels = pictures.labels[ends[index]:ends[index + 1], 1:]
            if not calm:
                rng = np.random.default_rng((plan.seed, 2, step, place))
                image, labels = augmented(rng, image, labels, shape)
            images[place] = image
            truth[place, :len(labels)] = labels[:MOST_BOXES]
        pixels = torch.from_numpy(images).permute(0, 3, 1, 2).float() / 255
        yield pixels.contiguous(memory_format=torch.channels_last), torch.from_numpy(truth)


def _groups(network: Detector, decay: float) -> list[dict]:
    """Parameter groups: no weight decay for biases and norms."""
    large = [p for p in network.parameters() if p.ndim > 1]
    small = [p for p in network.parameters() if p.ndim <= 1]
    return [{"params": large, "weight_decay": decay}, {"params": small, "weight_decay": 0.0}]


def _rate(step: int, plan: Plan) -> float:
    if step < plan.warm_steps:
        return (step + 1) / plan.warm_steps
    share = (step - plan.warm_steps) / max(1, plan.steps - plan.warm_steps)
    return plan.last_rate + (1 - plan.last_rate) * (1 + math.cos(math.pi * share)) / 2


def _mean(decay: float) -> Callable:
    """The running mean of the weights, which forgets the first ones sooner."""
    return lambda mean, now, steps: now + (mean - now) * min(decay, (1 + steps) / (10 + steps))


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
    network = train(drawn, plan, lambda point: _say(point, plan, curve), network)
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
        "plan": asdict(plan),
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
    export(network, model, {"description": "trained on pictures of bullet_sim's renderer"})
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
    told = re.findall(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text(encoding="utf-8"))
    used = re.findall(r"CPU capability usage: (\S+)", torch.__config__.show())
    return ", ".join([*(told[:1] or [platform.machine()]), *used])
