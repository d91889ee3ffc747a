"""run.html: a run to look at again, from what the simulator recorded."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import rosgraph
from sim_viewer.replay_page import Curve, Shown, read_recording, replay_page

from bullet_sim.errors import shortened
from bullet_sim.formats.run_log import Mark
from run_session.files import write_whole

RUN_PAGE, RECORDING = "run.html", "recording.jsonl"


def begin_recording(master_uri: str, recording: Path) -> None:
    """Have the next simulator at this master record to this file, which must not be of another."""
    recording.unlink(missing_ok=True)
    rosgraph.Master("/run_page", master_uri).setParam("/gazebo/recording", str(recording))


def write_run_page(recording: Path, page: Path, title: str, text: str = "",
                   film: Path | None = None, pictures: Sequence[Path] = (),
                   curves: Sequence[Curve] = (), marks: Sequence[Mark] = ()) -> None:
    """Write the page and remove the recording. If nothing was recorded there is no page, nor one of
    an earlier run; if it cannot be made, a line says why."""
    try:
        page.unlink(missing_ok=True)
        motion = read_recording(recording)
        if motion is not None:
            speed = Curve(("speed", "速度"), "m/s", motion.times, motion.speeds())
            shown = Shown(title, text, film if film and film.exists() else None,
                          [path for path in pictures if path.exists()], [speed, *curves], marks)
            write_whole(page, replay_page(motion, shown).encode())
        recording.unlink(missing_ok=True)
    except OSError as error:
        print(f"no {page.name}: {error.filename or recording}: {error.strerror}; all other results "
              "are there", file=sys.stderr)
    except Exception as error:  # whatever is wrong with an extra, the drive has its result
        print(f"no {page.name}: {recording} cannot be shown ({type(error).__name__}: "
              f"{shortened(str(error))}); all other results are there", file=sys.stderr)
