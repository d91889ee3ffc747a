"""The language of xacro: substitutions, macros, properties, conditions, includes."""

import pytest
from xacro_robots import ARGUMENT, SET, macro, names, one_link, written

from bullet_sim.formats.xacro.files import expand


@pytest.fixture
def write(tmp_path):
    """Writes a robot with this inside and returns its path."""
    return lambda inside, name="robot.xacro", **more: written(tmp_path / name, inside, **more)


@pytest.mark.parametrize("inside, name", [
    (one_link("$(find wheels)/x"), "/packages/wheels/x"),
    (one_link("$(arg n)", ARGUMENT), "3"),
    (one_link("$(eval n * 2)", ARGUMENT), "6"),
    (one_link("$(eval arg('n') + 1)", ARGUMENT), "4"),
    (one_link("$(eval round(max(sin(pi / 2), abs(-n))))", ARGUMENT), "3"),
    (one_link("$(eval find('wheels') + env('SET'))"), "/packages/wheelsyes"),
    (one_link("$(env SET)"), "yes"),
    (one_link("$(optenv SET no)$(optenv UNSET two words)$(optenv UNSET)"), "yestwo words"),
    (one_link("$${x} $$(y)"), "${x} $(y)"),
])
def test_substitutions(write, monkeypatch, inside, name):
    # conforms: xacro substitutions, xacro substitutions/$(find), xacro substitutions/$(arg)
    # conforms: xacro substitutions/$(eval), xacro substitutions/$(env)
    # conforms: xacro substitutions/$(optenv), xacro substitutions/$$
    monkeypatch.setenv("SET", "yes")
    monkeypatch.delenv("UNSET", raising=False)
    text = expand(write(inside), find_package=lambda package: f"/packages/{package}")
    assert names(text) == [name]


def test_places_and_anonymous_names(write, tmp_path, monkeypatch):
    # conforms: xacro substitutions/$(dirname), xacro substitutions/$(cwd)
    # conforms: xacro substitutions/$(anon)
    (tmp_path / "parts").mkdir()
    write(one_link("$(dirname)"), "parts/a.xacro")
    monkeypatch.chdir(tmp_path / "parts")
    include = '<xacro:include filename="parts/a.xacro"/>'
    inside = include + "".join(map(one_link, ["$(dirname)", "$(cwd)", "$(anon a)", "$(anon a)"]))
    found = names(expand(write(inside)))
    assert found[:3] == [f"{tmp_path}/parts", str(tmp_path), f"{tmp_path}/parts"]
    assert found[3] == found[4] and found[3].startswith("a_")


@pytest.mark.parametrize("inside, made", [
    (macro("a b", one_link("${a}${b}")) + '<xacro:m a="1" b="${1 + 1}"/>', ["12"]),
    (macro("a:=1 b=2", one_link("${a}${b}")) + '<xacro:m b="3"/>', ["13"]),
    (macro("a b=2", one_link("${a}${b}")) + '<xacro:m a="1"/>', ["12"]),
    (macro("a:='x y' b:=''", one_link("${a},${b}")) + "<xacro:m/>", ["x y,"]),
    (SET + macro("p:=^", one_link("${p}")) + "<xacro:m/>", ["9"]),
    (SET + macro("p:=^|5 q:=^|6", one_link("${p}${q}")) + "<xacro:m/>", ["96"]),
    (macro("*one", '<xacro:insert_block name="one"/>') + '<xacro:m><link name="b"/></xacro:m>',
     ["b"]),
    (macro("**all", '<xacro:insert_block name="all"/>')
     + '<xacro:m><box><link name="a"/><link name="b"/></box></xacro:m>', ["a", "b"]),
    (macro("*one *two", '<xacro:insert_block name="two"/><xacro:insert_block name="one"/>')
     + '<xacro:m><link name="a"/><link name="b"/></xacro:m>', ["b", "a"]),
    (macro("n", "<xacro:if value='${n > 0}'><link name='${n}'/><xacro:m n='${n - 1}'/></xacro:if>")
     + '<xacro:m n="3"/>', ["3", "2", "1"]),
    ("<xacro:macro name='o'>" + macro("", one_link("i")) + "<xacro:m/></xacro:macro><xacro:o/>",
     ["i"]),
    (macro("a", one_link("${a}")) + "<xacro:call macro=\"${'m'}\" a=\"1\"/>", ["1"]),
])
def test_macros(write, inside, made):
    # conforms: xacro macro, xacro macro/default :=, xacro macro/default =, xacro macro/default ^
    # conforms: xacro macro/default ^|, xacro macro/*block, xacro macro/**block
    # conforms: xacro macro/nested, xacro macro/recursive, xacro macro/xacro:call
    # conforms: xacro tags/insert_block
    text = expand(write(inside))
    assert names(text) == made
    assert "box" not in text


