"""Worlds as public ones are made, by script: many triangles, textures, sensors, rough ground."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from bullet_sim.meshes.part import grid_faces

SIGNS = 12
PICTURE_PX = 1024  # a side of a sign's picture
ROUND, PLATE = 0.55, 0.45  # shares of a sign's triangles: post and lamp; its plate
GROUND = 12.0  # m, a side of the playpen's floor
STL_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

Surface = tuple[np.ndarray, np.ndarray]  # vertices (n, 3) m, faces (m, 3)


@dataclass(frozen=True)
class MadeWorld:
    """A world file, and what is to be heard of it."""

    file: Path
    topics: tuple[str, ...]


def signs(folder: Path, triangles: int) -> MadeWorld:
    """A road with twelve signs of so many triangles together, each with a picture of its own, and a
    camera of 320x240 at 30 Hz before them."""
    each = triangles // SIGNS
    write_stl(folder / "sign.stl", [_turned_on_a_lathe(round(each * ROUND)),
                                    _sheet(round(each * PLATE), 0.2, 0.2, (0.021, 0.0, 0.3))])
    models = []
    for number in range(SIGNS):
        picture = folder / f"sign_{number}.png"
        cv2.imwrite(str(picture), _picture(number))
        x, y = 1.0 + 0.35 * (number // 3), 0.6 * (number % 3 - 1)
        models.append(f"""
    <model name="sign_{number}"><static>true</static><pose>{x} {y} 0 0 0 3.1416</pose>
      <link name="link">
        <collision name="post"><pose>0 0 0.2 0 0 0</pose><geometry><cylinder><radius>0.02</radius>
          <length>0.4</length></cylinder></geometry></collision>
        <visual name="body"><geometry><mesh><uri>file://{folder}/sign.stl</uri></mesh></geometry>
          <material><ambient>.4 .4 .4 1</ambient><diffuse>.{number % 9 + 1} .5 .4 1</diffuse>
          </material></visual>
        <visual name="picture"><pose>0.023 0 0.3 0 1.5708 0</pose><geometry><plane>
          <normal>0 0 1</normal><size>0.18 0.18</size></plane></geometry>
          <material><script><uri>file://{folder}/signs.material</uri><name>Sign/{number}</name>
          </script></material></visual>
      </link></model>""")
    (folder / "signs.material").write_text("".join(
        f"material Sign/{n}\n{{ technique {{ pass {{ texture_unit {{ texture sign_{n}.png }} }} }} "
        f"}}\n" for n in range(SIGNS)), encoding="utf-8")
    watcher = _watcher(_camera("front", (320, 240), (0, 0, 0.35, 0, 0, 0)), "-1 0 0 0 0 0")
    return _world(folder, "signs", [*models, watcher], ["/front/image_raw"])


def many_eyes(folder: Path) -> MadeWorld:
    """Four cameras of 640x480 at 30 Hz and a laser of 16 rings and 1024 columns at 10 Hz."""
    boxes = [_box(number, 3.0 * math.cos(number), 3.0 * math.sin(number)) for number in range(12)]
    cameras = "".join(
        _camera(name, (640, 480), (0, 0, 0.35, 0, 0, number * math.pi / 2))
        for number, name in enumerate(("front", "left", "rear", "right")))
    laser = """
      <sensor name="rings" type="ray"><pose>0 0 0.6 0 0 0</pose><update_rate>10</update_rate>
        <ray><scan><horizontal><samples>1024</samples><min_angle>-3.1416</min_angle>
          <max_angle>3.1416</max_angle></horizontal><vertical><samples>16</samples>
          <min_angle>-0.26</min_angle><max_angle>0.26</max_angle></vertical></scan>
          <range><min>0.3</min><max>50</max></range></ray>
        <plugin name="rings" filename="libgazebo_ros_velodyne_laser.so">
          <topicName>/points</topicName><frameName>rings</frameName></plugin></sensor>"""
    topics = [*(f"/{name}/image_raw" for name in ("front", "left", "rear", "right")), "/points"]
    return _world(folder, "many_eyes", [*boxes, _watcher(cameras + laser, "0 0 0 0 0 0")], topics)


def depth(folder: Path, width: int, height: int) -> MadeWorld:
    """A depth camera at 30 Hz: colour, depth and points."""
    boxes = [_box(number, 2.0 + number % 4, number - 6.0) for number in range(12)]
    sensor = f"""
      <sensor name="kinect" type="depth"><pose>0 0 0.35 0 0 0</pose><update_rate>30</update_rate>
        <camera><horizontal_fov>1.3439</horizontal_fov><image><width>{width}</width>
          <height>{height}</height><format>R8G8B8</format></image><clip><near>0.05</near>
          <far>10</far></clip></camera>
        <plugin name="kinect" filename="libgazebo_ros_openni_kinect.so">
          <cameraName>camera</cameraName><imageTopicName>rgb/image_raw</imageTopicName>
          <depthImageTopicName>depth/image_raw</depthImageTopicName>
          <pointCloudTopicName>depth/points</pointCloudTopicName>
          <frameName>camera</frameName></plugin></sensor>"""
    topics = ["/camera/rgb/image_raw", "/camera/depth/image_raw", "/camera/depth/points"]
    return _world(folder, f"depth_{width}", [*boxes, _watcher(sensor, "0 0 0 0 0 0")], topics)


def playpen(folder: Path, wheels: int) -> MadeWorld:
    """A skid-steered robot of four or six cylinders for wheels on a rough floor of triangles."""
    write_stl(folder / "floor.stl", [_rough_floor(20_000)])
    floor = f"""
    <model name="floor"><static>true</static><link name="link">
      <collision name="floor"><geometry><mesh><uri>file://{folder}/floor.stl</uri></mesh></geometry>
      </collision><visual name="floor"><geometry><mesh><uri>file://{folder}/floor.stl</uri></mesh>
      </geometry></visual></link></model>"""
    return _world(folder, f"playpen_{wheels}", [floor, _skid_steered(wheels)], [])


def write_stl(path: Path, surfaces: list[Surface]) -> int:
    """As binary STL; how many triangles."""
    corners = np.concatenate([vertices[faces] for vertices, faces in surfaces])
    facets = np.zeros(len(corners), STL_FACET)
    facets["corners"] = corners
    path.write_bytes(bytes(80) + len(facets).to_bytes(4, "little") + facets.tobytes())
    return len(facets)


def _turned_on_a_lathe(triangles: int) -> Surface:
    """A post with a ball on it; rings and sides as many as that takes."""
    sides = max(8, math.isqrt(triangles // 2))
    rings = max(4, triangles // (2 * sides))
    bends = np.linspace(-1.5, 1.5707, rings // 2)
    radius = np.concatenate([np.full(rings - len(bends), 0.02), 0.06 * np.cos(bends)])
    height = np.concatenate([np.linspace(0.0, 0.33, rings - len(bends)),
                             0.39 + 0.06 * np.sin(bends)])
    angle = np.linspace(0.0, 2 * math.pi, sides + 1)
    angle[-1] = 0.0  # the same place, to the last bit
    vertices = np.stack([np.outer(radius, np.cos(angle)), np.outer(radius, np.sin(angle)),
                         np.repeat(height[:, None], sides + 1, axis=1)], axis=-1).reshape(-1, 3)
    return vertices, grid_faces(len(radius), sides + 1)


def _sheet(triangles: int, wide: float, high: float, middle: tuple[float, float, float]) -> Surface:
    """Flat, facing x, and yet cut up, as exporters do."""
    side = max(2, math.isqrt(triangles // 2) + 1)
    z, y = np.meshgrid(np.linspace(-high / 2, high / 2, side),
                       np.linspace(-wide / 2, wide / 2, side), indexing="ij")
    vertices = np.stack([0 * y, y, z], axis=-1).reshape(-1, 3) + middle
    return vertices, grid_faces(side, side)


def _rough_floor(triangles: int) -> Surface:
    """Gentle waves and bumps of some mm, from a seed."""
    side = math.isqrt(triangles // 2) + 1
    y, x = np.meshgrid(*[np.linspace(-GROUND / 2, GROUND / 2, side)] * 2, indexing="ij")
    bumps = np.random.default_rng(0).normal(0.0, 0.002, x.shape)
    z = 0.02 * np.sin(1.3 * x) * np.cos(0.9 * y) + bumps
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), grid_faces(side, side)


def _picture(number: int) -> np.ndarray:
    picture = np.full((PICTURE_PX, PICTURE_PX, 3), 255, np.uint8)
    colour = [int(one) for one in np.random.default_rng(number).integers(30, 200, 3)]
    cv2.circle(picture, (PICTURE_PX // 2,) * 2, PICTURE_PX * 4 // 10, colour, PICTURE_PX // 12)
    cv2.putText(picture, str(number), (PICTURE_PX // 4, PICTURE_PX * 2 // 3),
                cv2.FONT_HERSHEY_SIMPLEX, PICTURE_PX / 60, (0, 0, 0), PICTURE_PX // 20)
    return picture


def _camera(name: str, size: tuple[int, int], pose: tuple[float, ...]) -> str:
    return f"""
      <sensor name="{name}" type="camera"><pose>{' '.join(map(str, pose))}</pose>
        <update_rate>30</update_rate>
        <camera><horizontal_fov>1.05</horizontal_fov><image><width>{size[0]}</width>
          <height>{size[1]}</height><format>R8G8B8</format></image><clip><near>0.05</near>
          <far>50</far></clip></camera>
        <plugin name="{name}" filename="libgazebo_ros_camera.so"><cameraName>{name}</cameraName>
          <imageTopicName>image_raw</imageTopicName><cameraInfoTopicName>camera_info
          </cameraInfoTopicName><frameName>{name}</frameName></plugin></sensor>"""


def _watcher(sensors: str, pose: str) -> str:
    return f"""
    <model name="watcher"><pose>{pose}</pose><link name="base">
      <pose>0 0 0.1 0 0 0</pose><inertial><mass>5</mass></inertial>
      <collision name="base"><geometry><box><size>0.3 0.3 0.2</size></box></geometry></collision>
      <visual name="base"><geometry><box><size>0.3 0.3 0.2</size></box></geometry></visual>{sensors}
    </link></model>"""


def _box(number: int, x: float, y: float) -> str:
    shape = "<geometry><box><size>0.5 0.5 1</size></box></geometry>"
    return f"""
    <model name="box_{number}"><static>true</static><pose>{x:.3f} {y:.3f} 0.5 0 0 0</pose>
      <link name="link"><collision name="box">{shape}</collision><visual name="box">{shape}</visual>
      </link></model>"""


def _skid_steered(wheels: int) -> str:
    rows = {4: {"front": 0.2, "rear": -0.2}, 6: {"front": 0.25, "middle": 0.0, "rear": -0.25}}
    parts = []
    for row, x in rows[wheels].items():
        for side, y in (("left", 0.22), ("right", -0.22)):
            shape = ("<geometry><cylinder><radius>0.1</radius><length>0.06</length></cylinder>"
                     "</geometry>")
            parts.append(f"""
      <link name="{side}_{row}_wheel"><pose>{x} {y} 0 -1.5708 0 0</pose>
        <inertial><mass>1</mass></inertial><collision name="wheel">{shape}</collision>
        <visual name="wheel">{shape}</visual></link>
      <joint name="{side}_{row}" type="revolute"><parent>base</parent>
        <child>{side}_{row}_wheel</child><axis><xyz>0 1 0</xyz>
        <use_parent_model_frame>true</use_parent_model_frame></axis></joint>""")
    return f"""
    <model name="robot"><pose>0 0 0.2 0 0 0</pose><link name="base">
      <inertial><mass>15</mass></inertial>
      <collision name="base"><pose>0 0 0.08 0 0 0</pose><geometry><box><size>0.6 0.34 0.1</size>
        </box></geometry></collision><visual name="base"><pose>0 0 0.08 0 0 0</pose><geometry><box>
        <size>0.6 0.34 0.1</size></box></geometry></visual></link>{''.join(parts)}
      <plugin name="drive" filename="libgazebo_ros_skid_steer_drive.so">
        <leftFrontJoint>left_front</leftFrontJoint><rightFrontJoint>right_front</rightFrontJoint>
        <leftRearJoint>left_rear</leftRearJoint><rightRearJoint>right_rear</rightRearJoint>
        <wheelSeparation>0.44</wheelSeparation><wheelDiameter>0.2</wheelDiameter></plugin>
    </model>"""


def _world(folder: Path, name: str, models: list[str], topics: list[str]) -> MadeWorld:
    file = folder / f"{name}.world"
    floor = "" if name.startswith("playpen") else """
    <include><uri>model://ground_plane</uri></include>"""
    file.write_text(f"""<?xml version="1.0"?>
<sdf version="1.6">
  <world name="default">
    <include><uri>model://sun</uri></include>{floor}{''.join(models)}
  </world>
</sdf>
""", encoding="utf-8")
    return MadeWorld(file, tuple(topics))
