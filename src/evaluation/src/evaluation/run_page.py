"""run.html: a run to look at again, from what the simulator recorded."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from sim_viewer.replay_page import Curve, Shown, read_recording, replay_page

from run_session.files import write_whole

RUN_PAGE, RECORDING = "run.html", "recording.jsonl"
PARAMETER = "/gazebo/recording"  # of the simulator: the file to which it records


def write_run_page(recording: Path, page: Path, title: str, text: str, film: Path,
                   pictures: Sequence[Path], curves: Sequence[Curve] = ()) -> None:
    """Write the page and remove the recording; if nothing was recorded, do nothing."""
    motion = read_recording(recording)
    if motion is None:
        return
    speed = Curve(("speed", "速度"), "m/s", motion.times, motion.speeds())
    shown = Shown(title, text, film if film.exists() else None,
                  [path for path in pictures if path.exists()], [speed, *curves])
    write_whole(page, replay_page(motion, shown).encode())
    recording.unlink()
