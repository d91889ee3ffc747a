"""run.html beside a drive's results: whatever is wrong with the recording, the drive has them."""

import json

import pytest

from bullet_sim.description import Material, SceneDescription, Sphere, Visual
from bullet_sim.pose import IDENTITY
from bullet_sim.rendering.scene import Scene
from bullet_sim.rendering.scene_text import scene_to_text
from evaluation.run_page import write_run_page

SCENE = Scene(SceneDescription())
SCENE.add_link(("car", "base"), [Visual("v", Sphere(0.1), material=Material())], IDENTITY)
WHOLE = ({"scene": scene_to_text(SCENE)}, {"names": ["car::base"]},
         *({"time": time, "poses": [[time, 0, 0, 0, 0, 0, 1]]} for time in (0.1, 0.2)))


@pytest.fixture
def written(tmp_path, capsys):
    """`written(lines)`: the page's text or None, and what was said."""
    page, recording = tmp_path / "run.html", tmp_path / "recording.jsonl"
    page.write_text("of an earlier run")

    def write(lines):
        if lines is not None:
            recording.write_text("".join(json.dumps(line) + "\n" for line in lines))
        write_run_page(recording, page, "lap")
        return page.read_text() if page.exists() else None, capsys.readouterr().err
    return write


def test_what_was_recorded_is_shown_and_the_recording_goes(written, tmp_path):
    page, said = written(WHOLE)
    assert "<title>lap</title>" in page and said == ""
    assert [each.name for each in tmp_path.iterdir()] == ["run.html"]


@pytest.mark.parametrize("lines", [None, [], WHOLE[1:], WHOLE[:3]],
                         ids=["no file", "empty", "no scene", "one moment"])
def test_where_nothing_was_recorded_there_is_no_page_not_even_an_earlier_one(written, lines):
    assert written(lines) == (None, "")


def test_a_run_in_which_nothing_moved_is_shown(written):
    page, said = written([WHOLE[0], *({"time": time, "poses": []} for time in (0.1, 0.2))])
    assert page and said == ""


@pytest.mark.parametrize("line", [
    5, {"time": "soon", "poses": []}, {"names": 7}, {"poses": []}, {"time": 0.3, "poses": [[0, 1]]},
    {"time": 0.3, "poses": []}, {"scene": "{}"}, {"scene": None}])
def test_a_recording_that_is_none_costs_a_line_and_no_result(written, tmp_path, line):
    page, said = written([*WHOLE, line])
    assert page is None
    assert said.startswith(f"no run.html: {tmp_path / 'recording.jsonl'} cannot be shown (")
    assert said.endswith("); all other results are there\n") and said.count("\n") == 1


def test_a_page_that_cannot_be_written_costs_a_line_too(written, tmp_path):
    (tmp_path / "run.html.tmp").mkdir()
    assert written(WHOLE) == (None, f"no run.html: {tmp_path / 'run.html'}: Is a "
                              "directory; all other results are there\n")
