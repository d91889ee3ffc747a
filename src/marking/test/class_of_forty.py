"""Marks forty made-up submissions twice and checks every row: minutes, and what is not as designed.

    source devel/setup.bash
    python3 src/marking/test/class_of_forty.py --out DIR [--workers 2] [--only NAME ...]
"""

from __future__ import annotations

import argparse
import csv
import subprocess
import sys
import time
from pathlib import Path

import made_up

SCRIPT = Path(__file__).parents[1] / "scripts" / "mark.py"
# Of all that are made up, these are much like another one.
LEFT_OUT = {"王 小明: $(env HOME)", "reads_pose", "crash_later", "tabs", "sets_link", "deletes",
            "unpauses", "resets", "wrench", "images", "kills_all", "sleeps_first",
            "package.tar.gz", "broken.zip"}
LIMIT = 1500.0  # s, wall, for forty on two cores
REAL_TIME_POINTS = 1.0


def mark(folder: Path, out: Path, workers: int) -> tuple[float, list[dict[str, str]]]:
    """Seconds, and the rows of marks.csv."""
    began = time.monotonic()
    subprocess.run(
        [sys.executable, str(SCRIPT), "--submissions", str(folder / "submissions"), "--rules",
         str(folder / "marking.yaml"), "--out", str(out), "--workers", str(workers)], check=True)
    with (out / "marks.csv").open(encoding="utf-8-sig", newline="") as file:
        return time.monotonic() - began, list(csv.DictReader(file))


def _nearly_equal(one: dict[str, str], other: dict[str, str]) -> bool:
    """Drives in real time depend on how busy the machine is."""
    apart = abs(float(one["points"]) - float(other["points"]))
    return one["note"] == other["note"] != "" and apart <= REAL_TIME_POINTS


def main() -> int:
    """0: every row is as designed, both runs are equal and within the limit."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--only", nargs="+", metavar="NAME")
    options = parser.parse_args()
    chosen = set(options.only or {*made_up.PROGRAMS, *made_up.ARCHIVES} - LEFT_OUT)
    folder = options.out.resolve()
    expected = made_up.write(folder / "submissions", chosen)
    made_up.write_rules(folder / "marking.yaml")
    wrong = []
    runs = [mark(folder, folder / name, options.workers) for name in ("first", "second")]
    for number, (seconds, rows) in enumerate(runs, start=1):
        print(f"run {number}: {len(rows)} submissions in {seconds / 60:.1f} min, "
              f"{seconds / len(rows):.1f} s each")
        wrong += [f"run {number}: {each}" for each in made_up.wrong_rows(rows, expected)]
        if seconds > LIMIT:
            wrong.append(f"run {number} took more than {LIMIT / 60:g} min")
    wrong += [f"not the same twice: {one['student']}: {one['points']}, {other['points']}"
              for one, other in zip(runs[0][1], runs[1][1], strict=True)
              if one != other and not _nearly_equal(one, other)]
    print("\n".join(wrong) or "every row is as designed; both runs are equal (in real time: "
          f"within {REAL_TIME_POINTS:g} point)")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
