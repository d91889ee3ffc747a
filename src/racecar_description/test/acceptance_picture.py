"""step_responses.png: how each controller answered each step, beside what it was told."""

from typing import NamedTuple

import matplotlib
import numpy as np

matplotlib.use("Agg")

from matplotlib import pyplot

COLUMNS, WIDTH, HEIGHT, DOTS_PER_INCH = 2, 5.0, 2.6, 80  # inches
COLOURS = ("#1b6ca8", "#c9782f", "#3a8f5c", "#7a4f9a")


class Step(NamedTuple):
    """One controller's answer: s since the step, and rad/s or rad; `command` is the same."""

    title: str
    name: str
    command: float
    times: np.ndarray
    values: np.ndarray


def write_picture(steps, path):
    """A panel for each title, a line for each controller."""
    titles = list(dict.fromkeys(step.title for step in steps))
    rows = -(-len(titles) // COLUMNS)
    sheet, grid = pyplot.subplots(rows, COLUMNS, figsize=(WIDTH * COLUMNS, HEIGHT * rows),
                                  squeeze=False, sharex=True)
    for axes, title in zip(grid.flat, titles):
        shown = [step for step in steps if step.title == title]
        _draw(axes, shown)
        axes.set_title(title, fontsize=10)
    for axes in grid[-1]:
        axes.set_xlabel("s after the command", fontsize=9)
    sheet.tight_layout()
    sheet.savefig(path, dpi=DOTS_PER_INCH)
    pyplot.close(sheet)


def _draw(axes, steps):
    command = steps[0].command
    axes.axhspan(0.95 * command, 1.05 * command, color="#dddddd")
    axes.axhline(command, color="black", linewidth=0.8, linestyle="--")
    for step, colour in zip(steps, COLOURS):
        label = step.name.split("_wheel")[0].split("_steering")[0].replace("_", " ")
        axes.plot(step.times, step.values, color=colour, linewidth=1.2, label=label)
    axes.set_ylabel("rad/s" if "wheels" in steps[0].title else "rad", fontsize=9)
    axes.tick_params(labelsize=8)
    axes.legend(fontsize=8, loc="center right")
