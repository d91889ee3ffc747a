"""Robots, worlds and launch files that name a spoilt part: a mesh, image, parameter file, model.

Each function of `PARTS` writes its files into a folder and returns the one to check.
"""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

MANY = 4_000_000_000
DEEP = 10_000
Case = Callable[[Path], Path]
PARTS: dict[str, Case] = {}

ROBOT = """<robot name="r"><link name="base"><inertial><mass value="1"/><inertia ixx="1" ixy="0"
 ixz="0" iyy="1" iyz="0" izz="1"/></inertial>{0}</link></robot>"""
WORLD = '<sdf version="1.6"><world name="w">{0}</world></sdf>'
MODEL = '<model name="m"><link name="l">{0}</link></model>'
GEOMETRY = "<visual name='v'><geometry>{0}</geometry></visual>"
BOTH = ("<collision name='c'><geometry>{0}</geometry></collision>" + GEOMETRY)
SURFACE = ("<visual name='v'><geometry><box><size>1 1 1</size></box></geometry>"
           "<material>{0}</material></visual>")
NAMESPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
YAML_BOMB = "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{chr(97 + n)}: &{chr(97 + n)} [{', '.join([f'*{chr(96 + n)}'] * 9)}]\n" for n in range(1, 10))


def parts(kind: str, makers: dict[str, Callable[[Path], object]],
          whole: Callable[[Path], tuple[str, str]]) -> None:
    """A case for each way to make a part; `whole` gives name and text of what names the part."""
    for name, make in makers.items():
        def write(folder: Path, make: Callable = make, name: str = name) -> Path:
            part = folder / name
            make(part)
            file, text = whole(part)
            (folder / file).write_text(text, encoding="utf-8")
            return folder / file

        PARTS[f"{kind} {name}"] = write


def holding(content: bytes | str) -> Callable[[Path], object]:
    """Writes this."""
    data = content.encode() if isinstance(content, str) else content
    return lambda path: path.write_bytes(data)


def loop(path: Path) -> None:
    """A link that leads to itself."""
    path.symlink_to(path.name)


def folder_in_its_place(path: Path) -> None:
    """A folder where a file should be."""
    path.mkdir()