@pytest.mark.parametrize("inside, name", [
    ('<xacro:property name="q" value="${p + 1}"/>' + SET + one_link("${q}"), "10"),
    (SET + '<xacro:property name="q" value="${p}" lazy_eval="false"/>'
     '<xacro:property name="p" value="1"/>' + one_link("${q}"), "9"),
    (SET + '<xacro:property name="p" default="1"/><xacro:property name="q" default="2"/>'
     + one_link("${p}${q}"), "92"),
    (macro("", '<xacro:property name="p" value="1" scope="parent"/>') + "<xacro:m/>"
     + one_link("${p}"), "1"),
    ("<xacro:macro name='o'>" + macro("", '<xacro:property name="p" value="2" scope="global"/>')
     + "<xacro:m/></xacro:macro><xacro:o/>" + one_link("${p}"), "2"),
    (SET + macro("", '<xacro:property name="p" value="1"/>') + "<xacro:m/>" + one_link("${p}"),
     "9"),
    (SET + '<xacro:property name="p" remove="true"/><xacro:property name="p" default="4"/>'
     + one_link("${p}"), "4"),
    ('<xacro:property name="b"><link name="in"/></xacro:property>'
     '<xacro:insert_block name="b"/>', "in"),
])
def test_properties(write, inside, name):
    # conforms: xacro property, xacro property/lazy_eval, xacro property/default
    # conforms: xacro property/scope parent, xacro property/scope global, xacro property/remove
    # conforms: xacro property/block
    assert names(expand(write(inside))) == [name]


@pytest.mark.parametrize("inside, made", [
    ('<xacro:if value="true"><link name="a"/></xacro:if>'
     '<xacro:if value="0"><link name="b"/></xacro:if>', ["a"]),
    ("<xacro:unless value=\"${'x' == 'y'}\"><link name=\"a\"/></xacro:unless>"
     '<xacro:unless value="1"><link name="b"/></xacro:unless>', ["a"]),
    ("<xacro:element xacro:name=\"${'li' + 'nk'}\" name=\"a\"/>", ["a"]),
    ('<link><xacro:attribute name="name" value="${1 + 1}"/></link>', ["2"]),
])
def test_tags(write, inside, made):
    # conforms: xacro tags, xacro tags/if, xacro tags/unless, xacro tags/element
    # conforms: xacro tags/attribute
    assert names(expand(write(inside))) == made


def test_arguments_win_over_defaults(write):
    # conforms: xacro tags/arg, xacro command/NAME:=VALUE
    path = write('<xacro:arg name="colour" default="red"/><link name="$(arg colour)"/>')
    mappings = {"colour": "blue"}
    assert names(expand(path)) == ["red"]
    assert names(expand(path, mappings)) == ["blue"]
    assert mappings == {"colour": "blue"}


def test_includes(write, tmp_path):
    # conforms: xacro include, xacro include/ns, xacro include/optional, xacro include/glob
    write(SET + macro("", one_link("${p}")), "part_1.xacro")
    write(one_link("two"), "part_2.xacro")
    spaced = '<xacro:include filename="part_1.xacro" ns="k"/><xacro:k.m/>' + one_link("${k.p}")
    assert names(expand(write(spaced))) == ["9", "9"]
    globbed = '<xacro:include filename="part_*.xacro"/><xacro:m/>'
    assert names(expand(write(globbed))) == ["two", "9"]
    optional = '<xacro:include filename="none.xacro" optional="true"/><link name="a"/>'
    assert names(expand(write(optional))) == ["a"]


def test_includes_are_relative_to_the_including_file(write, tmp_path):
    (tmp_path / "parts").mkdir()
    write('<xacro:include filename="b.xacro"/>', "parts/a.xacro")
    write('<link name="b"/>', "parts/b.xacro")
    assert names(expand(write('<xacro:include filename="parts/a.xacro"/>'))) == ["b"]
