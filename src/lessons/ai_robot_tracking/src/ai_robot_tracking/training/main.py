"""The command line of train_detector: draw, train, report; each step uses the last one's files."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

from ai_robot_tracking.training import TrainingError

DONE, NOT_GOOD, NOT_RUN = 0, 1, 2
PICTURES, TESTED = 6000, 500
TARGET = 0.9  # mean average precision at an IoU of 0.5
MOST = 900_000  # images of one set: the sets' seeds must not overlap


class Parser(argparse.ArgumentParser):
    """Accepts only full option names; its errors are TrainingErrors."""

    def __init__(self, **settings: object) -> None:
        super().__init__(**{"allow_abbrev": False, **settings})

    def error(self, message: str) -> None:
        """Raise a TrainingError that says where the options are listed."""
        program = self.prog.split()[0]  # without the command
        raise TrainingError(f"{message} (see: rosrun ai_robot_tracking {program} --help)")


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    try:
        given = _parser().parse_args(arguments)
        return given.verb(given)
    except (TrainingError, OSError) as failure:
        print(f"train_detector: {failure}", file=sys.stderr)
        return NOT_RUN
    except ModuleNotFoundError as error:
        print(f"train_detector: no module {error.name} here; it is started by rosrun, and `train` "
              "needs: sudo apt install python3-torch python3-torchvision python3-onnx",
              file=sys.stderr)
        return NOT_RUN


def _parser() -> Parser:
    parser = Parser(
        prog="train_detector.py", description=__doc__,
        epilog="Exit code: 0 done, 1 the report's model is below the target, 2 could not run.")
    verbs = parser.add_subparsers(required=True, metavar="VERB", parser_class=Parser)
    draw = verbs.add_parser("draw", help="render the training images")
    draw.add_argument("folder", type=Path, help="where to write them: 0.25 MB per image")
    draw.add_argument("--pictures", type=_whole, default=PICTURES, metavar="N")
    draw.add_argument("--jobs", type=_whole, default=1, metavar="N", help="processes at a time (1)")
    draw.set_defaults(verb=_draw)
    train = verbs.add_parser("train", help="train a network and write it as ONNX")
    train.add_argument("folder", type=Path, help="with the images")
    train.add_argument("model", type=Path, help="the .onnx file to write")
    train.add_argument("--pictures", type=_whole, default=PICTURES, metavar="N",
                       help="how many of them to use")
    train.add_argument("--steps", type=_whole, metavar="N", help="instead of the plan's")
    train.add_argument("--until", type=_whole, metavar="N",
                       help="stop at this step, with the plan's rates unchanged")
    train.add_argument("--seed", type=partial(_whole, least=0), default=0, metavar="N")
    train.add_argument("--start", type=Path, metavar="FILE.pt",
                       help="continue an earlier training, with full-size images and smaller steps")
    train.set_defaults(verb=_train)
    report = verbs.add_parser("report", help="score a model on worlds that it was not trained on")
    report.add_argument("model", type=Path, help="the .onnx file, next to its -training.json")
    report.add_argument("--pictures", type=_whole, default=TESTED, metavar="N")
    report.set_defaults(verb=_report)
    return parser


def _whole(text: str, least: int = 1) -> int:
    if not (text.isascii() and text.isdigit()) or not least <= int(text) <= MOST:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from {least} to {MOST}")
    return int(text)


# Each command imports its own modules: only `train` needs those of PyTorch.
def _draw(given: argparse.Namespace) -> int:
    from ai_robot_tracking.training.dataset import TRAIN_FIRST, draw_set

    draw_set(given.folder, "train", TRAIN_FIRST, given.pictures, given.jobs)
    return DONE


def _train(given: argparse.Namespace) -> int:
    from ai_robot_tracking.training.training import FIRST, FURTHER, run_training

    plan = replace(FURTHER if given.start else FIRST, seed=given.seed)
    plan = replace(plan, steps=given.steps, until=given.steps) if given.steps else plan
    plan = replace(plan, until=min(plan.steps, given.until)) if given.until else plan
    run_training(given.folder, given.model, given.pictures, plan, given.start)
    return DONE


def _report(given: argparse.Namespace) -> int:
    from ai_robot_tracking.training.report import write_report

    return DONE if write_report(given.model, given.pictures) >= TARGET else NOT_GOOD
