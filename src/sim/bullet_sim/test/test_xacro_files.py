"""xacro's files: old and new style, the packages they name, one line for each mistake."""

import logging
import threading
import time

import pytest
import xacro
from xacro_robots import SET, macro, names, one_link, written

from bullet_sim.errors import FormatError
from bullet_sim.formats.xacro.files import expand, expand_file

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
    """Writes a robot with this inside and returns its path."""
    return lambda inside, name="robot.xacro", **more: written(tmp_path / name, inside, **more)


@pytest.mark.parametrize("namespace", [
    "http://www.ros.org/wiki/xacro", "http://ros.org/wiki/xacro", "http://wiki.ros.org/xacro",
    "http://www.ros.org/xacro", "anything"])
def test_every_namespace_ever_written(write, namespace):
    # conforms: xacro styles, xacro styles/old namespaces
    more = ('xmlns:controller="http://playerstage.sourceforge.net/gazebo/xmlschema/#controller" '
            f'xmlns:xacro="{namespace}"')
    assert names(expand(write(SET + one_link("${p}"), namespace=more))) == ["9"]


def test_old_style_without_prefix_as_melodic(write):
    # conforms: xacro styles/without prefix
    text = expand(write(OLD_STYLE))
    assert names(text) == ["left_wheel", "right_wheel"]
    assert names(text, "joint") == ["left_joint", "right_joint"]


def test_old_style_call_of_a_prefixed_macro(write):
    text = expand(write('<xacro:macro name="box"><link name="box"/></xacro:macro><box/>'))
    assert names(text) == ["box"]


def test_old_style_macro_defined_by_a_macro_is_global(write):
    text = expand(write(
        '<macro name="outer"><macro name="inner"><link name="made"/></macro></macro>'
        "<outer/><inner/>"))
    assert names(text) == ["made"]


def test_old_ways_inside_of_links_and_joints(write):
    # conforms: xacro styles/without prefix
    text = expand(write("""
        <xacro:macro name="hinge" params="*o"><joint name="j"><insert_block name="o"/></joint>
        </xacro:macro><xacro:macro name="own"><inertial><mass value="2"/></inertial></xacro:macro>
        <xacro:hinge><origin xyz="1 2 3"/></xacro:hinge>
        <link name="a"><own/><if value="0"><visual/></if></link>"""))
    assert '<origin xyz="1 2 3"/>' in text and '<mass value="2"/>' in text
    assert "insert_block" not in text and "visual" not in text


def test_a_macro_named_as_a_tag_of_sdf_is_not_called_by_it(write):
    # conforms: xacro styles/without prefix
    text = expand(write("""<xacro:macro name="camera"><link name="a"/></xacro:macro>
        <xacro:camera/><gazebo reference="a"><sensor name="s"><camera/></sensor></gazebo>"""))
    assert names(text) == ["a"] and "<camera/>" in text


def test_melodics_reading_is_dropped_when_names_clash(write, caplog):
    """<frame/> is an unknown tag; expanding it as a macro would make the link twice."""
    path = write('<xacro:macro name="frame"><link name="a"/></xacro:macro><xacro:frame/><frame/>')
    with caplog.at_level(logging.WARNING):
        text = expand(path)
    assert names(text) == ["a"]
    assert "<frame> left" in caplog.text and str(path) in caplog.text


def test_a_tag_that_is_no_macro_is_kept_with_a_warning(write, caplog):
    path = write('<wheeel side="left"/><link name="a"/><group name="arm"/>')
    with caplog.at_level(logging.WARNING):
        text = expand(path)
    assert "<wheeel" in text and "<wheeel>" in caplog.text and "group" not in caplog.text


def test_before_melodic_macros_and_properties_counted_above_their_lines(write, caplog):
    # conforms: xacro styles/used before defined
    with caplog.at_level(logging.WARNING):
        text = expand(write(
            '<xacro:wheel side="left"/><xacro:macro name="wheel" params="side">'
            '<link name="${side}_${part}"/></xacro:macro>'
            '<xacro:property name="part" value="rim"/>'))
    assert names(text) == ["left_rim"]
    assert "define things before they are used" in caplog.text


