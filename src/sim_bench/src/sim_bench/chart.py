"""bench.png: one panel for each group of figures that was measured."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

from matplotlib import pyplot
from matplotlib.axes import Axes

from sim_bench.acceptance import judge
from sim_bench.figures import Figure
from sim_bench.results import Results

Figures = dict[str, Figure]
COLUMNS, PANEL_WIDTH, PANEL_HEIGHT, DOTS_PER_INCH = 3, 5.6, 4.0, 110  # inches
OURS, OTHERS = "#1b6ca8", ("#c9782f", "#7a8b99")
MET, MISSED = "#3a8f5c", "#c0392b"
SIZES = ("320x240", "640x480", "1280x720", "1920x1080")
MOST_EXCESS = 4.0  # times its bound, at which a bar of the acceptance panel is cut off


def write_chart(results: Results, path: Path) -> None:
    """Draw what there is; a panel without any figure is left out."""
    figures = results.figures()
    panels = [panel for panel in PANELS if _wanted(figures, panel)]
    others = max(0, len(panels) - 1)
    rows, columns = max(1, -(-others // COLUMNS)), min(COLUMNS, others)
    sheet = pyplot.figure(figsize=(PANEL_WIDTH * (columns + 1), PANEL_HEIGHT * rows))
    grid = sheet.add_gridspec(rows, columns + 1)
    places = [grid[number // columns, number % columns] for number in range(others)]
    # The last one has a bar for each goal.
    for place, (title, _, draw) in zip([*places, grid[:, columns]], panels):
        axes = sheet.add_subplot(place)
        draw(axes, figures)
        axes.set_title(title, fontsize=10)
        axes.tick_params(labelsize=8)
    kind = "quick pass, " if results.quick else ""
    where = f"{results.machine.get('processor', '')}, {results.machine.get('cores', '?')} cores"
    sheet.suptitle(f"{kind}{where}, {results.began[:10]}", fontsize=11)
    sheet.tight_layout()
    sheet.savefig(path, dpi=DOTS_PER_INCH)
    pyplot.close(sheet)


def _wanted(figures: Figures, panel: tuple[str, tuple[str, ...], object]) -> bool:
    return any(name.startswith(prefix) for name in figures for prefix in panel[1])


def _bars(axes: Axes, groups: list[str], series: dict[str, list[Figure | None]]) -> None:
    """Medians as bars side by side, with the least and the greatest run as whiskers."""
    width = 0.8 / max(1, len(series))
    for number, (label, found) in enumerate(series.items()):
        places = [i + (number - (len(series) - 1) / 2) * width for i in range(len(groups))]
        there = [(place, one) for place, one in zip(places, found) if one is not None]
        if there:
            colour = (OURS, *OTHERS)[number % 3]
            axes.bar(
                [place for place, _ in there], [one.median for _, one in there], width,
                label=label, color=colour, yerr=_whiskers([one for _, one in there]),
                error_kw={"elinewidth": 1, "capsize": 2},
            )
    axes.set_xticks(range(len(groups)), groups)
    if len(series) > 1:
        axes.legend(fontsize=8)


def _whiskers(found: list[Figure]) -> list[list[float]]:
    return [[one.median - one.min for one in found], [one.max - one.median for one in found]]


def _line(axes: Axes, figures: Figures, prefix: str, label: str, colour: str) -> None:
    """Medians over the number at the end of the name."""
    found = sorted(
        (int(name.rpartition(".")[2]), one)
        for name, one in figures.items()
        if name.startswith(prefix)
    )
    if found:
        axes.errorbar(
            [count for count, _ in found], [one.median for _, one in found],
            _whiskers([one for _, one in found]), label=label, color=colour, marker="o", capsize=2,
        )


def _draw_renderer(axes: Axes, figures: Figures) -> None:
    names = {"ours": "ours", "tiny": "TinyRenderer", "plugin": "PyBullet's EGL plugin"}
    series = {
        label: [figures.get(f"renderer/frame.{kind}.{size}") for size in SIZES]
        for kind, label in names.items()
    }
    _bars(axes, list(SIZES), series)
    axes.set_yscale("log")
    axes.set_ylabel("ms a frame")


def _draw_ratios(axes: Axes, figures: Figures) -> None:
    names = {"tiny": "TinyRenderer", "plugin": "PyBullet's EGL plugin"}
    series = {
        label: [figures.get(f"renderer/ratio.{kind}.{size}") for size in SIZES]
        for kind, label in names.items()
    }
    _bars(axes, list(SIZES), {"ours": [None] * len(SIZES), **series})
    axes.set_yscale("log")
    axes.set_ylabel("times our time")


def _draw_step(axes: Axes, figures: Figures) -> None:
    states = ["standing", "driving"]
    names = {"ours": "World.step", "bare": "bare stepSimulation"}
    series = {
        label: [figures.get(f"step/step.{kind}.{state}") for state in states]
        for kind, label in names.items()
    }
    _bars(axes, states, series)
    axes.set_ylabel("us a step")


def _draw_robots(axes: Axes, figures: Figures) -> None:
    _line(axes, figures, "growth/robots.", "robots", OURS)
    _line(axes, figures, "growth/obstacles.fixed.", "fixed boxes", OTHERS[1])
    _line(axes, figures, "growth/obstacles.loose.", "loose boxes", OTHERS[0])
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.set_xlabel("how many")
    axes.set_ylabel("wall ms a simulated s")
    axes.legend(fontsize=8)


def _draw_rays(axes: Axes, figures: Figures) -> None:
    _line(axes, figures, "growth/rays.", "rays", OURS)
    axes.set_xlabel("rays a sweep")
    axes.set_ylabel("ms a sweep")
    axes.set_ylim(bottom=0)


def _draw_rates(axes: Axes, figures: Figures) -> None:
    names = ("1080p", "720p")
    _bars(axes, list(names), {
        "frames/s": [figures.get(f"ros/{name}.frames") for name in names],
        "age at the callback, ms": [figures.get(f"ros/{name}.frame_age") for name in names],
    })


def _draw_cpu(axes: Axes, figures: Figures) -> None:
    """Processor time by process, stacked."""
    states = ("1080p", "720p", "idle", "paused")
    found = {name: one for name, one in figures.items() if ".cpu." in name}
    bottom = dict.fromkeys(states, 0.0)
    for process in sorted({name.rpartition(".cpu.")[2] for name in found}):
        heights = [found.get(f"ros/{state}.cpu.{process}") for state in states]
        values = [one.median if one else 0.0 for one in heights]
        axes.bar(states, values, bottom=list(bottom.values()), label=process)
        bottom = {state: bottom[state] + value for state, value in zip(states, values)}
    axes.set_ylabel("% of a core")
    axes.legend(fontsize=7)


def _draw_fast(axes: Axes, figures: Figures) -> None:
    names = {
        "make course\nFAST=1": "fast/make_course.real_time_factor",
        "lockstep\n640x480": "fast/lockstep.real_time_factor",
        "no camera\nat rest": "fast/no_camera.standing.real_time_factor",
        "no camera\ndriving": "fast/no_camera.driving.real_time_factor",
        "ten robots": "robots/real_time_factor",
    }
    _bars(axes, list(names), {"x": [figures.get(name) for name in names.values()]})
    axes.set_ylabel("times real time")


def _draw_triangles(axes: Axes, figures: Figures) -> None:
    _line(axes, figures, "worlds/real_time_factor.signs.", "a camera of 320x240 at 30 Hz", OURS)
    axes.set_xscale("log")
    axes.set_ylim(0, 1.1)
    axes.set_xlabel("triangles in the world")
    axes.set_ylabel("times real time")
    axes.legend(fontsize=8)


def _draw_worlds(axes: Axes, figures: Figures) -> None:
    names = {
        "four cameras,\n16 rings": "four_cameras_and_rings", "depth\n640x480": "depth.640x480",
        "depth\n1920x1080": "depth.1920x1080", "playpen,\n4 wheels": "playpen.4_wheels",
        "playpen,\n6 wheels": "playpen.6_wheels",
    }
    found = [figures.get(f"worlds/real_time_factor.{name}") for name in names.values()]
    _bars(axes, list(names), {"x": found})
    axes.set_ylabel("times real time")


def _draw_acceptance(axes: Axes, figures: Figures) -> None:
    """How far each figure is from its bound: beyond the line at 1 is good."""
    verdicts = judge(figures)[::-1]
    scores = [_score(verdict) for verdict in verdicts]
    colours = [MET if verdict.met else MISSED for verdict in verdicts]
    axes.barh([verdict.criterion.what for verdict in verdicts], scores, color=colours)
    axes.axvline(1.0, color="black", linewidth=1)
    axes.set_xlabel("times as good as wanted")
    axes.tick_params(axis="y", labelsize=6)


def _score(verdict: object) -> float:
    value, criterion = verdict.figure.median, verdict.criterion
    if criterion.at_least is not None:
        return min(value / criterion.at_least, MOST_EXCESS)
    if not criterion.at_most:
        return 1.0 if verdict.met else 0.0
    return min(criterion.at_most / value, MOST_EXCESS) if value > 0 else MOST_EXCESS


# Title, prefixes of names of which one has to be there, and what draws it.
PANELS: tuple[tuple[str, tuple[str, ...], Callable[[Axes, Figures], None]], ...] = (
    ("A frame of the course", ("renderer/frame.",), _draw_renderer),
    ("How many times our time others take", ("renderer/ratio.",), _draw_ratios),
    ("A physics step, course with waffle", ("step/step.",), _draw_step),
    ("Lesson 05 over ROS, real time", ("ros/1080p.", "ros/720p."), _draw_rates),
    ("Processor time by process", tuple(f"ros/{s}.cpu" for s in ("1080p", "720p", "idle")),
     _draw_cpu),
    ("As fast as it goes", ("fast/", "robots/real_time_factor"), _draw_fast),
    ("More robots, more obstacles", ("growth/robots.", "growth/obstacles."), _draw_robots),
    ("More laser rays", ("growth/rays.",), _draw_rays),
    ("Triangles in a world", ("worlds/real_time_factor.signs.",), _draw_triangles),
    ("Worlds with all sensors heard", ("worlds/",), _draw_worlds),
    ("Acceptance", ("",), _draw_acceptance),
)
