"""Joints with two degrees of freedom, as chains of two joints with one, which the engine has."""

from dataclasses import asdict, replace

from bullet_sim.description import JointDescription

MOVING = (
    "revolute", "continuous", "prismatic", "ball", "universal", "revolute2", "screw",
)  # types that the engine moves; gearbox only couples others
SECOND = "::axis2"  # after a joint's name: its second axis, as a joint in the engine
TRAVEL = "::travel"  # after a screw's name: its travel, m
UNLIMITED = JointDescription("", "", "", "")


def single_axis_joints(joint: JointDescription, turned: bool) -> list[JointDescription]:
    """The engine's joints from parent to child; the one with the joint's own name is axis one.

    A tiny link comes between two of them. `turned`: parent and child are exchanged.
    """
    if joint.type in ("universal", "revolute2"):
        first = replace(joint, type="revolute")
        second = replace(first, name=joint.name + SECOND, **asdict(joint.axis2))
        return [second, first] if turned else [first, second]
    if joint.type == "screw":
        travel = replace(joint, name=joint.name + TRAVEL, type="prismatic", damping=0.0,
                         lower=UNLIMITED.lower, upper=UNLIMITED.upper, friction=0.0,
                         spring_stiffness=0.0)
        return [travel, replace(joint, type="revolute")]
    return [joint]
