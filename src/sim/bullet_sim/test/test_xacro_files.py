"""xacro: strict files, Melodic's old style, $(find …), arguments, and one line for each mistake."""

import logging
import threading
from xml.etree import ElementTree

import pytest
import xacro

from bullet_sim.errors import FormatError
from bullet_sim.formats.xacro.files import expand, expand_file

NAMESPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'

OLD_STYLE = """
  <property name="half_track" value="0.2"/>
  <macro name="wheel" params="side sign">
    <link name="${side}_wheel"/>
    <joint name="${side}_joint" type="continuous">
      <origin xyz="0 ${sign * half_track} 0"/>
    </joint>
  </macro>
  <wheel side="left" sign="1"/>
  <wheel side="right" sign="-1"/>
  <if value="0"><link name="never"/></if>
"""


@pytest.fixture
def write(tmp_path):
    """Writes the inside of a robot to a file and returns its path."""

    def write_file(inside, name="robot.xacro"):
        path = tmp_path / name
        path.write_text(f'<robot name="r" {NAMESPACE}>{inside}</robot>', encoding="utf-8")
        return path

    return write_file


def names(text, tag):
    return [element.get("name") for element in ElementTree.fromstring(text).findall(tag)]


def test_prefixed_macros_properties_and_conditions(write):
    path = write(OLD_STYLE.replace("<", "<xacro:").replace("<xacro:/", "</xacro:")
                 .replace("xacro:link", "link").replace("xacro:joint", "joint")
                 .replace("xacro:origin", "origin"))
    text = expand(path)
    assert names(text, "link") == ["left_wheel", "right_wheel"]
    assert [o.get("xyz") for o in ElementTree.fromstring(text).iter("origin")] \
        == ["0 0.2 0", "0 -0.2 0"]


def test_old_style_without_prefix_as_melodic(write):
    text = expand(write(OLD_STYLE))
    assert names(text, "link") == ["left_wheel", "right_wheel"]
    assert names(text, "joint") == ["left_joint", "right_joint"]


def test_old_style_call_of_a_prefixed_macro(write):
    text = expand(write('<xacro:macro name="box"><link name="box"/></xacro:macro><box/>'))
    assert names(text, "link") == ["box"]


def test_old_style_macro_defined_by_a_macro_is_global(write):
    text = expand(write(
        '<macro name="outer"><macro name="inner"><link name="made"/></macro></macro>'
        "<outer/><inner/>"))
    assert names(text, "link") == ["made"]


def test_melodics_reading_is_dropped_when_names_clash(write, caplog):
    """<frame/> is an unknown tag; expanding it as a macro would make the link twice."""
    path = write('<xacro:macro name="frame"><link name="a"/></xacro:macro><xacro:frame/><frame/>')
    with caplog.at_level(logging.WARNING):
        text = expand(path)
    assert names(text, "link") == ["a"]
    assert "<frame> left" in caplog.text and str(path) in caplog.text


def test_a_tag_that_is_no_macro_is_kept_with_a_warning(write, caplog):
    path = write('<wheeel side="left"/><link name="a"/><group name="arm"/>')
    with caplog.at_level(logging.WARNING):
        text = expand(path)
    assert "<wheeel" in text and "<wheeel>" in caplog.text and "group" not in caplog.text


def test_before_melodic_macros_and_properties_counted_above_their_lines(write, caplog):
    with caplog.at_level(logging.WARNING):
        text = expand(write(
            '<xacro:wheel side="left"/><xacro:macro name="wheel" params="side">'
            '<link name="${side}_${part}"/></xacro:macro>'
            '<xacro:property name="part" value="rim"/>'))
    assert names(text, "link") == ["left_rim"]
    assert "define things before they are used" in caplog.text


def test_gazebos_include_is_not_xacros(write):
    inside = "<gazebo><include><uri>model://sun</uri></include></gazebo>"
    assert "model://sun" in expand(write(f'{inside}<property name="a" value="1"/>'))


def test_arguments_win_over_defaults(write):
    path = write('<xacro:arg name="colour" default="red"/><link name="$(arg colour)"/>')
    mappings = {"colour": "blue"}
    assert names(expand(path), "link") == ["red"]
    assert names(expand(path, mappings), "link") == ["blue"]
    assert mappings == {"colour": "blue"}


