"""The command line of the benchmark, checked: a mistake is one line that says what to type."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from evaluation.command_line import Parser
from run_session.failure import RunError

PARTS = ("limits", "renderer", "step", "growth", "startup", "ros", "fast", "robots", "respawn",
         "learning", "worlds", "memory")
DEFAULT_MEMORY_S = 300.0
LEAST_MEMORY_S = 20.0  # below that there are too few samples for a growth


@dataclass(frozen=True)
class Options:
    """What to measure and where to write."""

    parts: tuple[str, ...]  # in the order in which they are measured
    quick: bool
    memory_s: float  # simulated s
    out: Path


def parse_options(arguments: list[str]) -> Options:
    """Options from the command line, or RunError."""
    given = _parser().parse_args(arguments)
    return Options(_parts(given.only), given.quick, _memory_s(given.memory_s), given.out.resolve())


def _parser() -> Parser:
    parser = Parser(
        package="sim_bench",
        prog="bench.py",
        description="Benchmarks the simulator against PyBullet's renderers and bare engine.",
        epilog="Exit code: 0 all was measured, 2 something could not be. Figures decide nothing.",
    )
    names = ", ".join(PARTS)
    parser.add_argument("--only", default="", metavar="PART,...", help=f"of: {names} (all)")
    parser.add_argument("--quick", action="store_true", help="few and short runs, to try it out")
    parser.add_argument(
        "--memory-s",
        default=str(DEFAULT_MEMORY_S),
        metavar="S",
        help=f"simulated seconds of the part memory ({DEFAULT_MEMORY_S:g})",
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("out/bench"),
        metavar="DIR",
        help="where bench.json, bench.png and log/ go (out/bench)",
    )
    return parser


def _parts(text: str) -> tuple[str, ...]:
    wanted = [name.strip() for name in text.split(",") if name.strip()]
    unknown = [name for name in wanted if name not in PARTS]
    if unknown:
        raise RunError(f"no part {unknown[0]!r} (ONLY=); there are: {', '.join(PARTS)}")
    return tuple(part for part in PARTS if part in wanted) if wanted else PARTS


def _memory_s(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not LEAST_MEMORY_S <= value < 1e9:
        wanted = f"simulated seconds, {LEAST_MEMORY_S:g} or more"
        raise RunError(f"--memory-s (MEMORY_S=) must be {wanted}; got {text!r}")
    return value
