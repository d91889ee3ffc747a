"""A painted plane as a Gazebo model: the texts of its files, without the texture."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from pathlib import Path, PurePath

CONFIG = """<?xml version="1.0"?>
<model>
  <name>{name}</name>
  <version>1.0</version>
  <sdf version="1.4">model.sdf</sdf>
  <author><name>ros1-driving-courses</name></author>
  <description>
{description}
  </description>
</model>
"""

PLANE = """        <geometry>
          <plane>
            <normal>0 0 1</normal>
            <size>{width:g} {height:g}</size>
          </plane>
        </geometry>"""

SDF = """<?xml version="1.0"?>
<sdf version="1.4">
  <model name="{name}">
    <static>true</static>
    <link name="{part}link">
      <collision name="{part}collision">
{plane}
        <surface>
          <friction>
            <ode>
              <mu>100</mu>
              <mu2>50</mu2>
            </ode>
          </friction>
        </surface>
      </collision>
      <visual name="{part}visual">
        <cast_shadows>false</cast_shadows>
{plane}
        <material>
          <script>
            <uri>{uri}/materials/scripts</uri>
            <uri>{uri}/materials/textures</uri>
            <name>{name}</name>
          </script>
        </material>
      </visual>
    </link>
  </model>
</sdf>
"""

MATERIAL = """material {name}
{{
  technique
  {{
    pass
    {{
      texture_unit
      {{
        texture {name}.png
      }}
    }}
  }}
}}
"""


def model_texts(
    name: str, *, description: str, size: tuple[float, float], uri: str, part: str
) -> dict[str, str]:
    """Texts by relative path; the texture (not included) is materials/textures/NAME.png.

    `size` is the plane's width and height (m), `uri` the model's folder as model://, and `part`
    stands before the names of its link, collision and visual.
    """
    plane = PLANE.format(width=size[0], height=size[1])
    return {
        "model.config": config_text(name, description),
        "model.sdf": SDF.format(name=name, part=part, plane=plane, uri=uri),
        f"materials/scripts/{name}.material": material_text(name),
    }


def config_text(name: str, description: str) -> str:
    """model.config; the description may have several lines."""
    return CONFIG.format(name=name, description=textwrap.indent(description, "    "))


def material_text(name: str) -> str:
    """The material script that shows NAME.png."""
    return MATERIAL.format(name=name)


def write_files(files: Mapping[str | PurePath, bytes], folder: Path) -> None:
    """Write files by their relative paths; OSError names one that cannot be written."""
    for relative, data in files.items():
        path = folder / relative
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
