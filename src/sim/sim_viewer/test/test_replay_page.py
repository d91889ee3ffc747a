"""The page of a recorded run: what is read of a recording, and that browsers show it from disk."""

import json
import re
import subprocess

import chromium
import firefox
import numpy as np
import pytest
from background import wait_until
from sim_viewer.replay_page import MOST_MOMENTS, Curve, Shown, read_recording, replay_page

from bullet_sim.description import Box, LightDescription, Material, SceneDescription, Visual
from bullet_sim.formats.run_log import Mark
from bullet_sim.pose import Pose
from bullet_sim.rendering.scene import Scene
from bullet_sim.rendering.scene_text import scene_to_text

pytestmark = pytest.mark.processes  # browsers
ROBOT, GROUND = ("robot", "base_link"), ("ground", "link")


def scene(*robots, texture=None):
    made = Scene(SceneDescription(background=(0.7, 0.7, 0.7, 1.0)))
    made.add_light(LightDescription("sun", type="directional", direction=(0, 0, -1)))
    for key in (GROUND, *robots):
        size, colour = ((4, 4, 0.01), 0.1) if key == GROUND else ((0.3, 0.2, 0.2), 0.9)
        paint = Material(diffuse=(colour, 0.0, 0.0, 1.0), ambient=(colour, 0.0, 0.0, 1.0),
                         texture=texture)
        made.add_link(key, [Visual("v", Box(size), material=paint)], Pose())
    return {"scene": scene_to_text(made)}


def at(time, *places):
    return {"time": time, "poses": [[x, 0, 0.2, 0, 0, 0, 1] for x in places]}


@pytest.fixture
def recorded(tmp_path):
    def write(*lines, rest=b""):
        file = tmp_path / "recording.jsonl"
        file.write_bytes(b"".join(json.dumps(line).encode() + b"\n" for line in lines) + rest)
        return read_recording(file)
    return write


NAMES = {"names": ["robot::base_link"]}


def test_links_that_come_later_and_a_second_simulation_s_time(recorded):
    more = ("late", "link")
    motion = recorded(scene(ROBOT), NAMES, at(0.1, 0), at(0.2, 1), scene(ROBOT, more),
                      {"names": [*NAMES["names"], "late::link"]}, at(0.3, 2, 7), at(0.1, 3, 8),
                      rest='{"time": 0.2, "路'.encode()[:-1])  # it was killed
    assert motion.times == pytest.approx([0.1, 0.2, 0.3, 0.4])
    assert motion.poses[:, 0, 0].tolist() == [0, 1, 2, 3]
    assert motion.poses[:, 1, 0].tolist() == [7, 7, 7, 8]
    assert set(motion.scene.links) == {ROBOT, more, GROUND}
    assert motion.speeds() == pytest.approx([0, 10, 10, 10])


def test_a_second_simulation_begins_behind_half_a_line_of_one_that_was_killed(recorded):
    second = "".join(f"{json.dumps(line)}\n" for line in (scene(ROBOT), NAMES, at(0.1, 5)))
    motion = recorded(scene(), NAMES, at(0.1, 0), at(0.2, 1),
                      rest=b'{"time": 0.3, "po' + second.encode())
    assert motion.times == pytest.approx([0.1, 0.2, 0.3])
    assert ROBOT in motion.scene.links


def test_what_a_script_moves_is_where_the_scene_had_it_and_has_no_say_in_the_speed(recorded):
    motion = recorded(scene(ROBOT, ("door", "link")), NAMES, at(0.1, 0), at(0.2, 1),
                      {"names": [*NAMES["names"], "door::link"], "scripted": 1}, at(0.3, 2, 90))
    assert motion.poses[:, 1, 0].tolist() == [0, 0, 90]
    assert motion.speeds() == pytest.approx([0, 10, 10])


def test_speeds_where_time_stands_still_and_where_nothing_moves(recorded):
    again = recorded(scene(ROBOT), NAMES, at(0.1, 0), at(0.1, 1), at(0.0, 1), at(0.1, 2))
    assert again.times == pytest.approx([0.1, 0.2, 0.2, 0.3])  # after reset_simulation
    assert again.speeds() == pytest.approx([0, 10, 0, 10])
    still = recorded(scene(), {"time": 0.1, "poses": []}, {"time": 0.2, "poses": []})
    assert still.speeds().tolist() == [0, 0]


def test_a_long_curve_keeps_its_peaks_and_one_without_values_is_left_out(recorded):
    values = np.zeros(200_001)
    values[[777, 150_000]] = 3.0, -4.0
    motion = recorded(scene(ROBOT), NAMES, at(0.1, 0), at(0.2, 1))
    name = ("beside", "偏离")
    page = replay_page(motion, Shown("lap", curves=[
        Curve(name, "m", np.arange(len(values)) / 50, values), Curve(name, "m", [], [])]))
    [curve] = run_of(page)["curves"]
    assert len(curve["values"]) == len(curve["times"]) <= MOST_MOMENTS
    assert (max(curve["values"]), min(curve["values"])) == (3.0, -4.0)
    assert curve["times"][curve["values"].index(3.0)] == pytest.approx(777 / 50)
    with pytest.raises(ValueError):  # JSON.parse knows no Infinity
        replay_page(motion, Shown("lap", curves=[Curve(name, "m", [0.1], [np.inf])]))


def run_of(page):
    """The data in a page."""
    return json.loads(re.search(r'id="run">(.*?)</script>', page)[1])


