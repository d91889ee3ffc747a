"""The film of a drive: one picture a period of simulated time, whatever the pace and the gaps."""

import errno
import os
import signal
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import cv2
import numpy as np
import pytest
import rospy
from lane_keeping.world import ground
from racecar_description.track import course_model, painting
from racecar_description.track.closed_line import build_track
from racecar_description.track.track_file import load_track_file
from sensor_msgs.msg import Image

import evaluation.film
from evaluation.course_run import FOUND, SEEN, CourseFilm
from evaluation.film import BAR_PX, FAST_FILM_PERIOD, FILM_PERIOD, VIEW_PX, FilmFile, fit
from evaluation.lap import LapScorer, Sample
from evaluation.picture import CAR, LEGEND_PX, START, bgr
from run_session.course_file import load_course

pytestmark = pytest.mark.processes  # encoders, and limits of time
TRACK = Path(__file__).parent.parent / "tracks" / "course.yaml"
PICTURE = np.zeros((9, 16, 3), np.uint8).tobytes()


def new_film(path: Path, period: float = FILM_PERIOD, *samples: Sample) -> CourseFilm:
    track_file = load_track_file(TRACK)
    drive = LapScorer(build_track(track_file))
    for sample in samples:
        drive.add(sample)
    return CourseFilm(path, load_course("course"), track_file, drive, period)


def film_of(path: Path, period: float, stamps: np.ndarray) -> int:
    """Pictures in the film that is made from camera images with these stamps (s)."""
    film = new_film(path, period, Sample(0.0, 0.0, 0.0, 0.0))
    for stamp in stamps:
        image = Image(height=9, width=16, encoding="rgb8", step=48, data=PICTURE)
        image.header.stamp = rospy.Time.from_sec(stamp)
        film.take(image)
    film.close()
    return int(cv2.VideoCapture(str(path)).get(cv2.CAP_PROP_FRAME_COUNT))


@pytest.mark.parametrize("period", [FILM_PERIOD, FAST_FILM_PERIOD])
def test_one_picture_a_period(tmp_path, period):
    stamps = np.arange(0, 8, 0.1)
    assert film_of(tmp_path / "run.mp4", period, stamps) == pytest.approx(8 / period, abs=1)


def test_the_encoder_loads_before_the_first_picture_comes(tmp_path, monkeypatch):
    """That took 5 s on a busy machine, and a fast drive was over; without a picture no film is."""
    monkeypatch.setattr(rospy, "Subscriber", lambda *_, **__: None)
    film = new_film(tmp_path / "run.mp4")
    film.start()
    assert film.process_id is not None and not film.codec
    assert film.close() == "" and not film.codec
    assert not list(tmp_path.iterdir())


def test_an_encoder_that_cannot_begin_is_no_end_of_the_drive(tmp_path, monkeypatch):
    monkeypatch.setattr(rospy, "Subscriber", lambda *_, **__: None)
    film = new_film(tmp_path / "nowhere" / "run.mp4")
    monkeypatch.setattr(tempfile, "TemporaryFile", no_room)
    film.start()
    assert film.close() == ""


def no_room():
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_gap_is_filled(tmp_path):
    assert film_of(tmp_path / "run.mp4", 0.8, np.array([0.0, 0.8, 4.8, 5.6])) == 8


def test_a_drive_at_fifteen_times_the_speed_loses_no_second_in_which_the_machine_was_busy(tmp_path):
    stamps = np.array([0.0, 0.2, 15.2, 15.4])
    assert film_of(tmp_path / "run.mp4", FILM_PERIOD, stamps) == 78


@pytest.mark.parametrize("size_px, view_px", [
    ((1920, 1080), VIEW_PX), ((640, 480), (480, 360)), ((100, 10), (640, 64))])
def test_the_camera_keeps_its_proportions(size_px, view_px):
    width, height = size_px
    assert fit(np.zeros((height, width, 3), np.uint8)).shape[1::-1] == view_px


