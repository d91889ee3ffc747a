"""Xacro as Noetic, Melodic and older releases read it, and what the command does with mistakes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from random import Random
from xml.dom import minidom
from xml.etree import ElementTree

import pytest

import bullet_sim
from bullet_sim.errors import FormatError
from bullet_sim.formats.xacro import bounds as xacro_bounds
from bullet_sim.formats.xacro import opening as xacro_opening
from bullet_sim.formats.xacro.bounds import run_bounded
from bullet_sim.formats.xacro.expansion import Run, attempt
from bullet_sim.formats.xacro.files import expand, expand_file
from bullet_sim.formats.xacro.nodes import Siblings, replace_node

ROOT = Path(__file__).resolve().parents[5]
COMMAND = ROOT / "src/compat/xacro/xacro"
CORE = Path(bullet_sim.__file__).resolve().parents[1]
NAMESPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


@pytest.fixture
def write(tmp_path):
    """Writes a robot with this inside and returns its path."""
    def written(inside, name="robot.xacro", namespace=NAMESPACE):
        path = tmp_path / name
        path.write_text(f'<robot name="r" {namespace}>{inside}</robot>', encoding="utf-8")
        return path
    return written


def links(text):
    """The names of the links that came out."""
    return [element.get("name") for element in ElementTree.fromstring(text).iter("link")]


def one_link(expression, before=""):
    return f"{before}<link name=\"{expression}\"/>"


ARGUMENT = '<xacro:arg name="n" default="3"/>'


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
    assert links(text) == [name]


def test_places_and_anonymous_names(write, tmp_path, monkeypatch):
    # conforms: xacro substitutions/$(dirname), xacro substitutions/$(cwd)
    # conforms: xacro substitutions/$(anon)
    (tmp_path / "parts").mkdir()
    write(one_link("$(dirname)"), "parts/a.xacro")
    monkeypatch.chdir(tmp_path / "parts")
    include = '<xacro:include filename="parts/a.xacro"/>'
    inside = include + "".join(map(one_link, ["$(dirname)", "$(cwd)", "$(anon a)", "$(anon a)"]))
    found = links(expand(write(inside)))
    assert found[:3] == [f"{tmp_path}/parts", str(tmp_path), f"{tmp_path}/parts"]
    assert found[3] == found[4] and found[3].startswith("a_")


@pytest.mark.parametrize("expression, value", [
    ("${1 + 2 * 3}", "7"), ("${1 / 2}", "0.5"), ("${2 ** 3}", "8"), ("${not False}", "True"),
    ("${sin(pi / 2)}", "1.0"), ("${math.cos(0)}", "1.0"), ("${radians(180)}", "3.141592653589793"),
    ("${max(1, 2)} ${round(2.4)} ${len([1])}", "2 2 1"), ("${python.abs(-1)}", "1"),
    ("${[2 * x for x in [1, 2]][1]}", "4"), ("${dict(a=5)['a']}", "5"), ("${'a' + str(1)}", "a1"),
    ("${1 if 2 > 1 else 0}", "1"), ("a${1}b", "a1b"), ("${xacro.arg('n')}", "3"),
])
def test_expressions(write, expression, value):
    # conforms: xacro expressions, xacro expressions/arithmetic, xacro expressions/math
    # conforms: xacro expressions/lists and dicts, xacro expressions/python.*
    # conforms: xacro expressions/xacro.arg
    assert links(expand(write(one_link(expression, ARGUMENT)))) == [value]


@pytest.mark.parametrize("call", ["load_yaml", "xacro.load_yaml"])
def test_yaml(write, tmp_path, call):
    # conforms: xacro expressions/load_yaml, xacro expressions/xacro.load_yaml
    (tmp_path / "c.yaml").write_text("a: {b: [1, 2.5]}\nturn: !degrees 180\n")
    before = f"""<xacro:property name="c" value="${{{call}('c.yaml')}}"/>"""
    path = write(one_link("${c['a']['b'][1]} ${c.a.b[0]} ${round(c.turn, 2)}", before))
    assert links(expand(path)) == ["2.5 1 3.14"]
    assert str(tmp_path / "c.yaml") in expand_file(path).files


def macro(params, inside):
    return f"<xacro:macro name='m' params=\"{params}\">{inside}</xacro:macro>"


SET = '<xacro:property name="p" value="9"/>'


@pytest.mark.parametrize("inside, names", [
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
def test_macros(write, inside, names):
    # conforms: xacro macro, xacro macro/default :=, xacro macro/default =, xacro macro/default ^
    # conforms: xacro macro/default ^|, xacro macro/*block, xacro macro/**block
    # conforms: xacro macro/nested, xacro macro/recursive, xacro macro/xacro:call
    # conforms: xacro tags/insert_block
    text = expand(write(inside))
    assert links(text) == names
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
    assert links(expand(write(inside))) == [name]


@pytest.mark.parametrize("inside, names", [
    ('<xacro:if value="true"><link name="a"/></xacro:if>'
     '<xacro:if value="0"><link name="b"/></xacro:if>', ["a"]),
    ("<xacro:unless value=\"${'x' == 'y'}\"><link name=\"a\"/></xacro:unless>"
     '<xacro:unless value="1"><link name="b"/></xacro:unless>', ["a"]),
    ("<xacro:element xacro:name=\"${'li' + 'nk'}\" name=\"a\"/>", ["a"]),
    ('<link><xacro:attribute name="name" value="${1 + 1}"/></link>', ["2"]),
])
def test_tags(write, inside, names):
    # conforms: xacro tags, xacro tags/if, xacro tags/unless, xacro tags/element
    # conforms: xacro tags/attribute
    assert links(expand(write(inside))) == names


def test_arguments(write):
    # conforms: xacro tags/arg, xacro command/NAME:=VALUE
    path = write(one_link("$(arg n)", ARGUMENT))
    assert links(expand(path, {"n": "7"})) == ["7"] and links(expand(path)) == ["3"]


def test_includes(write, tmp_path):
    # conforms: xacro include, xacro include/ns, xacro include/optional, xacro include/glob
    write(SET + macro("", one_link("${p}")), "part_1.xacro")
    write(one_link("two"), "part_2.xacro")
    spaced = '<xacro:include filename="part_1.xacro" ns="k"/><xacro:k.m/>' + one_link("${k.p}")
    assert links(expand(write(spaced))) == ["9", "9"]
    globbed = '<xacro:include filename="part_*.xacro"/><xacro:m/>'
    assert links(expand(write(globbed))) == ["two", "9"]
    optional = '<xacro:include filename="none.xacro" optional="true"/><link name="a"/>'
    assert links(expand(write(optional))) == ["a"]


@pytest.mark.parametrize("namespace", [
    "http://www.ros.org/wiki/xacro", "http://ros.org/wiki/xacro", "http://wiki.ros.org/xacro",
    "http://www.ros.org/xacro", "anything"])
def test_every_namespace_ever_written(write, namespace):
    # conforms: xacro styles, xacro styles/old namespaces
    more = ('xmlns:controller="http://playerstage.sourceforge.net/gazebo/xmlschema/#controller" '
            f'xmlns:xacro="{namespace}"')
    assert links(expand(write(SET + one_link("${p}"), namespace=more))) == ["9"]


def test_old_files(write):
    # conforms: xacro styles/without prefix, xacro styles/used before defined
    old = """<property name="r" value="1"/><macro name="wheel" params="side *o">
        <link name="${side}"><insert_block name="o"/></link></macro>
        <wheel side="left"><origin/></wheel><if value="1"><link name="b"/></if>"""
    assert links(expand(write(old))) == ["left", "b"]
    called = macro("", one_link("c")) + '<xacro:call macro="xacro:m"/>'
    assert links(expand(write(called))) == ["c"]
    forward = '<xacro:m/><xacro:property name="p" value="${q}"/>' + macro("", one_link("${p}")) \
        + '<xacro:property name="q" value="5"/>'
    assert links(expand(write(forward))) == ["5"]
    write("<link name='${q}'/>", "part.gazebo")
    write(macro("", one_link("late")), "late.xacro")
    assert links(expand(write('<xacro:m/><xacro:include filename="late.xacro"/>'))) == ["late"]
    earlier = '<xacro:include filename="part.gazebo"/><xacro:property name="q" value="6"/>'
    assert links(expand(write(earlier))) == ["6"]


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
    assert links(text) == ["a"] and "<camera/>" in text


def doubling(levels):
    """2 ** levels links, by macros that call the next one twice."""
    calls = "".join(f'<xacro:macro name="m{i}"><xacro:m{i + 1}/><xacro:m{i + 1}/></xacro:macro>'
                    for i in range(levels))
    return f'{calls}<xacro:macro name="m{levels}"><link name="a"/></xacro:macro><xacro:m0/>'


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
])
def test_mistakes_are_one_line_soon(write, inside, said):
    # conforms: xacro mistakes, xacro mistakes/endless macros and includes
    # conforms: xacro mistakes/Python without builtins
    began = time.process_time()
    with pytest.raises(FormatError) as caught:
        expand(write(inside))
    message = str(caught.value)
    assert message.startswith(str(write(inside))) and said in message and "\n" not in message
    assert time.process_time() - began < 5


def test_macros_that_double(write, monkeypatch):
    # conforms: xacro mistakes/size of the result
    monkeypatch.setattr(xacro_bounds, "MOST_PARTS", 1000)
    assert len(links(expand(write(doubling(5))))) == 32
    with pytest.raises(FormatError, match="more than 1000 macro calls"):
        expand(write(doubling(25)))


def test_parts_that_come_too_often(write, monkeypatch):
    # conforms: xacro mistakes/size of the result
    monkeypatch.setattr(xacro_bounds, "MOST_TEXTS", 1000)
    with pytest.raises(FormatError, match="more than 1000 attributes and texts"):
        expand(write('<link name="a"/>' * 1001))
    monkeypatch.setattr(xacro_opening, "MOST_FILES", 10)
    part = write("", "part.xacro")
    assert expand(write(f'<xacro:include filename="{part}"/>' * 10))
    with pytest.raises(FormatError, match="more than 10 files are included"):
        expand(write(f'<xacro:include filename="{part}"/>' * 11))
    monkeypatch.setattr(xacro_opening, "LARGEST_FILE", 1000)
    part.write_text("<a>" + " " * 1000 + "</a>")
    with pytest.raises(FormatError, match=r"part.xacro cannot be read: 0 MB, more than 0; split"):
        expand(write(f'<xacro:include filename="{part}"/>'))


def test_the_time_grows_with_the_size_and_not_with_its_square():
    # conforms: xacro mistakes/size of the result
    document = minidom.parseString("<a>" + "<b/>" * 200_000 + "</a>")
    call = document.createElement("call")
    document.documentElement.insertBefore(call, document.documentElement.lastChild)
    body = minidom.parseString("<c>" + "<d/>" * 200_000 + "</c>").documentElement
    began = time.process_time()
    replace_node(call, by=body, content_only=True)
    assert time.process_time() - began < 5  # xacro's own takes minutes
    children = document.documentElement.childNodes
    assert len(children) == 400_000 and children[-2].tagName == "d" and not body.childNodes
    assert [child.nextSibling for child in children[:-1]] == children[1:]
    assert [child.previousSibling for child in children[1:]] == children[:-1]
    assert all(child.parentNode is document.documentElement for child in children)


def test_siblings_are_found_as_in_a_list(write):
    # conforms: xacro mistakes/size of the result
    root = attempt(Run(str(write("<link/>")), {}, None), {}).document.documentElement
    assert isinstance(root.childNodes, Siblings)
    plain = [object() for _ in range(1000)]
    near, random = Siblings(plain), Random(1)
    for _ in range(300):
        node = random.choice(plain)
        assert near.index(node) == plain.index(node)
        near.remove(node)
        plain.remove(node)
        assert near == plain
    with pytest.raises(ValueError):
        near.remove(object())


@pytest.mark.parametrize("inside", [
    '<xacro:include filename="{}"/>', "<link name=\"${{xacro.load_yaml('{}')}}\"/>"])
def test_what_is_no_file(write, tmp_path, inside):
    # conforms: xacro mistakes/no file
    signal.alarm(20)  # where a pipe is opened after all, the test ends
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to("loop")
    for name, reason in (("pipe", "it is a pipe"), ("loop", "Too many"), (".", "it is a folder")):
        path = tmp_path / name
        with pytest.raises(FormatError) as caught:
            expand(write(inside.format(path)))
        assert f"{path} cannot be read: {reason}" in str(caught.value)
    signal.alarm(0)


def test_yaml_too_deep(write, tmp_path):
    # conforms: xacro mistakes/no file
    (tmp_path / "deep.yaml").write_text("[" * 10_000)
    with pytest.raises(FormatError, match=r"deep.yaml is nested too deep; flatten it"):
        expand(write(one_link("${xacro.load_yaml('deep.yaml')}")))


def test_letters_and_entities(write):
    # conforms: xacro mistakes/not UTF-8, xacro mistakes/entity bombs
    path = write("")
    path.write_bytes(b"<robot name='r'><!-- \xd6\xd0 --></robot>")
    with pytest.raises(FormatError, match="not UTF-8, save it as UTF-8"):
        expand(path)
    bomb = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 20}">' for i in range(1, 12))
    path.write_text(f'<!DOCTYPE r [<!ENTITY e0 "aaaaaaaa">{bomb}]><robot name="r">&e11;</robot>')
    with pytest.raises(FormatError, match=r"amplification.*; write the entity's text where it is"):
        expand(path)


def test_expressions_that_do_not_end(write):
    # conforms: xacro mistakes/endless expressions
    path = write(one_link("${10 ** 10 ** 10}"))

    def work():
        expand(path)
        return 0

    with pytest.raises(FormatError, match=r"\$\{10 \*\* 10 \*\* 10\} takes longer than 0.3 s"):
        run_bounded(work, str(path), 0.3)
    assert run_bounded(lambda: 7, str(path)) == 7


def test_an_expression_is_blamed_only_for_its_own_time(write):
    # conforms: xacro mistakes/endless expressions
    path = write('<xacro:macro name="m"><link name="${1}"/></xacro:macro>' + "<xacro:m/>" * 10_000)

    def work():
        while True:
            expand(path)

    with pytest.raises(FormatError, match=f"^{path}: expanding it takes longer than 0.5 s"):
        run_bounded(work, str(path), 0.5)


def test_a_process_that_fails_does_not_do_so_in_silence(capfd):
    # conforms: xacro mistakes/size of the result
    def work(error):
        def fail():
            raise error
        return fail

    with pytest.raises(FormatError, match=r"^a: expanding it needs more memory than there is"):
        run_bounded(work(MemoryError()), "a")
    assert run_bounded(work(KeyError("mistake of ours")), "a") == 1
    assert "mistake of ours" in capfd.readouterr().err
    assert run_bounded(work(BrokenPipeError()), "a") == 1 and not capfd.readouterr().err


def run(folder, *words):
    environment = os.environ | {
        "PYTHONPATH": f"{CORE}{os.pathsep}{os.environ.get('PYTHONPATH', '')}"}
    return subprocess.run([sys.executable, COMMAND, *words], cwd=folder, env=environment,
                          text=True, capture_output=True, timeout=60)


def test_the_command(write, tmp_path):
    # conforms: xacro command, xacro command/-o, xacro command/--deps, xacro command/--inorder
    # conforms: xacro command/exit code 2, xacro command/NAME:=VALUE
    write(one_link("part"), "part.xacro")
    path = write('<xacro:include filename="part.xacro"/>' + one_link("$(arg n)", ARGUMENT)).name
    assert links(run(tmp_path, "--inorder", path, "n:=7").stdout) == ["part", "7"]
    written = run(tmp_path, path, "-o", "out/robot.urdf")
    assert written.returncode == 0 and links((tmp_path / "out/robot.urdf").read_text())
    assert run(tmp_path, "--deps", path).stdout.split() == ["part.xacro"]
    big = write(one_link("${len(str(1) * 10 ** 10)}")).name
    wrong = run(tmp_path, big)
    assert wrong.returncode == 2 and "needs more memory than there is" in wrong.stderr
    assert wrong.stderr.count("\n") == 1