def test_nothing_was_recorded(recorded, tmp_path):
    assert recorded(NAMES, at(0.1, 0), at(0.2, 1)) is None  # no scene
    assert read_recording(tmp_path / "none") is None
    assert recorded(scene(ROBOT), NAMES, at(0.1, 0)) is None


def test_a_text_that_ends_the_script_is_only_text(recorded):
    motion = recorded(scene(ROBOT), NAMES, at(0.1, 0), at(0.2, 1))
    page = replay_page(motion, Shown("a < b", text="</script><script>alert(1)</script>"))
    assert "alert(1)</script>" not in page and "<title>a &lt; b</title>" in page
    assert not re.search(r"""(src|href)=["']?(?!data:)[^"'>]""", page)


def red_column(page):
    """Where the robot is to be seen, px from the left; 0: nowhere."""
    picture = page.picture()[60:400, :700].astype(int)
    red = picture[..., 2] - picture[..., :2].max(-1) > 120
    return float(np.nonzero(red)[1].mean()) if red.any() else 0.0


@pytest.mark.timeout(180)
@pytest.mark.parametrize("kind", [chromium, firefox], ids=lambda kind: kind.__name__)
def test_from_disk_the_slider_moves_robot_and_film_and_nothing_is_asked_of_a_network(
        kind, recorded, tmp_path):
    film, times = tmp_path / "run.mp4", np.linspace(0, 5, 50)
    subprocess.run(["ffmpeg", "-loglevel", "error", "-f", "lavfi", "-i",
                    "testsrc=size=160x120:rate=10:duration=2", "-pix_fmt", "yuv420p", film],
                   check=True)
    (tmp_path / "bad.tga").write_bytes(b"no image")
    motion = recorded(scene(ROBOT, texture=str(tmp_path / "bad.tga")), NAMES,
                      *(at(time, time / 5) for time in times))
    file = tmp_path / "run.html"
    file.write_text(replay_page(motion, Shown("lap", film=film, text="words " * 20, curves=[
        Curve(("speed", "速度"), "m/s", motion.times, motion.speeds())])))
    browser = kind.Browser()
    try:
        page = browser.open(file.as_uri())
        page.wait_for("document.querySelector('.hint')?.hidden"
                      " && document.querySelector('#film')?.readyState >= 2")
        page.evaluate("document.querySelector('.views select').value = ''")  # follow nothing
        before = wait_until(lambda: red_column(page), "the robot")
        page.evaluate("const slider = document.querySelector('#time'); slider.value = 5;"
                      "slider.dispatchEvent(new Event('input'))")
        page.wait_for("document.querySelector('#film').currentTime > 1.8")
        wait_until(lambda: abs(red_column(page) - before) > 30, "the robot elsewhere")
        assert page.evaluate("document.querySelector('figcaption').textContent").startswith(
            "speed: 0.20 m/s")
        page.resize(390, 844)  # a telephone
        page.wait_for("innerWidth === 390")
        page.wait_for("document.querySelector('main').scrollWidth <= 390")
        assert page.errors == []
        assert page.requests
        assert {url.partition(":")[0] for url in page.requests} <= {"file", "data", "blob"}
    finally:
        browser.close()


OPEN_OTHER = """(async () => {
  const data = new DataTransfer();
  data.items.add(new File([%s], "other.html"));
  const input = document.querySelector("#other");
  input.files = data.files;
  input.dispatchEvent(new Event("change"));
})()"""


@pytest.mark.timeout(180)
def test_a_second_run_is_laid_over_the_first_and_put_away_again(recorded, tmp_path):
    def page_of(title, last, slope):
        times = np.linspace(0, last, 50)
        motion = recorded(scene(ROBOT), NAMES, *(at(time, slope * time) for time in times))
        return replay_page(motion, Shown(title, marks=[Mark("lost", 2.0, "here")], curves=[
            Curve(("beside the line", "偏离线"), "m", times, slope * times)]))

    file = tmp_path / "run.html"
    file.write_text(page_of("before", 5, 0.2))
    captions = "[...document.querySelectorAll('figcaption')].map((one) => one.textContent)"
    browser = chromium.Browser()
    try:
        page = browser.open(file.as_uri())
        page.wait_for("document.querySelector('.hint')?.hidden")
        assert page.evaluate("document.querySelector('.mark.lost').title") == (
            "line lost (here), 2.00 s")
        page.evaluate("document.querySelector('.mark.lost').click()")
        assert page.evaluate("document.querySelector('#time').value") == "2"
        page.evaluate(OPEN_OTHER % json.dumps("no page"))
        page.wait_for("document.querySelector('.legend').textContent"
                      " === 'other.html is no run.html of a run'")
        page.evaluate(OPEN_OTHER % json.dumps(page_of("after", 10, 0.1)))
        page.wait_for("document.querySelector('.legend').textContent === '■ before■ after×'")
        assert page.evaluate("document.querySelector('#time').max") == "10"
        assert [line.split(" m ")[0] for line in page.evaluate(captions)] == [
            "beside the line: 0.41 | 0.20", "difference, beside the line: -0.20"]
        orange = "orange to be seen"
        wait_until(lambda: (lambda bgr: ((bgr[..., 2] > 200) & (bgr[..., 0] < 60)
                                         & (bgr[..., 1] > 100)).any())(
            page.picture()[60:400, :700]), orange)
        page.evaluate("document.querySelector('#alone').click()")
        assert page.evaluate("document.querySelector('#time').max") == "5"
        assert len(page.evaluate(captions)) == 1
        assert page.errors == []
    finally:
        browser.close()
