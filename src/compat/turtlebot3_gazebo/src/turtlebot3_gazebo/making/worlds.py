"""The world files of the plain worlds; the races' are in race_worlds."""

from __future__ import annotations

from turtlebot3_gazebo.making import sdf
from turtlebot3_gazebo.making.arenas import columns
from turtlebot3_gazebo.making.sdf import WHITE, Part, cylinder

PHYSICS = """  <physics type="ode">
    <real_time_update_rate>1000.0</real_time_update_rate>
    <max_step_size>0.001</max_step_size>
    <real_time_factor>1</real_time_factor>
    <ode>
      <solver>
        <type>quick</type>
        <iters>150</iters>
        <precon_iters>0</precon_iters>
        <sor>1.400000</sor>
        <use_dynamic_moi_rescaling>1</use_dynamic_moi_rescaling>
      </solver>
      <constraints>
        <cfm>0.00001</cfm>
        <erp>0.2</erp>
        <contact_max_correcting_vel>2000.000000</contact_max_correcting_vel>
        <contact_surface_layer>0.01000</contact_surface_layer>
      </constraints>
    </ode>
  </physics>"""
STAGE_SCENE = """  <scene>
    <ambient>0.4 0.4 0.4 1</ambient>
    <background>0.7 0.7 0.7 1</background>
    <shadows>0</shadows>
  </scene>"""
UNSHADED = "  <scene><shadows>0</shadows></scene>"


def include(uri: str, place: sdf.Numbers = sdf.ORIGIN) -> str:
    return f"  <include><uri>model://{uri}</uri>{sdf.pose(place)}</include>"


def world(*parts: str) -> bytes:
    """A world file; each part is one or more elements."""
    body = "\n".join(["<world name=\"default\">", *parts, PHYSICS, "</world>"])
    return sdf.document(body).encode()


def pillar(name: str, x: float, y: float) -> str:
    part = Part("obstacle", cylinder(0.12, 0.25), (0, 0, 0.125), WHITE)
    return sdf.model(name, [sdf.link("link", [part])], (x, y, 0.0))


def worlds() -> dict[str, bytes]:
    """File name below `worlds/` -> bytes."""
    ground = include("ground_plane"), include("sun")
    square, plaza = include("turtlebot3_square"), include("turtlebot3_plaza")
    made = {
        "empty": world(UNSHADED, *ground),
        "turtlebot3_world": world(UNSHADED, *ground, include("turtlebot3_world")),
        "turtlebot3_house": world(UNSHADED, *ground, include("turtlebot3_house")),
        "turtlebot3_stage_1": world(STAGE_SCENE, *ground, square),
        "turtlebot3_stage_2": world(STAGE_SCENE, *ground, square, columns("obstacle", static=1)),
        "turtlebot3_stage_3": world(STAGE_SCENE, *ground, square, columns("obstacle", static=0)),
        "turtlebot3_stage_4": world(STAGE_SCENE, *ground, plaza, pillar("obstacle_1", 2.0, 2.0),
                                    pillar("obstacle_2", -2.0, -2.0)),
    }
    return {f"{name}.world": text for name, text in made.items()}
