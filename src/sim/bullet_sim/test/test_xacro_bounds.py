"""Bounds of xacro: size, time, memory, and what is no file to read."""

import os
import signal
import time
from random import Random
from xml.dom import minidom

import pytest
from xacro_robots import names, one_link, written

from bullet_sim.errors import FormatError
from bullet_sim.formats.xacro import bounds as xacro_bounds
from bullet_sim.formats.xacro import opening as xacro_opening
from bullet_sim.formats.xacro.bounds import run_bounded
from bullet_sim.formats.xacro.expansion import Run, attempt
from bullet_sim.formats.xacro.files import expand
from bullet_sim.formats.xacro.nodes import Siblings, replace_node


@pytest.fixture
def write(tmp_path):
    """Writes a robot with this inside and returns its path."""
    return lambda inside, name="robot.xacro", **more: written(tmp_path / name, inside, **more)


def doubling(levels):
    """2 ** levels links, by macros that call the next one twice."""
    calls = "".join(f'<xacro:macro name="m{i}"><xacro:m{i + 1}/><xacro:m{i + 1}/></xacro:macro>'
                    for i in range(levels))
    return f'{calls}<xacro:macro name="m{levels}"><link name="a"/></xacro:macro><xacro:m0/>'


def test_macros_that_double(write, monkeypatch):
    # conforms: xacro mistakes/size of the result
    monkeypatch.setattr(xacro_bounds, "MOST_PARTS", 1000)
    assert len(names(expand(write(doubling(5))))) == 32
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
    document = minidom.parseString("<a>" + "<b/>" * 50_000 + "</a>")
    call = document.createElement("call")
    document.documentElement.insertBefore(call, document.documentElement.lastChild)
    body = minidom.parseString("<c>" + "<d/>" * 50_000 + "</c>").documentElement
    began = time.process_time()
    replace_node(call, by=body, content_only=True)
    assert time.process_time() - began < 2  # xacro's own takes minutes
    children = document.documentElement.childNodes
    assert len(children) == 100_000 and children[-2].tagName == "d" and not body.childNodes
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
    (tmp_path / "deep.yaml").write_text("[" * 2_000)
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


def test_a_bounded_process_may_bound_another_after_it_has_grown():
    def grow_and_bound() -> int:
        grown = bytearray(1 << 26)
        return run_bounded(lambda: len(grown) >> 24, "inner")

    assert run_bounded(grow_and_bound, "outer") == 4
