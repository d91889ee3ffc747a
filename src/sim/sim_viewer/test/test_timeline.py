"""What the time bar shows of a run's log, and what it may ask of make replay."""

from types import SimpleNamespace

from sim_viewer.tools.timeline import MAY, Timeline, timeline

from bullet_sim.formats.run_log import header, part

OF = {"words": ["evaluation", "avoid.launch"]}
LINES = [["i", 34, "01"], ["i", 33, "02"], ["mark", "lost", 0.05, "far"]]


def test_images_and_marks_of_a_run_and_what_to_type(tmp_path):
    path = tmp_path / "my run" / "run.log.gz"
    path.parent.mkdir()
    path.write_bytes(part([header(timestep=0.001, tick=0, run=OF), *LINES]))
    shown = {"times": [0.034, 0.067], "marks": [["lost", 0.05, "far"]]}
    assert timeline(path, replayed=False) == shown | {
        "command": f"make replay RUN='{path.parent}'"}
    assert timeline(path, replayed=True) == shown | {"command": ""}
    hall = path.rename(path.with_name("hall-3.run.log.gz"))
    assert timeline(hall, replayed=False)["command"] == (
        f"make replay RUN='{path.parent}/hall-3'")


def test_nothing_of_what_cannot_be_gone_back_to(tmp_path):
    path = tmp_path / "run.log.gz"
    assert timeline(path, replayed=False) == {}
    for content in (b"", part([header(timestep=0.001, tick=0, run={}), *LINES]),
                    part([header(timestep=0.001, tick=0, run=OF) | {"run_log": 0}, *LINES])):
        path.write_bytes(content)
        assert timeline(path, replayed=False) == {}


def test_the_bar_goes_when_a_replay_ends_in_an_open_page(tmp_path, monkeypatch):
    path = tmp_path / "run.log.gz"
    path.write_bytes(part([header(timestep=0.001, tick=0, run=OF), *LINES]))
    values = {"/gazebo/replay": str(path)}
    monkeypatch.setattr("rospy.get_param", values.get)
    monkeypatch.setattr("sim_viewer.tools.timeline.simulator_name", lambda _state: "/gazebo")
    sent = []
    bar = Timeline.__new__(Timeline)
    monkeypatch.setattr(Timeline, "master", SimpleNamespace(state=lambda: None), raising=False)
    monkeypatch.setattr(Timeline, "changed", lambda _self, value: sent.append(value))
    bar.collect()
    bar.collect()  # nothing new
    assert len(sent) == 1 and sent[0]["marks"]
    values.clear()
    bar.collect()
    assert sent[1:] == [{}]
    values["/gazebo/replay"] = str(path)
    bar.collect()
    assert sent[2] == sent[0]


def test_what_may_be_asked():
    asked = ("image:1", "image:700", "go", "image:0", "image:-1", "q", "lost", "go image:1", "")
    assert [word for word in asked if MAY.fullmatch(word)] == ["image:1", "image:700", "go"]
