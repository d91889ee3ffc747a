"""Robots, worlds and launch files in the styles of public packages: they load, stand and speak."""

import logging
import math
import re

import pytest
from style_stage import FOLDER, Stage, lowest_point, read_styles
from tf2_msgs.msg import TFMessage

SETTLING, LISTENING = 1.0, 4.0  # s
DEEPEST = 0.01  # m below the floor
STYLES = read_styles()


@pytest.fixture
def stage(make_bench, graph, monkeypatch):
    """`stage(style)`: a bench with it, the models of this folder on the model path."""
    monkeypatch.setenv("GAZEBO_MODEL_PATH", str(FOLDER / "models"))
    return lambda style: Stage(make_bench, graph, style)


def frames(messages) -> set[str]:
    """Header frames; of transforms "parent -> child"."""
    found = set()
    for message in messages:
        if isinstance(message, TFMessage):
            found |= {f"{t.header.frame_id} -> {t.child_frame_id}" for t in message.transforms}
        elif hasattr(message, "header"):
            found.add(message.header.frame_id)
    return found


def check_models(world, expected):
    assert sorted(world.models) == sorted(expected)
    for name, parts in expected.items():
        model = world.models[name]
        for kind, found in (("links", model.links), ("joints", model.joints)):
            if kind in (parts or {}):
                assert sorted(found) == sorted(parts[kind]), f"{kind} of {name}"
        if "at" in (parts or {}):
            assert model.pose.position == pytest.approx(parts["at"], abs=0.02), name


def check_motion(world, floor):
    for name, model in world.models.items():
        states = [value for pose, twist in model.link_states().values()
                  for value in (*pose.position, *pose.orientation, *twist.linear, *twist.angular)]
        states += [value for joint in model.joints.values()
                   for value in (joint.position, joint.velocity)]
        assert all(map(math.isfinite, states)) and not model.was_mended, name
        if floor is not None and not model.static:
            assert lowest_point(model) > floor - DEEPEST, name


def check_topics(bench, expected, heard):
    for topic, (kind, rate, *frame) in expected.items():
        assert bench.advertised()[topic]._type == kind, topic
        assert len(heard[topic]) == pytest.approx(rate * LISTENING, rel=0.02, abs=1.0), topic
        assert frames(heard[topic]) == set(frame), topic


def check_reached(world, expected, within):
    for place, value in expected.items():
        name, _, joint = place.partition("/")
        model = world.models[name]
        found = model.joints[joint].position if joint else \
            (*model.pose.position[:2], model.pose.rpy()[2])
        assert found == pytest.approx(value, abs=within), place


def check_warnings(records, expected):
    said = [record.getMessage() for record in records]
    for pattern in expected:
        matching = [line for line in said if re.search(pattern, line)]
        assert matching, f"nothing said matches {pattern!r}, but: {said}"
        said.remove(matching[0])
    assert said == []


@pytest.mark.parametrize("name", STYLES)
def test_a_style_works_unchanged(stage, caplog, name):
    style = STYLES[name]
    with caplog.at_level(logging.WARNING):
        found = stage(style)
        bench = found.bench
        heard = {topic: bench.listen(topic) for topic in style.topics}
        bench.run(SETTLING)
        check_motion(bench.world, style.floor)
        for messages in heard.values():
            messages.clear()
        bench.run(LISTENING)
        check_models(bench.world, style.models)
        check_motion(bench.world, style.floor)
        check_topics(bench, style.topics, heard)
        if style.send:
            found.send()
            bench.run(style.seconds)
            check_motion(bench.world, style.floor)
        check_reached(bench.world, style.reaches, style.within)
    check_warnings(caplog.records, style.warnings)


def test_every_file_of_the_folder_is_a_style_or_part_of_one():
    named = {style.file.split("/")[0] for style in STYLES.values()}
    named |= {style.parameters.split("/")[0] for style in STYLES.values()}
    there = {path.name for path in FOLDER.iterdir()} - {"expected.yaml", "models", "parts"}
    assert there <= named
    assert len(STYLES) >= 32