def test_macros_that_are_included_or_called_in_old_ways(write):
    # conforms: xacro styles/used before defined
    called = macro("", one_link("c")) + '<xacro:call macro="xacro:m"/>'
    assert names(expand(write(called))) == ["c"]
    write("<link name='${q}'/>", "part.gazebo")
    write(macro("", one_link("late")), "late.xacro")
    assert names(expand(write('<xacro:m/><xacro:include filename="late.xacro"/>'))) == ["late"]
    earlier = '<xacro:include filename="part.gazebo"/><xacro:property name="q" value="6"/>'
    assert names(expand(write(earlier))) == ["6"]


def test_gazebos_include_is_not_xacros(write):
    inside = "<gazebo><include><uri>model://sun</uri></include></gazebo>"
    assert "model://sun" in expand(write(f'{inside}<property name="a" value="1"/>'))


def test_find_asks_the_given_resolver(write, tmp_path):
    write('<link name="wheel"/>', "wheel.xacro")
    path = write('<xacro:include filename="$(find wheels)/wheel.xacro"/>')
    asked = []

    def find_package(name):
        asked.append(name)
        return str(tmp_path)

    expansion = expand_file(path, find_package=find_package)
    assert names(expansion.text) == ["wheel"]
    assert set(asked) == {"wheels"}
    assert expansion.files == (f"{tmp_path}/wheel.xacro",)


def test_same_input_same_text(write):
    path = write(OLD_STYLE)
    assert expand(path) == expand(path)


def test_text_beyond_ascii(write):
    assert names(expand(write('<link name="轮子"/>'))) == ["轮子"]


def unknown_package(name):
    raise LookupError(f"only wheels, no {name}")


@pytest.mark.parametrize("inside, said", [
    (macro("", "<xacro:m/>") + "<xacro:m/>", "call each other without end"),
    ('<xacro:include filename="robot.xacro"/>', "includes itself without end"),
    ("<xacro:property name='p' value='${p}'/>" + one_link("${p}"), "circular variable definition"),
    ("<a>" * 3000 + "</a>" * 3000, "nested too deep"),
    (one_link("${().__class__}"), "invalid name"), (one_link("${open('x')}"), "'open' is not"),
    (one_link("$(eval open('x', 'w'))"), "$(eval …): argument 'open' is not defined"),
    (one_link("${xacro.arg('m')}"), "argument m has no value: pass m:=VALUE"),
    (one_link("$(env MISSING)"), "'MISSING' is not set; type export MISSING=VALUE"),
    ("<foo:bar/>", 'declare it in the <robot> tag, such as xmlns:xacro="http'),
    ("<xacro:none/>", 'include the file with <xacro:macro name="none">'),
    (one_link("${p"), "invalid expression: ${p"), (one_link("${1 / 0}"), "division by zero"),
    ('<xacro:if value="maybe"/>', "not a boolean"), ('<xacro:property value="1"/>', "'name'"),
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
def test_mistakes_are_one_line_soon(write, inside, said):
    # conforms: xacro mistakes, xacro mistakes/endless macros and includes
    # conforms: xacro mistakes/Python without builtins
    began = time.process_time()
    with pytest.raises(FormatError) as caught:
        expand(write(inside), find_package=unknown_package)
    message = str(caught.value)
    assert message.startswith(str(write(inside))) and said in message and "\n" not in message
    assert time.process_time() - began < 5


def test_a_mistake_in_an_included_file_names_that_file(write, tmp_path):
    write('<link name="${width}"/>', "part.xacro")
    with pytest.raises(FormatError, match=r"^\S*part\.xacro: property 'width'"):
        expand(write('<xacro:include filename="part.xacro"/>'))


def test_a_missing_file(tmp_path):
    with pytest.raises(FormatError, match=r"^\S*none\.xacro does not exist$"):
        expand(tmp_path / "none.xacro")


def test_a_mistyped_file_is_answered_with_the_nearest(tmp_path):
    (tmp_path / "turtlebot.xacro").touch()
    with pytest.raises(FormatError, match=r"does not exist \(did you mean turtlebot\.xacro\?\)$"):
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
    assert [names(found[i]) for i in range(8)] == [[f"l{i}"] for i in range(8)]


def test_warnings_go_to_the_log_not_the_terminal(write, caplog, capfd):
    with caplog.at_level(logging.WARNING):
        expand(write('<xacro:property name="pi" value="3"/><link name="a"/>'))
    assert "redefining global symbol: pi" in caplog.text
    assert capfd.readouterr() == ("", "")