def test_the_line_keeps_its_colour_beside_its_outline_and_the_path_and_words_say_which(tmp_path):
    """It was tinted until it was orange."""
    film = new_film(tmp_path / "run.mp4", FILM_PERIOD, Sample(0.0, 0.0, 0.0, 0.0))
    view = np.full((*VIEW_PX[::-1], 3), 10, np.uint8)
    view[180:, 310:330] = bgr("#ffff00")
    page = film.page(view, 0.0)
    assert tuple(page[BAR_PX + 200, 320]) == bgr("#ffff00")
    assert tuple(page[BAR_PX + 200, 308]) == bgr(SEEN)  # beside it, not on it
    legend = page[-LEGEND_PX:].reshape(-1, 3).tolist()
    for part, shown in (((0, 640), SEEN), ((0, 640), FOUND), ((640, 1160), "#ffff00"),
                        ((640, 1160), START), ((640, 1160), CAR)):
        assert list(bgr(shown)) in page[BAR_PX:-LEGEND_PX, slice(*part)].reshape(-1, 3).tolist()
        assert list(bgr(shown)) in legend


@pytest.mark.parametrize("course, painted", [
    ("course", course_model.YELLOW), ("race", painting.YELLOW), ("lane", ground.ROAD),
    ("lane_empty", ground.ROAD)])
def test_pictures_have_the_colour_in_which_the_line_is_painted(course, painted):
    assert bgr(load_course(course).line_colour) == painted[::-1]


PAGE = np.zeros((360, 640, 3), np.uint8)


def test_a_full_disk_is_said(tmp_path):
    path = tmp_path / "run.mp4"
    path.symlink_to("/dev/full")
    encoder = evaluation.film.FfmpegEncoder(path, 640, 360, 10)
    for _ in range(20):
        encoder.write(PAGE)
    assert "No space left" in encoder.close()


def test_a_film_has_its_name_when_it_is_whole(tmp_path):
    film = FilmFile(tmp_path / "run.mp4")
    film._add(PAGE, 5)
    assert not (tmp_path / "run.mp4").exists()  # whoever is killed now leaves none
    assert film.close() == ""
    assert [path.name for path in tmp_path.iterdir()] == ["run.mp4"]
    assert cv2.VideoCapture(str(tmp_path / "run.mp4")).read()[0]


FILMS_ON_A_SMALL_DISK = """
import subprocess, sys
from pathlib import Path
import numpy as np
from evaluation.film import FilmFile
disk = Path(sys.argv[1])
subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(disk)], check=True)
film = FilmFile(disk / "run.mp4")
page = np.random.default_rng(1).integers(0, 255, (120, 160, 3), dtype=np.uint8)
for number in range(24):
    film._add(np.roll(page, number, 0))
print(film.close(), (disk / "run.mp4").exists())
"""


@pytest.mark.skipif(subprocess.run(["unshare", "-rm", "true"]).returncode, reason="no namespaces")
def test_a_disk_that_gets_full_meanwhile_leaves_no_half_a_film(tmp_path):
    done = subprocess.run(["unshare", "-rm", sys.executable, "-c", FILMS_ON_A_SMALL_DISK, tmp_path],
                          capture_output=True, text=True, timeout=120)
    assert done.stdout.endswith("No space left on device False\n"), done


def test_an_encoder_that_hangs_holds_nothing_up_and_leaves_no_broken_film(tmp_path, monkeypatch):
    monkeypatch.setattr(evaluation.film, "WRITE_TIME", 0.2)
    monkeypatch.setattr(evaluation.film, "FINISH_TIME", 0.2)
    film = FilmFile(tmp_path / "run.mp4")
    film._add(PAGE)
    encoder = film._writer._process
    encoder.send_signal(signal.SIGSTOP)
    film._add(PAGE, times=20)
    assert film.close() == "ffmpeg took no picture for 0.2 s"
    assert encoder.poll() is not None
    assert not film.codec and not (tmp_path / "run.mp4").exists()


def test_a_ctrl_c_while_a_picture_waits_for_the_encoder_ends_that(tmp_path):
    film = FilmFile(tmp_path / "run.mp4")
    film._add(PAGE)
    encoder = film._writer._process
    encoder.send_signal(signal.SIGSTOP)
    before = signal.signal(signal.SIGUSR1, signal.default_int_handler)  # shells may ignore SIGINT
    threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGUSR1)).start()
    with film._lock, pytest.raises(KeyboardInterrupt):  # as the thread that adds a picture does
        film.close()
    signal.signal(signal.SIGUSR1, before)
    assert encoder.poll() is not None