def test_find_asks_the_given_resolver(write, tmp_path):
    write('<link name="wheel"/>', "wheel.xacro")
    path = write('<xacro:include filename="$(find wheels)/wheel.xacro"/>')
    asked = []

    def find_package(name):
        asked.append(name)
        return str(tmp_path)

    expansion = expand_file(path, find_package=find_package)
    assert names(expansion.text, "link") == ["wheel"]
    assert set(asked) == {"wheels"}
    assert expansion.files == (f"{tmp_path}/wheel.xacro",)


def test_includes_are_relative_to_the_including_file(write, tmp_path):
    (tmp_path / "parts").mkdir()
    write('<xacro:include filename="b.xacro"/>', "parts/a.xacro")
    write('<link name="b"/>', "parts/b.xacro")
    assert names(expand(write('<xacro:include filename="parts/a.xacro"/>')), "link") == ["b"]


def test_a_missing_optional_include_is_skipped(write):
    path = write('<xacro:include filename="none.xacro" optional="true"/><link name="a"/>')
    assert names(expand(path), "link") == ["a"]


def test_same_input_same_text(write):
    path = write(OLD_STYLE)
    assert expand(path) == expand(path)


def test_text_beyond_ascii(write):
    assert names(expand(write('<link name="轮子"/>')), "link") == ["轮子"]


def unknown_package(name):
    raise LookupError(f"only wheels, no {name}")


@pytest.mark.parametrize(("inside", "said"), [
    ('<link name="${width}"/>', "property 'width' is not defined"),
    ('<link name="$(arg colour)"/>', "colour:=VALUE"),
    ('<xacro:include filename="none.xacro"/>', "none.xacro does not exist"),
    ('<xacro:include filename="$(find nowhere)/a.xacro"/>', "only wheels, no nowhere"),
    ("<xacro:wheel/>", "unknown macro name: xacro:wheel"),
    ('<xacro:if value="${1 +}"/>', "invalid syntax"),
    ('<link name="$(eval 1 +)"/>', "SyntaxError: "),
    ('<link name="${later}$(arg colour)"/><xacro:property name="colour" default="a"/>'
     '<xacro:property name="later" value="1"/>', "property 'later' is not defined"),
    ("<link", "XML error: "),
    ('<xacro:macro name="m" params="a"/><xacro:m/>', "Undefined parameters [a]"),
    ('<macro name="wheel" params="side"><link name="${sid}"/></macro><wheel side="left"/>',
     "macro wheel: property 'sid' is not defined"),
])
def test_a_mistake_is_one_line_with_file_and_reason(write, inside, said):
    path = write(inside)
    with pytest.raises(FormatError) as caught:
        expand(path, find_package=unknown_package)
    message = str(caught.value)
    assert message.startswith(str(path)) and said in message and "\n" not in message


def test_a_mistake_in_an_included_file_names_that_file(write, tmp_path):
    write('<link name="${width}"/>', "part.xacro")
    with pytest.raises(FormatError, match=r"^\S*part\.xacro: property 'width'"):
        expand(write('<xacro:include filename="part.xacro"/>'))


def test_a_missing_file(tmp_path):
    with pytest.raises(FormatError, match=r"^\S*none\.xacro does not exist$"):
        expand(tmp_path / "none.xacro")


def test_a_mistyped_file_is_answered_with_the_nearest(tmp_path):
    (tmp_path / "turtlebot.xacro").touch()
    with pytest.raises(FormatError, match=r"does not exist; did you mean turtlebot\.xacro\?$"):
        expand(tmp_path / "turtelbot.xacro")


def test_xacros_own_state_comes_back(write):
    before = {name: vars(xacro)[name] for name in ("parse", "warning", "filestack", "all_includes")}
    expand(write(OLD_STYLE))
    with pytest.raises(FormatError):
        expand(write("<xacro:wheel/>"))
    assert all(vars(xacro)[name] is value for name, value in before.items())


def test_threads_do_not_mix(write):
    paths = [write(f'<xacro:property name="n" value="{i}"/><link name="l${{n}}"/>', f"{i}.xacro")
             for i in range(8)]
    found = {}
    threads = [threading.Thread(target=lambda i=i: found.update({i: expand(paths[i])}))
               for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [names(found[i], "link") for i in range(8)] == [[f"l{i}"] for i in range(8)]


def test_warnings_go_to_the_log_not_the_terminal(write, caplog, capfd):
    with caplog.at_level(logging.WARNING):
        expand(write('<xacro:property name="pi" value="3"/><link name="a"/>'))
    assert "redefining global symbol: pi" in caplog.text
    assert capfd.readouterr() == ("", "")
