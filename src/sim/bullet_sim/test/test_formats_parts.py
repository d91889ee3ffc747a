"""Small readers against known numbers: noise, scaled shapes, bounds of xacro's expansion."""

import contextlib
import resource
from xml.etree import ElementTree

import pytest

from bullet_sim.description import (
    Box,
    Cylinder,
    Heightmap,
    ImageExtrusion,
    Mesh,
    Noise,
    Plane,
    Polyline,
    Sphere,
)
from bullet_sim.errors import FormatError
from bullet_sim.formats.sdf.sensor import read_imu
from bullet_sim.formats.sdf.shapes import scaled
from bullet_sim.formats.xacro import bounds, opening
from bullet_sim.formats.xacro.bounds import TooLarge, limit_memory, noted_eval, run_bounded
from bullet_sim.formats.xacro.files import expand

GYRO = Noise("gaussian", 0.1, 0.2, 0.3, 0.4)
ACCEL = Noise("gaussian", 1.0, 2.0)


def numbers(noise: Noise) -> str:
    return (f"<mean>{noise.mean}</mean><stddev>{noise.stddev}</stddev>"
            f"<bias_mean>{noise.bias_mean}</bias_mean><bias_stddev>{noise.bias_stddev}</bias_stddev>")


@pytest.mark.parametrize("kind, attribute", [("<type>gaussian</type>", ""),
                                             ("", ' type="gaussian"'), ("", "")])
def test_an_old_imu_has_one_noise_for_all_axes(kind, attribute):
    element = ElementTree.fromstring(
        f"<imu><noise{attribute}>{kind}<rate>{numbers(GYRO)}</rate>"
        f"<accel>{numbers(ACCEL)}</accel></noise></imu>")
    imu = read_imu(element, "sensor")
    assert imu.angular_velocity == (GYRO,) * 3
    assert imu.linear_acceleration == (ACCEL,) * 3


def test_an_imu_has_noise_by_axis():
    element = ElementTree.fromstring(
        "<imu><angular_velocity><y><noise type='gaussian'>"
        f"{numbers(GYRO)}</noise></y></angular_velocity></imu>")
    imu = read_imu(element, "sensor")
    assert imu.angular_velocity == (Noise(), GYRO, Noise())
    assert imu.linear_acceleration == (Noise(),) * 3


@pytest.mark.parametrize("shape, larger", [
    (Box((1.0, 1.0, 1.0)), Box((2.0, 3.0, 4.0))),
    (Cylinder(1.0, 1.0), Cylinder(3.0, 4.0)),
    (Sphere(1.0), Sphere(4.0)),
    (Mesh("a", scale=(1.0, 0.5, 2.0)), Mesh("a", scale=(2.0, 1.5, 8.0))),
    (Heightmap(None, (5.0, 5.0, 1.0)), Heightmap(None, (10.0, 15.0, 4.0))),
    (Polyline((((0.0, 0.0), (1.0, 2.0)),), 0.5), Polyline((((0.0, 0.0), (2.0, 6.0)),), 2.0)),
    (Plane((0, 0, 1), (1.0, 1.0)), Plane((0, 0, 1), (1.0, 1.0))),
    (ImageExtrusion("a"), ImageExtrusion("a"))])
def test_shapes_grow_along_their_own_axes(shape, larger):
    assert scaled(shape, (2.0, 3.0, 4.0)) == larger


# --- bounds of xacro

