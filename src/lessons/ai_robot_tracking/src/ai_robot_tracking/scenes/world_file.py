"""Scenes as world files, for our simulator and for Gazebo."""

from __future__ import annotations

import numpy as np

from ai_robot_tracking.scenes.scene import (
    FALL_TIME,
    HALF_ROOM,
    HIDDEN_TIME,
    HOOD_UP,
    KINDS,
    SHADE_RADIUS,
    Lookalike,
    Scene,
)

TARGET = "red_cylinder"
RADIUS, HEIGHT = 0.2, 0.6            # m, of the cylinder
HOOD_RADIUS, HOOD_HEIGHT = 0.3, 0.7  # m
WALL_HEIGHT, WALL_THICKNESS = 1.0, 0.1
SHADOW = 0.6                         # share of the light that is missing in the shade
RED, HOOD_COLOUR = (1.0, 0.0, 0.0), (0.35, 0.4, 0.5)
WALL_COLOURS = ((0.75, 0.75, 0.72), (0.62, 0.68, 0.72), (0.7, 0.74, 0.66), (0.66, 0.66, 0.7))
UNSHADED = "<scene><shadows>0</shadows></scene>\n"
SUN = '<include><uri>model://sun</uri></include>\n'


def world_text(scene: Scene) -> str:
    """The world file of a scene."""
    body = [
        "<include><uri>model://ground_plane</uri></include>\n",
        _light(scene.sun), _walls(), _target(scene), _shade(scene),
        *(_lookalike(number, each) for number, each in enumerate(scene.lookalikes)),
        _hood(scene) if scene.hidden else "",
    ]
    return ('<?xml version="1.0"?>\n'
            f"<!-- A room of {2 * HALF_ROOM:g} x {2 * HALF_ROOM:g} m with a red cylinder: scene"
            f" {scene.kind}, seed {scene.seed},\n     written by make_tracking_world.py of package"
            " ai_robot_tracking -->\n"
            f'<sdf version="1.6">\n<world name="default">\n{"".join(body)}</world>\n</sdf>\n')


def world_name(kind: str) -> str:
    """The name of the lesson's world file for a kind of scene, without .world."""
    return "tracking" if kind == KINDS[0] else f"tracking_{kind}"


def _light(sun: float) -> str:
    """The usual sun, or a weaker one, which shines at a slant."""
    if sun == 1.0:
        return UNSHADED + SUN
    ambient, diffuse = (" ".join([f"{sun * full:.3f}"] * 3) for full in (0.4, 0.8))
    return (f"<scene><ambient>{ambient} 1</ambient><shadows>0</shadows></scene>\n"
            '<light name="sun" type="directional"><pose>0 0 10 0 0 0</pose>'
            f"<diffuse>{diffuse} 1</diffuse><specular>0 0 0 1</specular>"
            "<direction>-0.6 0.3 -0.7</direction></light>\n")


def _shade(scene: Scene) -> str:
    """Dark patches on the floor, and a thin dark cover for the cylinder while it is on one.

    The scene's own shadows are off: these need no object to cast them.
    """
    if not scene.shades:
        return ""
    away = np.min([np.linalg.norm(scene.way[:, 1:] - shade, axis=1) for shade in scene.shades],
                  axis=0)
    z = np.where(away < SHADE_RADIUS, HEIGHT / 2, -HEIGHT)
    floor = f"<cylinder><radius>{SHADE_RADIUS:g}</radius><length>0.004</length></cylinder>"
    parts = [_model(f"shade_{number}", f"{x:.3f} {y:.3f} 0.002 0 0 0",
                    _visual("body", floor, (0.0, 0.0, 0.0, SHADOW)))
             for number, (x, y) in enumerate(scene.shades)]
    skin = _cylinder(RADIUS + 0.004, HEIGHT + 0.008)
    return "".join(parts) + _walker("skin", skin, (0.0, 0.0, 0.0, SHADOW),
                                    np.column_stack([scene.way, z]))