def png(width: int, height: int, rows: int = 1, depth: int = 8) -> bytes:
    """An image that says this size and holds `rows` rows of grey."""
    def chunk(kind: bytes, data: bytes) -> bytes:
        checksum = struct.pack(">I", zlib.crc32(kind + data))
        return struct.pack(">I", len(data)) + kind + data + checksum

    header = struct.pack(">IIBBBBB", width, height, depth, 0, 0, 0, 0)
    pixels = zlib.compress(bytes((width * depth // 8 + 1) * rows))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels)
            + chunk(b"IEND", b""))


def stl(count: int, triangles: int) -> bytes:
    """Says `count` triangles and has fewer."""
    return bytes(80) + struct.pack("<I", count) + bytes(50 * triangles)


def collada(inside: str, before: str = "") -> str:
    return (f'<?xml version="1.0"?>{before}<COLLADA version="1.4.1" '
            f'xmlns="http://www.collada.org/2005/11/COLLADASchema">{inside}</COLLADA>')


NO_FILES = {"folder": folder_in_its_place, "loop": loop, "fifo": os.mkfifo}


def _no_files(ending: str) -> dict[str, Callable[[Path], object]]:
    return {f"{name}{ending}": make for name, make in NO_FILES.items()}


MESHES = {
    "many.stl": holding(stl(MANY, 1)), "header.stl": holding(bytes(80)),
    "few.stl": holding(stl(100, 99)), "none.stl": holding(stl(0, 0)),
    "nan.stl": holding(bytes(80) + struct.pack("<I", 1) + struct.pack("<12f", *[float("nan")] * 12)
                       + bytes(2)),
    "huge.stl": holding(bytes(80) + struct.pack("<I12f2x", 1, *[3e38, -3e38, 1e38] * 4)),
    "open.stl": holding("solid a\n facet normal 0 0 1\n outer loop\n vertex 0 0"),
    "words.stl": holding("solid a\n facet normal x y z\n outer loop\n vertex a b c\n" * 1000),
    "broken.obj": holding("v 1 2\nv a b c\nf 1 2 3\nf 1//9999999999 -5 7\nf\nmtllib broken.obj\n"),
    "far.obj": holding("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4000000000\nf -1 -2 -4000000000\n"),
    "huge.obj": holding("v 0 0 0\nv 1e308 0 0\nv 0 1e400 nan\nf 1 2 3\n"),
    "polygon.obj": holding("v 0 0 0\nv 1 0 0\nv 0 1 0\nf " + "1 2 3 " * 200_000 + "\n"),
    "noise.obj": holding(bytes(range(256)) * 400),
    "empty.dae": holding(""), "nothing.dae": holding(collada("")),
    "cut.dae": holding(collada("<library_geometries><geometry id='g'><mesh>")[:-20]),
    "bomb.dae": holding(collada("<asset>&b;</asset>", "<!DOCTYPE a [<!ENTITY a 'aaaaaaaaaa'>"
                                "<!ENTITY b '&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;'>]>")),
    "counts.dae": holding(collada(
        "<library_geometries><geometry id='g'><mesh><source id='s'><float_array id='a' "
        f"count='{MANY}'>0 0 0</float_array><technique_common><accessor source='#a' "
        f"count='{MANY}' stride='{MANY}'/></technique_common></source><vertices id='v'><input "
        "semantic='POSITION' source='#s'/></vertices><triangles count='4000000000'><input "
        "semantic='VERTEX' source='#v' offset='0'/><p>0 1 9999999</p></triangles></mesh>"
        "</geometry></library_geometries><library_visual_scenes><visual_scene id='z'><node>"
        "<instance_geometry url='#g'/></node></visual_scene></library_visual_scenes><scene>"
        "<instance_visual_scene url='#z'/></scene>")),
    "circle.dae": holding(collada(
        "<library_nodes><node id='n'><instance_node url='#n'/></node></library_nodes>"
        "<library_visual_scenes><visual_scene id='z'><node><instance_node url='#n'/></node>"
        "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#z'/>"
        "</scene>")),
    "deep.dae": holding(collada("<node>" * DEEP + "</node>" * DEEP)),
    "noise.dae": holding(bytes(range(256)) * 400), "unknown.xyz": holding("1 2 3"),
    **_no_files(".stl"), **_no_files(".dae"), **_no_files(".obj"),
}
parts("mesh", MESHES, lambda part: ("robot.urdf", ROBOT.format(
    BOTH.format(f'<mesh filename="file://{part}"/>'))))

IMAGES = {
    "wide.png": holding(png(30_000, 30_000)), "whole.png": holding(png(20_000, 20_000, 20_000)),
    "cut.png": holding(png(64, 64)[:60]), "rows.png": holding(png(65, 65, 3)),
    "nothing.png": holding(b""), "zero.png": holding(png(0, 0)), "text.png": holding("no image"),
    "one.png": holding(png(1, 1)), "line.png": holding(png(100_000, 2, 2)), **_no_files(".png"),
}
parts("heightmap", IMAGES, lambda part: ("robot.world", WORLD.format(MODEL.format(BOTH.format(
    f"<heightmap><uri>file://{part}</uri><size>9 9 1</size></heightmap>")))))
parts("image", IMAGES, lambda part: ("robot.world", WORLD.format(MODEL.format(BOTH.format(
    f"<image><uri>file://{part}</uri><scale>1</scale><threshold>9</threshold><height>1</height>"
    "<granularity>1</granularity></image>")))))
parts("texture", IMAGES, lambda part: ("robot.world", WORLD.format(MODEL.format(SURFACE.format(
    f"<pbr><metal><albedo_map>file://{part}</albedo_map></metal></pbr>")))))


def _textured(part: Path) -> tuple[str, str]:
    mesh = part.with_name("m.obj")
    mesh.write_text("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n")
    part.with_name("m.mtl").write_text(f"newmtl a\nmap_Kd {part.name}\n")
    return "robot.urdf", ROBOT.format(BOTH.format(f'<mesh filename="file://{mesh}"/>'))


parts("texture of a mesh", IMAGES, _textured)
SCRIPTS = {
    "open.material": holding("material A { technique { pass {"),
    "deep.material": holding("material A " + "{ technique " * DEEP),
    "parent.material": holding("material A : B {}\nmaterial B : A {}\n"),
    "noise.material": holding(bytes(range(256)) * 400), **_no_files(".material"),
}
parts("material", SCRIPTS, lambda part: ("robot.world", WORLD.format(MODEL.format(SURFACE.format(
    f"<script><uri>file://{part}</uri><name>A</name></script>")))))

YAMLS = {
    "bomb.yaml": holding(YAML_BOMB), "open.yaml": holding("a: [1, 2"),
    "tab.yaml": holding("a:\n\tb: 1"), "object.yaml": holding("a: !!python/object:os.x {}"),
    "list.yaml": holding("[1, 2]"), "word.yaml": holding("word"), "empty.yaml": holding(""),
    "deep.yaml": holding("[" * DEEP), "latin.yaml": holding(b"a: \xe9"),
    "self.yaml": holding("a: &a [*a]"), "keys.yaml": holding("{1: 2, [a]: b, null: 3}"),
    **_no_files(".yaml"),
}
parts("rosparam", YAMLS, lambda part: (
    "a.launch", f'<launch><rosparam file="{part}" command="load"/></launch>'))
parts("textfile", {"latin.yaml": YAMLS["latin.yaml"], **_no_files(".yaml")}, lambda part: (
    "a.launch", f'<launch><param name="robot_description" textfile="{part}"/>'
    '<node name="s" pkg="gazebo_ros" type="spawn_model" args="-urdf -param robot_description'
    ' -model r"/></launch>'))
parts("load_yaml", YAMLS, lambda part: (
    "a.xacro", f'<robot name="r" {NAMESPACE}><xacro:property name="p" '
    f'value="${{load_yaml(\'{part}\')}}"/><link name="${{p}}"/></robot>'))

XACROS = {
    "circle.xacro": holding(f'<a {NAMESPACE}><xacro:include filename="a.xacro"/></a>'),
    "empty.xacro": holding(""), "text.xacro": holding("no xml"),
    "utf16.xacro": holding("<?xml version='1.0' encoding='utf-16'?><a/>".encode("utf-16")),
    "nul.xacro": holding(b"<a>\0</a>"), "latin.xacro": holding(b"<a b='\xe9'/>"),
    "big.xacro": holding("<a>" + "<b/>" * 3_000_000 + "</a>"),
    **_no_files(".xacro"),
}
parts("xacro include", XACROS, lambda part: (
    "a.xacro", f'<robot name="r" {NAMESPACE}><xacro:include filename="{part}"/></robot>'))
LAUNCHES = {
    "circle.launch": holding('<launch><include file="$(dirname)/a.launch"/></launch>'),
    "empty.launch": holding(""), "text.launch": holding("no xml"),
    "utf16.launch": holding("<launch/>".encode("utf-16")), "nul.launch": holding(b"<launch>\0"),
    "world.launch": holding(WORLD.format("")),
    "deep.launch": holding("<launch>" + "<group>" * DEEP + "</group>" * DEEP + "</launch>"),
    **_no_files(".launch"),
}
parts("launch include", LAUNCHES, lambda part: (
    "a.launch", f'<launch><include file="{part}"/></launch>'))
MODELS = {
    "circle.sdf": holding(WORLD.format("<include><uri>file://robot.world</uri></include>")),
    "empty.sdf": holding(""), "text.sdf": holding("no xml"),
    "utf16.sdf": holding(f"<sdf version='1.6'>{MODEL.format('')}</sdf>".encode("utf-16")),
    "nul.sdf": holding(b"<sdf>\0</sdf>"), "deep.sdf": holding(
        "<sdf version='1.7'>" + "<model name='m'>" * DEEP + "</model>" * DEEP + "</sdf>"),
    **_no_files(".sdf"),
}
parts("model include", MODELS, lambda part: ("robot.world", WORLD.format(
    f"<include><uri>file://{part}</uri></include>")))
parts("model file", MODELS, lambda part: ("a.launch", (
    '<launch><node name="s" pkg="gazebo_ros" type="spawn_model" '
    f'args="-sdf -file {part} -model m"/></launch>')))
