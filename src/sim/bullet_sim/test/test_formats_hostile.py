"""Texts that are broken on purpose: one clear line each, and little memory."""

import time
import tracemalloc

import pytest

from bullet_sim.errors import FormatError
from bullet_sim.formats import xml_text
from bullet_sim.formats.loading import MOST, load_model, load_world
from bullet_sim.formats.ogre import parse_script
from bullet_sim.formats.resources import DATA_FOLDER, Resources
from bullet_sim.formats.xml_text import LARGEST_TEXT
from bullet_sim.world import World

RESOURCES = Resources([DATA_FOLDER / "models"], [DATA_FOLDER])
MODEL = '<sdf version="1.6"><model name="m"><link name="l">{}</link></model></sdf>'
BOMB = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10 if n else "lol"}">' for n in range(10))


@pytest.mark.parametrize("text, message", [
    (f"<!DOCTYPE sdf [{BOMB}]><sdf>&e9;</sdf>", "line 1: the entity 'e0' is declared"),
    ('<!DOCTYPE sdf [<!ENTITY x SYSTEM "file:///etc/passwd">]><sdf>&x;</sdf>',
     "the entity 'x' is declared"),
    ("<sdf>" + "<model>" * 250, "nested more than 200 deep"),
    ('<sdf version="1.6"><model name="m"><link', "not well-formed XML: unclosed token"),
    ("", "is empty: there is no XML in it"),
    ("\x00\x01\x02", "not well-formed XML"),
])
def test_one_line_and_little_memory(text, message):
    # conforms: SDF 1.2 to 1.7/entities of one's own
    tracemalloc.start()
    with pytest.raises(FormatError) as raised:
        load_model(text, RESOURCES)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert message in str(raised.value)
    assert "\n" not in str(raised.value) and len(str(raised.value)) < 500
    assert peak < 300e6


@pytest.mark.parametrize("text, message", [
    (MODEL.format("<pose>nan 0 0 0 0 0</pose>"), "<pose>: 'nan 0 0 0 0 0' is not 6 numbers"),
    (MODEL.format("<pose>1e308 0 0 0 0 0</pose>"), "<pose>: 1e+308 is too large"),
    (MODEL.format("<pose>1,2,3,0,0,0</pose>"), "'1,2,3,0,0,0' is not 6 numbers"),
    (MODEL.format("<inertial><mass>1e300</mass></inertial>"), "<mass>: 1e+300 is too large"),
    (MODEL.format("<pose>" + "9 " * 100_000 + "</pose>"), "…' is not 6 numbers"),
    (MODEL.format('<collision name="c"><geometry><box><size>1 inf 1</size></box></geometry>'
                  "</collision>"), "'1 inf 1' is not finite"),
])
def test_a_number_that_is_none_is_one_short_error_line(text, message, caplog):
    load_model(text, RESOURCES)
    (record,) = caplog.records
    assert message in record.getMessage() and "is used instead" in record.getMessage()
    assert "\n" not in record.getMessage() and len(record.getMessage()) < 500


def test_comments_that_never_end_are_read_once():
    text = "material A { technique { pass { diffuse 1 0 0 } } }\n" + "/* " * 1_300_000
    began = time.process_time()
    assert list(parse_script(text)) == ["A"]
    assert time.process_time() - began < 5  # hours, were each /* looked after


def test_a_name_of_a_million_letters_is_one_short_line():
    robot = ('<robot name="r"><link name="base"/><joint name="j" type="fixed"><parent link="base"/>'
             f'<child link="{"x" * 1_000_000}"/></joint></robot>')
    with pytest.raises(FormatError) as raised:
        load_model(robot, RESOURCES)
    said = str(raised.value)
    assert len(said) < 1000 and said.startswith("joint 'j': child link 'xxx")
    assert said.endswith("not found; the links are: base")


def test_an_unknown_element_of_the_root_says_where_it_is(caplog):
    load_model(MODEL.format("").replace("</sdf>", "<lamp/></sdf>"), RESOURCES)
    assert [record.getMessage() for record in caplog.records] == [
        "<sdf>: <lamp> is not known, left out"]


def test_the_number_of_elements_is_bounded(monkeypatch):
    monkeypatch.setattr(xml_text, "MOST_ELEMENTS", 1000)
    with pytest.raises(FormatError, match="line 1: more than 1000 elements; split the file"):
        load_model("<a>" + "<b/>" * 2000 + "</a>", RESOURCES)