def _walls() -> str:
    """Each in another colour, so that turning on the spot changes the image."""
    parts, away = [], HALF_ROOM + WALL_THICKNESS / 2
    for number, (x, y) in enumerate(((away, 0), (0, away), (-away, 0), (0, -away))):
        size = (WALL_THICKNESS, 2 * HALF_ROOM) if x else (2 * HALF_ROOM, WALL_THICKNESS)
        shape = f"<box><size>{size[0]:g} {size[1]:g} {WALL_HEIGHT:g}</size></box>"
        parts.append(_shape(f"wall_{number}", shape, WALL_COLOURS[number],
                            f"{x:g} {y:g} {WALL_HEIGHT / 2:g} 0 0 0"))
    return _model("walls", "0 0 0 0 0 0", "".join(parts))


def _target(scene: Scene) -> str:
    shape = _cylinder(RADIUS, HEIGHT)
    if len(scene.way) == 1:
        _, x, y = scene.way[0]
        return _model(TARGET, f"{x:g} {y:g} {HEIGHT / 2:g} 0 0 0", _shape("body", shape, RED))
    rows = np.column_stack([scene.way, np.full(len(scene.way), HEIGHT / 2)])
    return _walker(TARGET, shape, RED, rows)


def _hood(scene: Scene) -> str:
    """A hood that comes down over the cylinder, moves with it, and rises again."""
    low = HOOD_HEIGHT / 2 + 0.02
    times = [scene.way[:, 0]]
    for begin in scene.hidden:
        times.append(np.array([begin - FALL_TIME, begin, begin + HIDDEN_TIME,
                               begin + HIDDEN_TIME + FALL_TIME]))
    when = np.unique(np.concatenate(times))
    up = np.ones(len(when))
    for begin in scene.hidden:
        near = np.interp(when, [begin - FALL_TIME, begin, begin + HIDDEN_TIME,
                                begin + HIDDEN_TIME + FALL_TIME], [1, 0, 0, 1])
        up = np.minimum(up, near)
    x, y = (np.interp(when, scene.way[:, 0], scene.way[:, axis]) for axis in (1, 2))
    rows = np.column_stack([when, x, y, low + HOOD_UP * up])
    return _walker("hood", _cylinder(HOOD_RADIUS, HOOD_HEIGHT), HOOD_COLOUR, rows)


def _lookalike(number: int, thing: Lookalike) -> str:
    shapes = {"cylinder": (_cylinder(RADIUS, HEIGHT), HEIGHT / 2),
              "ball": ("<sphere><radius>0.3</radius></sphere>", 0.3),
              "box": ("<box><size>0.3 1.2 0.25</size></box>", 0.125)}
    shape, height = shapes[thing.shape]
    x, y, yaw = thing.place
    return _model(f"lookalike_{number}", f"{x:.3f} {y:.3f} {height:g} 0 0 {yaw:.4f}",
                  _shape("body", shape, thing.colour))


def _walker(name: str, shape: str, colour: tuple, rows: np.ndarray) -> str:
    """An actor that moves in straight lines from row to row (N, 4) of s, x, y, z."""
    points = "".join(f"<waypoint><time>{t:.3f}</time><pose>{x:.4f} {y:.4f} {z:.4f} 0 0 0</pose>"
                     "</waypoint>\n" for t, x, y, z in rows)
    return (f'<actor name="{name}">\n<link name="link">{_visual("body", shape, colour)}</link>\n'
            '<script><loop>true</loop><auto_start>true</auto_start><trajectory id="0"'
            f' type="way">\n{points}</trajectory></script>\n</actor>\n')


def _model(name: str, pose: str, shapes: str) -> str:
    return (f'<model name="{name}"><static>true</static><pose>{pose}</pose>'
            f'<link name="link">\n{shapes}</link></model>\n')


def _shape(name: str, shape: str, colour: tuple, pose: str = "0 0 0 0 0 0") -> str:
    return (f'<collision name="{name}"><pose>{pose}</pose><geometry>{shape}</geometry>'
            f"</collision>\n{_visual(name, shape, colour, pose)}")


def _visual(name: str, shape: str, colour: tuple, pose: str = "0 0 0 0 0 0") -> str:
    text = " ".join(f"{part:g}" for part in (*colour, 1)[:4])
    return (f'<visual name="{name}"><pose>{pose}</pose><geometry>{shape}</geometry><material>'
            f"<ambient>{text}</ambient><diffuse>{text}</diffuse><specular>0 0 0 1</specular>"
            "</material></visual>\n")


def _cylinder(radius: float, height: float) -> str:
    return f"<cylinder><radius>{radius:g}</radius><length>{height:g}</length></cylinder>"
