"""Properties of a URDF for controllers: joint limits, joint poses, wheel radii."""

from collections.abc import Callable
from xml.etree.ElementTree import Element

from bullet_sim.description import JointLimits, SoftLimits
from bullet_sim.errors import FormatError, UnknownName
from bullet_sim.formats.urdf.tree import UrdfJoint, UrdfTree, read_tree
from bullet_sim.formats.xml_values import not_negative, numbers
from bullet_sim.pose import IDENTITY, Pose


class RobotFacts:
    """The joints and links of a `<robot>` as written; nothing is lumped, moved or left out.

    FormatError if the robot's links and joints are not a tree.
    """

    def __init__(self, robot: Element):
        self._tree: UrdfTree = read_tree(robot)
        self._joints = {joint.name: joint for joint in self._tree.inward.values()}

    def has_joint(self, name: str) -> bool:
        """Whether the URDF has a joint of that name."""
        return name in self._joints

    def parent(self, name: str) -> str:
        """The joint's parent link. UnknownName without such a joint."""
        return self._joint(name).parent

    def child(self, name: str) -> str:
        """The joint's child link. UnknownName without such a joint."""
        return self._joint(name).child

    def joints_on(self, name: str) -> list[str]:
        """The joints whose parent is that joint's child: those of a wheel's rollers.

        UnknownName without such a joint.
        """
        return [joint.name for joint in self._joints.values() if joint.parent == self.child(name)]

    def pose(self, name: str) -> Pose:
        """The joint's frame in the root link's, with every joint at zero.

        UnknownName without such a joint.
        """
        pose, joint = IDENTITY, self._joint(name)
        while joint is not None:
            pose = joint.origin * pose
            joint = self._tree.inward.get(joint.parent)
        return pose

    def limits(self, name: str) -> JointLimits:
        """`<limit>` and `<safety_controller>`; a value of 0 is a limit of 0.

        UnknownName without such a joint, FormatError without k_velocity.
        """
        return _limits(self._joint(name))

    def wheel_radius(self, name: str) -> float:
        """Radius, m, of the first collision of the joint's child: a cylinder or a sphere.

        FormatError without one, UnknownName without such a joint.
        """
        link = self.child(name)
        for tag in ("cylinder", "sphere"):
            shape = self._tree.links[link].find(f"collision/geometry/{tag}")
            if shape is not None:
                where = f"link {link!r} <{tag} radius>"
                return not_negative(numbers(shape.get("radius", ""), 1, where), where)[0]
        raise FormatError(f"the radius of wheel joint {name!r} is not known: link {link!r} has no "
                          "<collision> with a <cylinder> or <sphere>")

    def _joint(self, name: str) -> UrdfJoint:
        if name not in self._joints:
            raise UnknownName(f"joint in the URDF of robot {self._tree.name!r}", name, self._joints)
        return self._joints[name]


def _limits(joint: UrdfJoint) -> JointLimits:
    element = joint.element.find("limit")
    if element is None:
        return JointLimits()
    read = _reader(element, f"joint {joint.name!r} <limit")
    ends = {} if joint.type == "continuous" else {"lower": read("lower"), "upper": read("upper")}
    return JointLimits(velocity=read("velocity"), effort=read("effort"),
                       soft=_soft_limits(joint), **ends)


def _soft_limits(joint: UrdfJoint) -> SoftLimits | None:
    element = joint.element.find("safety_controller")
    if element is None:
        return None
    read = _reader(element, f"joint {joint.name!r} <safety_controller")
    if element.get("k_velocity") is None:
        raise FormatError(f"joint {joint.name!r} <safety_controller> needs a k_velocity")
    return SoftLimits(read("soft_lower_limit"), read("soft_upper_limit"), read("k_position"),
                      read("k_velocity"))


def _reader(element: Element, where: str) -> Callable[[str], float]:
    return lambda key: numbers(element.get(key, "0"), 1, f"{where} {key}>")[0]