@pytest.fixture
def write(tmp_path):
    """Writes the inside of a robot to a file and returns its path."""

    def write_file(inside: str, name: str = "robot.xacro"):
        path = tmp_path / name
        path.write_text(
            f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{inside}</robot>')
        return path

    return write_file


def calls(count: int) -> str:
    return ('<xacro:macro name="m" params="n"><link name="${n}"/></xacro:macro>'
            + "".join(f'<xacro:m n="a{number}"/>' for number in range(count)))


@pytest.mark.parametrize("bound, said", [
    ("MOST_PARTS", "more than 10 macro calls, properties and conditions; do macros call"),
    ("MOST_TEXTS", "more than 10 attributes and texts; do macros repeat too much")])
def test_an_expansion_has_only_so_many_parts(write, monkeypatch, bound, said):
    path = write(calls(12))
    assert expand(path).count("<link") == 12
    monkeypatch.setattr(bounds, bound, 10)
    with pytest.raises(TooLarge, match=said):
        expand(path)


@pytest.mark.parametrize("most, refused", [(13, False), (12, True)])
def test_a_macro_and_each_call_of_it_is_a_part(write, monkeypatch, most, refused):
    path = write(calls(12))
    monkeypatch.setattr(bounds, "MOST_PARTS", most)
    with pytest.raises(TooLarge) if refused else contextlib.nullcontext():
        expand(path)


def test_only_so_many_files_are_included(write, monkeypatch):
    write("", "part.xacro")
    path = write('<xacro:include filename="part.xacro"/>' * 5)
    expand(path)
    monkeypatch.setattr(opening, "MOST_FILES", 3)
    with pytest.raises(TooLarge, match="more than 3 files are included; include each once"):
        expand(path)


def test_a_file_that_includes_itself_is_said(write):
    path = write('<xacro:include filename="robot.xacro"/>')
    with pytest.raises(FormatError, match="the file includes itself without end; put the"):
        expand(path)


def test_an_included_file_that_includes_itself_is_said(write):
    write('<xacro:include filename="other.xacro"/>', "other.xacro")
    path = write('<xacro:include filename="other.xacro"/>')
    with pytest.raises(FormatError, match=r"other\.xacro: the file includes itself without end"):
        expand(path)


def test_two_files_that_include_each_other_are_said(write):
    write('<xacro:include filename="robot.xacro"/>', "other.xacro")
    path = write('<xacro:include filename="other.xacro"/>')
    with pytest.raises(FormatError, match="include each other without end; remove one include"):
        expand(path)


@pytest.mark.parametrize("inside, said", [
    ("${xacro.load_yaml('missing.yaml')}", "missing.yaml does not exist"),
    ("${xacro.load_yaml('.')}", "cannot be read: ")])
def test_a_yaml_file_that_cannot_be_read_is_said(write, inside, said):
    with pytest.raises(FormatError, match=said):
        expand(write(f'<link name="{inside}"/>'))


def test_a_yaml_file_that_is_nested_too_deep_is_said(write, tmp_path, monkeypatch):
    def fail(_name):
        raise RecursionError  # as the parser does, after seconds, of a thousand brackets

    (tmp_path / "deep.yaml").write_text("[[]]")
    path = write("<link name=\"${xacro.load_yaml('deep.yaml')}\"/>")
    expand(path)
    monkeypatch.setattr(opening, "_xacros_load_yaml", fail)
    with pytest.raises(FormatError, match=r"deep\.yaml is nested too deep; flatten it"):
        expand(path)


@pytest.mark.parametrize("inside, said", [
    ("<xacro:arg name='a' default=''/><link name='$(arg b)'/>",
     "argument b has no value: pass b:=VALUE or give its xacro:arg a default"),
    ("<link name='$(env NOT_SET_HERE)'/>",
     r"type export NOT_SET_HERE=VALUE, or write \$\(optenv NOT_SET_HERE DEFAULT\)"),
    ("<other:link/>", "declare it in the <robot> tag, such as xmlns:xacro="),
    ("<link name='&nbsp;'/>", "write the entity's text where it is used"),
    ("<link name='${missing}'/>", "property 'missing' is not defined")])
def test_a_mistake_is_said_with_what_to_type(write, inside, said):
    with pytest.raises(FormatError, match=said):
        expand(write(inside))


def test_a_file_that_is_not_utf8_is_said(write):
    path = write("")
    path.write_bytes(path.read_bytes().replace(b"</robot>", b"<a b='\xe9'/></robot>"))
    with pytest.raises(FormatError, match="the file is not UTF-8, save it as UTF-8"):
        expand(path)


def test_an_expansion_of_its_own_process_gives_its_exit_code():
    assert run_bounded(lambda: 7, "a") == 7


def test_an_expansion_that_does_not_end_is_ended(write):
    path = write("<link name='${10 ** 10 ** 10}'/>")
    with pytest.raises(TooLarge, match=r"\$\{10 \*\* 10 \*\* 10\} takes longer than 0.3 s"):
        run_bounded(lambda: len(expand(path)), str(path), 0.3)


def test_what_took_the_time_is_no_expression_that_ended_before():
    def work():
        noted_eval(lambda *_: 1)("1", {})
        while True:
            pass

    with pytest.raises(TooLarge, match=r"^a: expanding it takes longer than 0.2 s"):
        run_bounded(work, "a", 0.2)


@pytest.mark.parametrize("error, said", [(ValueError("why"), True), (BrokenPipeError(), False)])
def test_an_expansion_that_fails_says_why_unless_nobody_reads_on(capfd, error, said):
    def fail():
        raise error

    assert run_bounded(fail, "a") == 1
    assert ("ValueError: why" in capfd.readouterr().err) == said


@pytest.mark.parametrize("given", [resource.RLIM_INFINITY, 10**6])
def test_an_expansion_gets_half_a_gigabyte_or_what_its_parent_may_have(monkeypatch, given):
    limits = []
    monkeypatch.setattr(resource, "getrlimit", lambda _: (0, given))
    monkeypatch.setattr(resource, "setrlimit", lambda _, both: limits.extend(both))
    limit_memory()
    assert limits[0] == limits[1]
    if given == resource.RLIM_INFINITY:
        assert 2**29 < limits[0] < 2**36
    else:
        assert limits[0] == given


def test_an_expansion_without_memory_is_said():
    def fail():
        raise MemoryError

    with pytest.raises(TooLarge, match=r"^a: expanding it needs more memory than there is; make"):
        run_bounded(fail, "a")
