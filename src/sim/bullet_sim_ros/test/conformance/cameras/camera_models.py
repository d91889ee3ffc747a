"""Robots with one sensor that sees, in front of a red wall, for the conformance tests."""

from __future__ import annotations

WALL = """<model name="wall"><static>true</static><pose>2.05 0 0 0 0 0</pose><link name="l">
  <visual name="v"><geometry><box><size>0.1 9 9</size></box></geometry>
    <material><ambient>1 0 0 1</ambient><diffuse>1 0 0 1</diffuse><emissive>1 0 0 1</emissive>
    </material></visual></link></model>"""
SMALL = "<image><width>32</width><height>24</height></image>"


def eye(plugin: str, tags: str = "", camera: str = SMALL, kind: str = "camera", sensor: str = "",
        rate: float = 10) -> str:
    """SDF of a model `eye` at the origin, looking along +x; `tags` go into the plugin."""
    return f"""<model name="eye"><static>true</static><link name="l">
      <sensor name="s" type="{kind}"><update_rate>{rate}</update_rate>{sensor}
        <camera name="c">{camera}</camera>
        <plugin name="p" filename="{plugin}"><cameraName>eye</cameraName>{tags}</plugin>
      </sensor></link></model>"""


def pair(plugin: str, tags: str = "", names: tuple[str, ...] = ("left", "right")) -> str:
    """The same with two cameras that stand 10 cm left and right of the middle, facing out."""
    cameras = "".join(
        f'<camera name="{name}"><pose>0 {0.1 - 0.2 * index} 0 0 0 0</pose>{SMALL}</camera>'
        for index, name in enumerate(names))
    return f"""<model name="eye"><static>true</static><link name="l">
      <sensor name="s" type="multicamera"><update_rate>10</update_rate>{cameras}
        <plugin name="p" filename="{plugin}"><cameraName>eye</cameraName>{tags}</plugin>
      </sensor></link></model>"""
