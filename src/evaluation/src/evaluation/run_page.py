"""run.html: a run to look at again, from what the simulator recorded."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import rosgraph
from sim_viewer.replay_page import Curve, Shown, read_recording, replay_page

from run_session.files import write_whole

RUN_PAGE, RECORDING = "run.html", "recording.jsonl"


def begin_recording(master_uri: str, recording: Path) -> None:
    """Have the next simulator at this master record to this file, which must not be of another."""
    recording.unlink(missing_ok=True)
    rosgraph.Master("/run_page", master_uri).setParam("/gazebo/recording", str(recording))


def write_run_page(recording: Path, page: Path, title: str, text: str = "",
                   film: Path | None = None, pictures: Sequence[Path] = (),
                   curves: Sequence[Curve] = ()) -> None:
    """Write the page and remove the recording; if nothing was recorded, do nothing."""
    motion = read_recording(recording)
    if motion is None:
        return
    speed = Curve(("speed", "速度"), "m/s", motion.times, motion.speeds())
    shown = Shown(title, text, film if film and film.exists() else None,
                  [path for path in pictures if path.exists()], [speed, *curves])
    write_whole(page, replay_page(motion, shown).encode())
    recording.unlink()
