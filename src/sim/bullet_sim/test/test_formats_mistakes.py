"""One wrong thing in a world is an error line, and all the rest of the world is there."""

import logging

import pytest

from bullet_sim.errors import FormatError
from bullet_sim.formats import mistakes
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.world import World

OTHER = """<model name="other"><link name="l"><collision name="c"><geometry><sphere/></geometry>
    </collision></link></model>"""
MODEL = '<model name="a">{}</model>'
LINK = '<model name="a"><link name="l">{}</link></model>'
SHAPE = LINK.format('<{0} name="c"><geometry>{1}</geometry>{2}</{0}>')
BOX = "<box><size>1 1 1</size></box>"
JOINT = MODEL.format('<link name="l"/><joint name="j" type="revolute"><parent>world</parent>{}'
                     "</joint>")


@pytest.fixture
def load(tmp_path):
    """The description of a world with these contents and a model that is well."""
    def read(contents: str):
        file = tmp_path / "test.world"
        file.write_text(f'<sdf version="1.6"><world name="w">{contents}{OTHER}</world></sdf>')
        return load_world(file, Resources([tmp_path]))
    return read


def errors(caplog) -> list[str]:
    return [record.getMessage() for record in caplog.records if record.levelno == logging.ERROR]


@pytest.mark.parametrize("contents, said", [
    (MODEL.format("<pose>1 2 3 0 0</pose><link name='l'/>"),
     "model 'a' <pose>: '1 2 3 0 0' is not 6 numbers; 0 0 0 0 0 0 is used instead"),
    (MODEL.format("<pose>1 2 3</pose><link name='l'/>"), "'1 2 3' is not 6 numbers; 0 0 0 0 0 0"),
    (MODEL.format("<pose>1 2 abc 0 0 0</pose><link name='l'/>"), "is not 6 numbers; 0 0 0 0 0 0"),
    (SHAPE.format("visual", BOX, "<material><ambient>1 1</ambient></material>"),
     "visual 'c' <ambient>: '1 1' is not 4 numbers; 1 1 1 1 is used instead"),
    (SHAPE.format("collision", "<box><size>-1 1 1</size></box>", ""),
     "model 'a', link 'l', collision 'c' <box> <size>: -1 is negative; left out"),
    (SHAPE.format("visual", "<polyline><point>0 0</point><point>1 0</point></polyline>", ""),
     "<polyline>: an outline needs three <point>s or more; left out"),
    (SHAPE.format("collision", BOX, "<max_contacts>x</max_contacts><laser_retro>y</laser_retro>"),
     "<laser_retro>: 'y' is not a number; 0 is used instead"),
    (JOINT.format("<child>l</child><axis><xyz>0 0 0</xyz></axis>"),
     "joint 'j' <axis> <xyz>: the axis 0 0 0 has no direction; 0 0 1 is used instead"),
    (JOINT.format("<child>gone</child>"), "no child link named 'gone'; there are: l, world; left"),
    (LINK.format('<sensor name="s" type="ray"><update_rate>abc</update_rate></sensor>'),
     "sensor 's' <update_rate>: 'abc' is not a number; 0 is used instead"),
    ('<light name="x" type="point"><diffuse>red</diffuse></light>',
     "light 'x' <diffuse>: 'red' is not 4 numbers; 1 1 1 1 is used instead"),
    ("<gravity>down</gravity>", "<gravity>: 'down' is not 3 numbers; 0 0 -9.8 is used instead"),
    ("<scene><ambient>grey</ambient></scene>", "<scene> <ambient>: 'grey' is not 4 numbers"),
    ("<physics><max_step_size>fast</max_step_size></physics>", "0.001 is used instead"),
])
def test_one_wrong_value_costs_no_more_than_itself(load, caplog, contents, said):
    # conforms: SDF 1.2 to 1.7/values that cannot be read
    world = load(contents)
    (line,) = errors(caplog)
    assert "/test.world: " in line and said in line and "\n" not in line
    assert [model.name for model in world.models][-1] == "other"
    assert len(world.models) == 1 + contents.startswith("<model")
    opened = World(world)
    opened.step(3)
    opened.close()


@pytest.mark.parametrize("contents, said", [
    ("<model name='a'><static>1</static></model>", "model 'a': a model must have at least one"),
    ("<model><link name='l'/></model>", "a <model> has no name; left out"),
    ("<actor/>", "an <actor> has no name; left out"),
    ("<state><insertions><model name='a'/></insertions></state>", "model 'a': a model must have"),
])
def test_what_cannot_be_a_model_is_left_out(load, caplog, contents, said):
    assert [model.name for model in load(contents).models] == ["other"]
    (line,) = errors(caplog)
    assert said in line and line.endswith("; left out")


def test_a_line_names_the_file_that_is_included(load, caplog, tmp_path):
    (tmp_path / "m").mkdir()
    file = tmp_path / "m/model.sdf"
    file.write_text('<sdf><model name="m"><pose>x</pose><link name="l"/></model></sdf>')
    assert len(load("<include><uri>model://m</uri></include>" * 3).models) == 4
    assert errors(caplog) == [
        f"{file}: model 'm' <pose>: 'x' is not 6 numbers; 0 0 0 0 0 0 is used instead"]


def test_lines_are_bounded_in_number_and_begin_anew_with_each_load(load, caplog):
    many = "".join(f'<model name="m{n}"><pose>x</pose><link name="l"/></model>' for n in range(50))
    for _ in range(2):
        caplog.clear()
        load(many)
        said = errors(caplog)
        assert len(said) == mistakes.MOST_LINES + 1
        assert said[-1].startswith("and 30 more such lines, in ")


def test_a_line_of_a_huge_name_is_short_and_keeps_both_ends(load, caplog):
    load(f'<model name="{"x" * 100_000}"><pose>y</pose><link name="l"/></model>')
    (line,) = errors(caplog)
    assert len(line) < 600 and "test.world" in line and line.endswith("is used instead")


@pytest.mark.parametrize("contents", [
    "<include><uri>mod\n el://square</uri></include>",
    "<include><uri>model://square\u2028b</uri></include>", '<model name="a\x85b"/>'])
def test_a_name_of_two_lines_is_told_in_one(load, caplog, contents):
    load(contents)
    assert errors(caplog)
    assert all(len(line.splitlines()) == 1 for line in errors(caplog))


def test_a_file_without_a_world_is_still_refused(tmp_path):
    file = tmp_path / "x.world"
    for text, said in (("<sdf/>", "has no <world>"), ("<sdf>", "is not well-formed XML")):
        file.write_text(text)
        with pytest.raises(FormatError, match=said):
            load_world(file, Resources())


def test_the_name_a_model_is_spawned_with_is_enough():
    # conforms: /gazebo/spawn_sdf_model/model_name
    assert load_model("<sdf><model><link name='l'/></model></sdf>", Resources(), "n").name == "n"
    text = "<robot><link name='l'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' " \
           "iyy='1' iyz='0' izz='1'/></inertial></link></robot>"
    assert load_model(text, Resources(), "n").name == "n"


def test_a_model_that_the_engine_refuses_is_left_out_of_its_world(load, caplog, monkeypatch):
    def refuse(self, description, *_arguments):
        raise FormatError("it cannot be built")
    description = load(MODEL.format("<link name='l'/>"))
    monkeypatch.setattr(World, "spawn", refuse)
    World(description).close()
    assert errors(caplog) == ["model 'a': it cannot be built; left out",
                              "model 'other': it cannot be built; left out"]