def test_a_huge_file_is_not_read(tmp_path):
    huge = tmp_path / "huge.world"
    with huge.open("wb") as file:
        file.truncate(LARGEST_TEXT + 1)
    with pytest.raises(FormatError, match=r"huge\.world is too large: 32 MiB, more than 32"):
        load_world(huge, RESOURCES)


@pytest.mark.parametrize("content, name", [
    (b"\xef\xbb\xbf" + '<sdf><world name="赛道"/></sdf>'.encode(), "赛道"),
    ('<sdf><world name="赛道"/></sdf>'.encode("utf-16"), "赛道"),
    ('<?xml version="1.0" encoding="GBK"?><sdf><world name="赛道"/></sdf>'.encode("gbk"), "赛道"),
    (b'<?xml version="0.0" ?>\n<sdf><world name="w"/></sdf>', "w"),
    (b'<?xml version="1.0" encoding="nonsense"?><sdf><world name="w"/></sdf>', "w"),
    ('<?xml version="1.0" encoding="utf-8"?><sdf><world name="w\xe9"/></sdf>'.encode("latin-1"),
     "w\ufffd"),
])
def test_encodings(tmp_path, content, name):
    # conforms: SDF 1.2 to 1.7/encodings
    file = tmp_path / "x.world"
    file.write_bytes(content)
    assert load_world(file, RESOURCES).name == name


def test_a_folder_or_a_locked_file_is_one_line(tmp_path, monkeypatch):
    file = tmp_path / "x.world"
    file.write_text("<sdf/>")
    def locked(_self):
        raise PermissionError(13, "Permission denied")
    monkeypatch.setattr(type(file), "read_bytes", locked)
    with pytest.raises(FormatError, match=r"x\.world cannot be read: Permission denied"):
        load_world(file, RESOURCES)


@pytest.mark.parametrize("tag", sorted(MOST))
def test_more_of_one_kind_than_can_be_simulated_is_one_line(tmp_path, tag):
    text = f"<sdf><world name='w'>{f'<{tag}/>' * (MOST[tag] + 1)}</world></sdf>"
    world = tmp_path / "w.world"
    world.write_text(text)
    said = f"has {MOST[tag] + 1} elements <{tag}>; at most {MOST[tag]} can be simulated"
    with pytest.raises(FormatError, match=f"w.world {said}"):
        load_world(world, RESOURCES)
    with pytest.raises(FormatError, match=f"the text {said}"):
        load_model(text, RESOURCES)


INCLUDE = "<include><uri>model://unit_box</uri><name>b{}</name><static>1</static></include>"


@pytest.mark.parametrize("part, around", [
    ("<model name='m{}'><link name='l'/></model>", "{}"),
    ("<model name='m'><link name='l'/></model>", "{}"),
    ("<link name='l{}'/>", "<model name='m'>{}</model>"),
    ("<model name='m{}'><link name='l'/></model>", "<model name='m'><link name='l'/>{}</model>"),
    ("<link name='l{0}'/><joint name='j{0}' type='fixed'><parent>world</parent><child>l{0}</child>"
     "</joint>", "<model name='m'>{}</model>"),
    ("<visual name='v{}'><geometry><sphere/></geometry></visual>",
     "<model name='m'><link name='l'>{}</link></model>"),
    ("<collision name='v{}'><geometry><sphere/></geometry></collision>",
     "<model name='m'><link name='l'>{}</link></model>"),
    (INCLUDE, "{}")])
def test_a_world_takes_a_time_in_proportion_to_its_size(tmp_path, part, around):
    file = tmp_path / "w.world"

    def seconds(count: int) -> float:
        parts = "".join(part.format(n) for n in range(count))
        file.write_text(f"<sdf version='1.6'><world name='w'>{around.format(parts)}</world></sdf>")
        began = time.process_time()
        world = World(load_world(file, RESOURCES))
        world.step(5)
        world.close()
        return time.process_time() - began

    seconds(10)  # what is read only once
    # 4 times in proportion, 16 by the square. Once more where another process was in the way.
    assert any(seconds(400) < 8 * max(seconds(100), 0.03) for _ in range(3))
