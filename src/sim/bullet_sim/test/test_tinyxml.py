"""What Gazebo's parser takes beyond XML is read, with one warning of file and line."""

import logging
import time

import pytest

from bullet_sim.errors import FormatError
from bullet_sim.formats import tinyxml
from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.tinyxml import as_xml
from bullet_sim.formats.xml_text import parse_xml
from bullet_sim.formats.xml_values import read_xml_file

LINK = '<link name="l"/>'


@pytest.mark.parametrize("text, path, value, advice", [
    ("<a>\n<b>R & D &nbsp;</b></a>", "b", "R & D &nbsp;", "line 2: write &amp; for &"),
    ("<a>\n\n<b x=block y='1'/></a>", "b@x", "block", 'line 3: write x="..." with quotes'),
    ("<a><b x=/></a>", "b@x", "", 'line 1: write x="..." with quotes'),
    ("<a><b x= >1</b></a>", "b", "1", 'line 1: write x="..." with quotes'),
    ("<a><b x='1'y='2'/></a>", "b@y", "2", "line 1: write a space between attributes"),
    ("<a><b x='1 < \"2\" & 3'/></a>", "b@x", '1 < "2" & 3',
     "line 1: write &lt; for <; line 1: write &amp; for &"),
    ("<!-- mine\n --><?xml version='1.0'?><a><b>1</b></a>", "b", "1",
     "line 2: move <?xml ...?> to the beginning"),
    ("<a>\n<!-- x -- y --><b>1</b></a>", "b", "1", "line 2: write no -- within a comment"),
    ("<a>\n<!------><b>1</b></a>", "b", "1", "line 2: write no -- within a comment"),
    ("<a><b>1</b></a>\n\nthe end", "b", "1", "line 3: remove what follows the root element"),
    ("<a><b>1</b></a></a>", "b", "1", "line 1: remove what follows the root element"),
    ("<a><b>1]]>2</b></a>", "b", "1]]>2", "line 1: write ]]&gt; for ]]>"),
    ("<a><b>1\x0c2</b></a>", "b", "1 2", "line 1: remove the control character"),
    ("<a><b>1</b><!u & v><>\n<3></a>", "b", "1", "line 1: write &lt; for <"),
    ("<a><b><![CDATA[1 & <2>]]></b> & </a>", "b", "1 & <2>", "line 1: write &amp; for &"),
    ("<a>\n&\n& <b>1</b><c\nx=2/> &</a> <!-- no & -->", "b", "1",
     'line 2: write &amp; for &; line 3: write x="..." with quotes'),
])
def test_tinyxmls_rules_in_one_warning(text, path, value, advice, caplog):
    tag, _, attribute = path.partition("@")
    found = parse_xml(text, "f.world").find(tag)
    assert (found.get(attribute) if attribute else found.text) == value
    assert [(record.levelno, record.getMessage()) for record in caplog.records] == [
        (logging.WARNING, f"f.world, {advice}; taken all the same, as by Gazebo")]


@pytest.mark.parametrize("text", [
    "<a><b></a>", "<a><b></B></a>", "<a x='1' x='2'/>", "<a x/>", "<a x=1'/>", "<a x='1/>", "<a",
    "x <a/>", "<a>1 < 2</a>", "<a><!-- </a>", "<a/ >", "< a/>", "&", "<a x=model://y/>",
])
def test_what_tinyxml_refuses_is_refused(text):
    with pytest.raises(FormatError, match=r"XML is not well-formed XML: .* at line 1"):
        parse_xml(text)


def test_well_formed_text_is_said_nothing_about(caplog):
    root = parse_xml("\ufeff\n<?xml version='1.0'?><!DOCTYPE a><?pi x & y?><!-- & --><a>&amp;"
                     "&#65;&#x42;<![CDATA[&]]></a><!-- & -->\n<?pi?>")
    assert root.text == "&AB&"
    assert not caplog.records


def test_entities_stay_refused_in_a_text_that_was_mended():
    text = '<!-- -- --><!DOCTYPE a [<!ENTITY e SYSTEM "/etc/passwd">]>\n<a>&e; & </a>'
    with pytest.raises(FormatError, match="the entity 'e' is declared"):
        parse_xml(text)


@pytest.mark.parametrize("part", [
    "<!--", "<a b='", "<a b='><a b=\"", "&", "<a", "<a b=1 ", "<a b=", "<", "<![CDATA[", "</a",
    "]]", "<a\n", "<a b='1'c='<' ", "<!", "<a>&</a>"])
def test_the_time_is_linear(part):
    text = "<a>" + part * (2_000_000 // len(part))
    began = time.process_time()
    as_xml(text)
    assert time.process_time() - began < 20  # hours, were it quadratic


def test_the_time_is_linear_in_different_attributes(monkeypatch):
    monkeypatch.setattr(tinyxml, "MOST_ADVICE", 200_000)
    text = "<a>" + "".join(f"\n<a b{n}=1/>" for n in range(100_000)) + "</a>"
    began = time.process_time()
    assert as_xml(text)[1].endswith('; line 100001: write b99999="..." with quotes')
    assert time.process_time() - began < 20  # 80 s, were the lines counted for each anew


def test_world_model_its_config_and_robot(tmp_path, caplog):
    model = tmp_path / "crate"
    model.mkdir()
    (model / "model.config").write_text(
        "<model><name>Crate</name>\n<description>nuts & bolts</description>"
        "<sdf version=1.6>model.sdf</sdf></model>")
    (model / "model.sdf").write_text(
        f"<!-- by me --><?xml version='1.0'?>\n<sdf version='1.6'><model name=crate>{LINK}</model>"
        "</sdf> thanks")
    world = tmp_path / "w.world"
    include = "<include><uri>model://crate</uri></include>"
    world.write_text("<sdf version='1.6'>\n<world name=w>" + include * 2 + "</world></sdf>")
    loaded = load_world(world, Resources([tmp_path]))
    assert loaded.models[0].name == "crate" and loaded.name == "w"
    said = [record.getMessage().replace(f"{tmp_path}/", "") for record in caplog.records
            if "taken all" in record.getMessage()]
    end = "; taken all the same, as by Gazebo"
    assert said == [
        f'w.world, line 2: write name="..." with quotes{end}',
        'crate/model.config, line 2: write &amp; for &; line 2: write version="..." with quotes'
        + end,
        'crate/model.sdf, line 1: move <?xml ...?> to the beginning; line 2: write name="..." with '
        f"quotes; line 2: remove what follows the root element{end}"]
    caplog.clear()
    mass = ("<inertial><mass value='1'/><inertia "
            "ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>")
    robot = f"<robot name=r><!-- a -- b --><link name='l'>{mass}</link></robot>"
    assert load_model(robot, Resources()).name == "r"
    assert caplog.messages == ['the text, line 1: write name="..." with quotes; line 1: write no '
                               f"-- within a comment{end}"]


def test_a_declared_encoding_after_a_comment_counts(tmp_path):
    file = tmp_path / "x.world"
    file.write_bytes('<!-- c --><?xml version="1.0" encoding="GBK"?><a>赛道</a>'.encode("gbk"))
    assert read_xml_file(file).text == "赛道"
