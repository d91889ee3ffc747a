"""`make track` with the real simulator: a short drive, scored, filmed and reported."""

import json
import subprocess
import sys
from pathlib import Path

import cv2
import pytest

from evaluation.command_line import NOT_RUN
from evaluation.live import run_program_of
from evaluation.track import TrackRun

pytestmark = pytest.mark.processes
SCRIPT = Path(__file__).parent.parent / "scripts" / "track.py"
LIMIT = 200.0  # s, wall


@pytest.mark.timeout(LIMIT + 30)
def test_a_short_drive(tmp_path):
    command = [sys.executable, "-P", str(SCRIPT), "--fast", "--scene", "moving", "--seed", "3",
               "--keep", "12", "--out", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "kept" in done.stdout
    report = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))
    assert (report["outcome"], report["share_within_band"]) == ("kept", 1.0)
    assert report["kept_s"] >= 12
    assert report["frames_dropped"] == 0
    assert report["frames_sent"] == pytest.approx(30 * report["simulated_s"], abs=5)
    assert cv2.imread(str(tmp_path / "path.png")).shape[1] == 1400
    assert cv2.VideoCapture(str(tmp_path / "run.mp4")).get(cv2.CAP_PROP_FRAME_COUNT) >= 8


def test_mistakes_start_nothing(tmp_path, capsys):
    words = ["--scene", "dark", "--out", str(tmp_path / "out")]
    assert run_program_of(TrackRun, words) == NOT_RUN
    said = capsys.readouterr().err
    assert said.startswith("track: no scene 'dark' (SCENE=); there are: static, moving")
    assert not (tmp_path / "out").exists()
