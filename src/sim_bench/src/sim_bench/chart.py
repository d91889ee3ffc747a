"""bench.png: how far each figure of the acceptance table is from its bound."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

from matplotlib import pyplot

from sim_bench.acceptance import Verdict, judge
from sim_bench.results import Results

MET, MISSED = "#3a8f5c", "#c0392b"
MOST = 4.0  # times its bound, at which a bar is cut off


def write_chart(results: Results, path: Path) -> None:
    """A bar for each criterion that was measured: beyond the line at 1 is good."""
    verdicts = judge(results.figures())[::-1]
    sheet, axes = pyplot.subplots(figsize=(9.0, 1.5 + 0.25 * len(verdicts)), layout="constrained")
    bars = axes.barh([verdict.criterion.what for verdict in verdicts], list(map(_score, verdicts)),
                     color=[MET if verdict.met else MISSED for verdict in verdicts])
    axes.bar_label(bars, [f"{verdict.figure.median:.3g} {verdict.figure.unit} "
                          f"({verdict.criterion.bound})" for verdict in verdicts], fontsize=7)
    axes.axvline(1.0, color="black", linewidth=1)
    axes.set_xlim(0, 1.4 * MOST)
    axes.set_xlabel("times as good as wanted")
    axes.tick_params(labelsize=8)
    kind = "quick pass, " if results.quick else ""
    where = f"{results.machine.get('processor', '')}, {results.machine.get('cores', '?')} cores"
    axes.set_title(f"{kind}{where}, {results.began[:10]}", fontsize=10)
    sheet.savefig(path, dpi=110)
    pyplot.close(sheet)


def _score(verdict: Verdict) -> float:
    value, criterion = verdict.figure.median, verdict.criterion
    if criterion.at_least is not None:
        return min(value / criterion.at_least, MOST)
    if not criterion.at_most:
        return 1.0 if verdict.met else 0.0
    return min(criterion.at_most / value, MOST) if value > 0 else MOST
