"""Finds what looks like xacro's within links, joints and models, and was not expanded."""

from collections.abc import Collection
from xml.dom import minidom

BLOCK = "insert_block"  # nothing else has a tag of this name
_CONDITIONS = frozenset(["if", "unless"])
_TAGS_OF_URDF = frozenset([
    "acceleration", "actuator", "axis", "box", "calibration", "capsule", "child", "collision",
    "color", "cylinder", "dynamics", "geometry", "hardwareInterface", "inertia", "inertial",
    "joint", "limit", "link", "mass", "material", "mechanicalReduction", "mesh", "mimic", "origin",
    "parent", "role", "safety_controller", "sphere", "texture", "type", "verbose", "visual",
])


def unanswered_inside(root: minidom.Element, macros: Collection[str]) -> list[str]:
    """Tags below the top level that want the prefix: keywords, and calls of these macros.

    In a `<gazebo>` tag and in SDF only blocks count: a macro may be named as SDF's `<camera>`.
    """
    found = [BLOCK] * len(root.getElementsByTagName(BLOCK))
    if root.tagName != "robot":
        return found
    calls = _CONDITIONS | set(macros) - _TAGS_OF_URDF
    for part in root.childNodes:
        if part.nodeType == part.ELEMENT_NODE and part.tagName != "gazebo":
            found += [element.tagName for element in part.getElementsByTagName("*")
                      if element.tagName in calls]
    return found
