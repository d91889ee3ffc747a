"""What the stages of the simulator's work cost, from the tables that `profile:=true` prints."""

from __future__ import annotations

import re
from pathlib import Path

from sim_bench.figures import Figure, figure

WAITING = "wait"  # for the picture before, while that is drawn: no work
LEAST = 0.02  # of all work; what takes less is left out
PROFILE = "profile:=true"
_TABLE = re.compile(r"^stage +times .*$", re.MULTILINE)
_ROW = re.compile(r"^(\S.*?) +(\d+) +([\d.]+) +[\d.]+ +[\d.]+%$")  # name, times, ms each, ...


def stages(log: Path, turn: str) -> dict[str, float]:
    """ms of wall time that each stage of work takes in a turn.

    A turn is what the stage `turn` is done once in, a frame for example; empty where it was not
    done. From the first table of the log to the last, or of the only one.
    """
    tables = _tables(log.read_text(encoding="utf-8", errors="replace"))
    if not tables:
        return {}
    first, last = (tables[0] if len(tables) > 1 else {}), tables[-1]
    spent = {stage: (times - first.get(stage, (0, 0.0))[0], ms - first.get(stage, (0, 0.0))[1])
             for stage, (times, ms) in last.items()}
    turns = spent.get(turn, (0, 0.0))[0]
    return {stage: ms / turns for stage, (_, ms) in spent.items() if stage != WAITING and turns > 0}


def stage_figures(name: str, work: dict[str, float]) -> list[Figure]:
    """`NAME.stage.STAGE`, the greatest first, without those that make no difference."""
    least = LEAST * sum(work.values())
    return [figure(f"{name}.stage.{stage.replace(' ', '_')}", "ms", [ms])
            for stage, ms in sorted(work.items(), key=lambda item: -item[1]) if ms > least]


def _tables(text: str) -> list[dict[str, tuple[int, float]]]:
    """Of each table, by stage: how often it was done, and ms of all together."""
    tables = []
    for head in _TABLE.finditer(text):
        tables.append({})
        for line in text[head.end():].lstrip("\n").splitlines():
            row = _ROW.match(line)
            if row is None:
                break
            tables[-1][row[1]] = (int(row[2]), int(row[2]) * float(row[3]))
    return tables
