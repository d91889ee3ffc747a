"""What pedestrians.py is told: each mistake is one line that names it."""

import importlib.util
from pathlib import Path

import pytest
import yaml

PACKAGE = Path(__file__).parents[1]
CROSSINGS = PACKAGE / "config" / "crossings.yaml"


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("pedestrians", PACKAGE / "scripts/pedestrians.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_without_parameters_the_packages_file_and_numbers_count(script):
    path, near, seed = script.read_parameters({})
    assert (Path(path).resolve(), near, seed) == (CROSSINGS.resolve(), 0.0, 0)
    assert len(script.read_crossings(path)) == 4


@pytest.mark.parametrize("given, said", [
    ({"nera": 3}, "unknown parameter ~nera"),
    ({"near": "three"}, "~near must be a number from 0 on, m, not 'three'"),
    ({"near": float("nan")}, "~near must be"),
    ({"seed": -1}, "~seed must be a whole number"),
    ({"seed": 1.5}, "~seed must be a whole number"),
])
def test_wrong_parameters_are_one_line(script, given, said):
    with pytest.raises(SystemExit) as ended:
        script.read_parameters(given)
    assert said in str(ended.value) and "\n" not in str(ended.value)


@pytest.mark.parametrize("change, said", [
    ({"kreb": 1}, "key 'kreb' is missing or unknown"),
    ({"kerb": "wide"}, "'kerb' must be a number, not 'wide'"),
    ({"far": 10**400}, "'far' must be a number"),
    ({"zebras": [{"x": 1, "y": 2}]}, "zebra 1: key 'heading' is missing or unknown"),
    ({"zebras": [{"x": 1, "y": 2, "heading": 0, "yaw": 0}]}, "zebra 1: key 'yaw' is missing or"),
    ({"zebras": 7}, "not iterable"),
])
def test_mistakes_in_the_file_are_one_line(script, tmp_path, change, said):
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(yaml.safe_load(CROSSINGS.read_text("utf-8")) | change))
    with pytest.raises(SystemExit) as ended:
        script.read_crossings(path)
    assert str(path) in str(ended.value) and said in str(ended.value)


@pytest.mark.parametrize("text", ["[1, 2]", "a: [", "kerb: 2026-13-45", ""])
def test_no_table_is_one_line(script, tmp_path, text):
    path = tmp_path / "mine.yaml"
    path.write_text(text)
    with pytest.raises(SystemExit, match=r"mine\.yaml: "):
        script.read_crossings(path)


def test_pictures_are_asked_for_before_answers_are_announced(script, monkeypatch):
    """Lockstep begins when all announced links are open; one announced late misses a picture."""
    asked = []
    monkeypatch.setattr(script.rospy, "Subscriber", lambda topic, *_, **__: asked.append(topic))
    monkeypatch.setattr(script.rospy, "Publisher", lambda topic, *_, **__: asked.append(topic))
    script.Pedestrians(script.read_crossings(CROSSINGS), script.Habits(), 0)
    first_answer = next(n for n, topic in enumerate(asked) if topic.endswith("cmd_vel"))
    assert asked.index("camera_info") < first_answer
