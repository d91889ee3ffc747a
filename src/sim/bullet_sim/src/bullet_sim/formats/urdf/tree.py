"""The link tree of a URDF: links and joints as a checked tree, children in urdfdom's order."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial
from xml.etree.ElementTree import Element

from bullet_sim.errors import FormatError
from bullet_sim.formats.xml_values import bounded, numbers, or_default
from bullet_sim.pose import IDENTITY, Pose

WORLD = "world"
DEEPEST = 200  # joints from the root to a link
JOINT_TYPES = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")


@dataclass(frozen=True)
class UrdfJoint:
    """A joint as written, with its pose in the parent link's frame."""

    name: str
    type: str
    parent: str
    child: str
    origin: Pose
    element: Element


@dataclass
class UrdfTree:
    """All links by name, and the joints that lead away from and into each."""

    name: str
    root: str
    links: dict[str, Element]
    outward: dict[str, list[UrdfJoint]] = field(default_factory=dict)  # parent link -> joints
    inward: dict[str, UrdfJoint] = field(default_factory=dict)  # child link -> its joint

    def depth_first(self, start: str) -> Iterator[str]:
        """Link names from `start` down, parents before children."""
        yield start
        for joint in self.outward.get(start, ()):
            yield from self.depth_first(joint.child)

    def poses(self) -> dict[str, Pose]:
        """Poses of the links in the model frame with every joint at zero."""
        poses = {self.root: IDENTITY}
        for name in self.depth_first(self.root):
            for joint in self.outward.get(name, ()):
                poses[joint.child] = poses[name] * joint.origin
        return poses


def read_tree(robot: Element) -> UrdfTree:
    """The tree of a `<robot>`, or a FormatError that says what is wrong."""
    name = robot.get("name", "")
    if not name:
        raise FormatError("<robot> has no name")
    links = _named(robot, "link", f"robot {name!r}")
    if not links:
        raise FormatError(f"robot {name!r} has no links")
    joints = _named(robot, "joint", f"robot {name!r}")
    tree = UrdfTree(name, "", links)
    for joint_name in sorted(joints):  # as in the std::map of urdfdom's ModelInterface
        joint = _read_joint(joints[joint_name], links)
        other = tree.inward.setdefault(joint.child, joint)
        if other is not joint:
            raise FormatError(f"link {joint.child!r} is the child of two joints: "
                              f"{other.name!r} and {joint.name!r}")
        tree.outward.setdefault(joint.parent, []).append(joint)
    tree.root = _root(tree)
    return tree


def read_origin(element: Element, where: str) -> Pose:
    """The `<origin>` of an element; identity if absent. FormatError for impossible numbers."""
    origin = element.find("origin")
    if origin is None:
        return Pose()
    return Pose.from_xyz_rpy(
        *(_possible(numbers(origin.get(key, "0 0 0"), 3, f"{where} <origin {key}>"),
                    f"{where} <origin {key}>") for key in ("xyz", "rpy")))


def _possible(values: tuple[float, ...], where: str) -> tuple[float, ...]:
    """Zeros, with an error line, for numbers that urdfdom accepts but no engine can use."""
    return or_default(partial(bounded, values, where), (0.0, 0.0, 0.0))


def _named(robot: Element, tag: str, where: str) -> dict[str, Element]:
    found: dict[str, Element] = {}
    for element in robot.findall(tag):
        name = element.get("name", "")
        if not name:
            raise FormatError(f"{where}: a <{tag}> has no name")
        if name in found:
            raise FormatError(f"{where}: two {tag}s are named {name!r}")
        found[name] = element
    return found


def _read_joint(element: Element, links: dict[str, Element]) -> UrdfJoint:
    name, kind = element.get("name", ""), element.get("type", "")
    where = f"joint {name!r}"
    if kind not in JOINT_TYPES:
        raise FormatError(f"{where}: unknown type {kind!r}; there are: {', '.join(JOINT_TYPES)}")
    parent, child = (_end(element, role, links, where) for role in ("parent", "child"))
    if child == WORLD:
        raise FormatError(f"{where}: link 'world' cannot be the child; write "
                          f'<parent link="world"/><child link="{parent}"/>')
    return UrdfJoint(name, kind, parent, child, read_origin(element, where), element)


def _end(joint: Element, role: str, links: dict[str, Element], where: str) -> str:
    element = joint.find(role)
    end = "" if element is None else element.get("link", "")
    if end not in links:
        raise FormatError(
            f"{where}: {role} link {end!r} not found; the links are: {', '.join(links)}"
        )
    return end


def _root(tree: UrdfTree) -> str:
    roots = [link for link in tree.links if link not in tree.inward]
    if len(roots) > 1:
        raise FormatError(f"robot {tree.name!r} has several root links: {', '.join(roots)}; "
                          "join them with a joint")
    if roots and _depth(tree, roots[0]) > DEEPEST:
        raise FormatError(f"robot {tree.name!r} has more than {DEEPEST} joints one after another")
    reached = set(tree.depth_first(roots[0])) if roots else set()
    loop = [link for link in tree.links if link not in reached]
    if loop:
        raise FormatError(f"robot {tree.name!r}: the joints form a loop through "
                          f"{', '.join(loop)}")
    return roots[0]


def _depth(tree: UrdfTree, root: str) -> int:
    """Joints from the root to the farthest link; links in a loop are not reached."""
    depth, level = 0, [root]
    while level := [joint.child for link in level for joint in tree.outward.get(link, ())]:
        depth += 1
    return depth
