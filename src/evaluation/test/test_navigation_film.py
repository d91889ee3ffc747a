"""Charts are whole or not there; the film of a navigation run, of made-up records, no camera."""

import errno
import subprocess
import sys
import textwrap
from types import SimpleNamespace

import numpy as np
import pytest
import rospy

from evaluation import navigate_pictures
from evaluation.house import Records, load_house
from evaluation.navigate_score import Result


class Forgetful:
    """A watch that begins anew whenever its map or scan has been looked at."""

    def __init__(self, grid):
        self.grids, self.scans = [grid, None], [np.ones((5, 2)), None]
        self.plan = np.empty((0, 2))
        self.records = Records(truth=[(0.0, 0.0, 0.0, 0.0)], believed=[(0.0, 0.0, 0.0, 0.0)])

    @property
    def map(self):
        return self.grids.pop(0)

    @property
    def hits(self):
        return self.scans.pop(0)


@pytest.fixture
def film(tmp_path):
    ground = load_house("house").ground()
    return navigate_pictures.Film(tmp_path / "run.mp4", ground, Forgetful(ground.walls), Result())


def test_a_part_that_begins_anew_while_a_page_is_drawn_ends_no_film(film):
    assert film._plan(film._watch.records).any()


def test_the_film_keeps_simulated_time_where_pictures_are_missing(film, monkeypatch):
    def wait_for_message(*_):
        raise rospy.ROSException("no camera")

    monkeypatch.setattr(navigate_pictures.rospy, "wait_for_message", wait_for_message)
    added, times = [], [3.2, 3.4, 4.1, 6.0, 999.0]
    film._add = lambda _page, count=1: added.append(count)
    film._page = lambda _records: None

    def wait(_period):
        if times:
            film._watch.records.truth.append((times.pop(0), 0.0, 0.0, 0.0))
            return False
        return True

    film._ended = SimpleNamespace(wait=wait)
    film._film()
    assert added == [1, 1, 2, navigate_pictures.LONGEST_GAP]


# In a process of its own, whose files may get no longer than 3000 bytes: as on a full disk.
DRAW = textwrap.dedent("""
    import resource, signal, sys
    from pathlib import Path
    from evaluation.picture import chart

    import matplotlib.font_manager  # writes a cache at first
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # else it ends the process
    resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))
    try:
        with chart(Path(sys.argv[1]), 1, 1) as ((axes,),):
            axes.plot([0, 1], [0, 1])
    except OSError as refused:
        print(refused.errno, refused.filename)
""")


def test_a_chart_that_cannot_be_written_leaves_no_file(tmp_path):
    path = tmp_path / "trials.png"
    done = subprocess.run([sys.executable, "-c", DRAW, str(path)], capture_output=True, text=True,
                          timeout=120, check=False)
    assert done.stdout.split() == [str(errno.EFBIG), str(path)], done.stderr
    assert list(tmp_path.iterdir()) == []
