"""The files of a course: model, world, map, track file, preview, as bytes by relative path."""

from __future__ import annotations

import re
from pathlib import Path, PurePosixPath

import cv2
import numpy as np

from racecar_description.track.circuit import Circuit
from racecar_description.track.painted_plane import model_texts, write_files
from racecar_description.track.painting import paint_course, texture_scale
from racecar_description.track.preview import draw_preview
from racecar_description.track.track_file import track_text
from racecar_description.track.walls import (
    HEIGHT,
    MAP_CELL,
    THICKNESS,
    Box,
    grid_map,
    trace_walls,
    wall_boxes,
)

# Models in a world besides the course's, and the older course of this package.
TAKEN_NAMES = ("racecar", "sun", "ground_plane", "walls", "smartcar_plane")
WRITTEN_BY = "Written by make_track of the package racecar_description"
DESCRIPTION = """A lawn with a closed road: yellow centre line, white edge lines.
{written_by} from {source}."""

WORLD = """<?xml version="1.0"?>
<!-- {written_by} from {source}. A lap begins at {start}. -->
<sdf version="1.4">
  <world name="default">
    <scene>
      <ambient>0.4 0.4 0.4 1</ambient>
      <background>0.62 0.75 0.88 1</background>
      <shadows>false</shadows>
    </scene>
    <include>
      <uri>model://sun</uri>
    </include>
    <include>
      <uri>model://ground_plane</uri>
    </include>
    <include>
      <uri>model://{name}</uri>
      <pose>{x:g} {y:g} 0 0 0 0</pose>
    </include>
{walls}    <physics type="ode">
      <max_step_size>0.001</max_step_size>
      <real_time_factor>1</real_time_factor>
      <real_time_update_rate>1000</real_time_update_rate>
      <ode>
        <solver>
          <type>quick</type>
          <iters>150</iters>
          <sor>1.4</sor>
        </solver>
        <constraints>
          <cfm>0.00001</cfm>
          <erp>0.2</erp>
          <contact_max_correcting_vel>2000</contact_max_correcting_vel>
          <contact_surface_layer>0.01</contact_surface_layer>
        </constraints>
      </ode>
    </physics>
  </world>
</sdf>
"""

WALLS = """    <model name="walls">
      <static>true</static>
      <link name="link">
{boxes}      </link>
    </model>
"""

BOX = """        <collision name="collision_{number}">
          <pose>{pose}</pose>
          <geometry><box><size>{size}</size></box></geometry>
        </collision>
        <visual name="visual_{number}">
          <pose>{pose}</pose>
          <geometry><box><size>{size}</size></box></geometry>
          <material>
            <ambient>0.55 0.56 0.6 1</ambient>
            <diffuse>0.55 0.56 0.6 1</diffuse>
          </material>
        </visual>
"""

MAP_YAML = """image: {name}.pgm
resolution: {cell:g}
origin: [{x:g}, {y:g}, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""


def model_folder(name: str) -> PurePosixPath:
    """The folder of a course's model."""
    return PurePosixPath("models") / name


def world_path(name: str) -> PurePosixPath:
    """The path of a course's world."""
    return PurePosixPath("worlds") / f"{name}.world"


def preview_path(name: str) -> PurePosixPath:
    """The path of a course's preview."""
    return PurePosixPath("tracks") / f"{name}.png"


def write_course(course: Circuit, folder: Path) -> None:
    """Write all files into a folder; OSError names one that cannot be written."""
    write_files(course_files(course), folder)


def course_files(course: Circuit) -> dict[PurePosixPath, bytes]:
    """All files; the same course gives the same bytes."""
    name, plane, model = course.name, course.plane, model_folder(course.name)
    polygons = trace_walls(course) if course.walls else []
    grid = grid_map(course, polygons)
    texture = paint_course(course, texture_scale(course))
    words = {"name": name, "source": _in_comment(course.source), "written_by": WRITTEN_BY}
    model_files = model_texts(
        name,
        description=DESCRIPTION.format(**words),
        size=(plane.width, plane.height),
        uri=f"model://{name}",
        part=f"{name}_",
    )
    texts = {model / relative: text for relative, text in model_files.items()} | {
        world_path(name): _world_text(course, wall_boxes(polygons), words),
        PurePosixPath("maps") / f"{name}.yaml": MAP_YAML.format(
            name=name, cell=MAP_CELL, x=grid.x, y=grid.y
        ),
        PurePosixPath("tracks") / f"{name}.yaml": track_text(course.track_file(), words["source"]),
    }
    pictures = {
        model / f"materials/textures/{name}.png": _encode(".png", texture[..., ::-1]),
        PurePosixPath("maps") / f"{name}.pgm": _encode(".pgm", grid.image),
        preview_path(name): _encode(".png", draw_preview(course, texture, polygons)),
    }
    return {path: text.encode() for path, text in texts.items()} | pictures


def _world_text(course: Circuit, boxes: list[Box], words: dict[str, str]) -> str:
    x, y, heading = course.start
    start = f"x {x:.3f} m, y {y:.3f} m, yaw {heading:.4f} rad"
    walls = WALLS.format(boxes="".join(map(_box_text, range(len(boxes)), boxes))) if boxes else ""
    return WORLD.format(**words, x=course.plane.x, y=course.plane.y, walls=walls, start=start)


def _box_text(number: int, box: Box) -> str:
    pose = f"{box.x:g} {box.y:g} {HEIGHT / 2:g} 0 0 {box.heading:g}"
    size = f"{box.length:g} {THICKNESS:g} {HEIGHT:g}"
    return BOX.format(number=number, pose=pose, size=size)


def _in_comment(source: str) -> str:
    """The source's name, without characters that XML and YAML comments cannot contain."""
    plain = "".join(letter if letter.isprintable() else "?" for letter in source)
    # Dashes last: characters between two of them may have been removed.
    return re.sub("-{2,}", "-", re.sub("[<>&]", "", plain)).strip()


def _encode(kind: str, image: np.ndarray) -> bytes:
    return cv2.imencode(kind, np.ascontiguousarray(image))[1].tobytes()
