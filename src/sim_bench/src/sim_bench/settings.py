"""What to measure, how long, and where to write: the benchmark's command line."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path

from evaluation.command_line import Parser, number, one_of

PARTS = ("limits", "renderer", "step", "growth", "startup", "ros", "fast", "robots", "respawn",
         "learning", "worlds", "accuracy", "memory")
DEFAULT_MEMORY_S = 300.0
LEAST_MEMORY_S = 20.0  # below that there are too few samples for a growth


@dataclass(frozen=True)
class Settings:
    """Of one run of the benchmark."""

    parts: tuple[str, ...]  # in the order in which they are measured
    quick: bool  # few and short runs: shows that all works, not how fast
    memory_s: float  # simulated seconds of the part `memory`
    out: Path  # folder of results; logs of started programs go below it

    def runs(self, usual: int) -> int:
        """How often to measure: `usual`, or 2 for a quick pass."""
        return 2 if self.quick else usual

    def seconds(self, usual: float) -> float:
        """How long to measure, s: `usual`, or a quarter of it for a quick pass."""
        return usual / 4 if self.quick else usual


def say(text: str) -> None:
    """A line for the person who waits."""
    print(text, flush=True)


def parse(arguments: list[str]) -> Settings:
    """Settings from the command line, or RunError."""
    parser = Parser(
        package="sim_bench",
        prog="bench.py",
        description="Benchmarks the simulator against PyBullet's renderers and bare engine.",
        epilog="Exit code: 0 all was measured, 2 something could not be. Figures decide nothing.",
    )
    parser.add_argument("--only", type=_parts, default=PARTS, metavar="PART,...",
                        help=f"of: {', '.join(PARTS)} (all)")
    parser.add_argument("--quick", action="store_true", help="few and short runs, to try it out")
    parser.add_argument(
        "--memory-s", default=DEFAULT_MEMORY_S, metavar="S",
        type=partial(number, "--memory-s (MEMORY_S=)", least=LEAST_MEMORY_S, most=1e9,
                     what="simulated seconds"),
        help=f"simulated seconds of the part memory ({DEFAULT_MEMORY_S:g})")
    parser.add_out("out/bench", "bench.json, bench.png and log/")
    given = parser.parse_args(arguments)
    return Settings(given.only, given.quick, given.memory_s, given.out.resolve())


def _parts(text: str) -> tuple[str, ...]:
    wanted = {one_of("part", "ONLY", PARTS, name.strip()) for name in text.split(",")
              if name.strip()}
    return tuple(part for part in PARTS if part in wanted) if wanted else PARTS
