"""Resolves SDF pose frames within one model: `relative_to`, `frame`, `attached_to`."""

from xml.etree.ElementTree import Element

from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import pose
from bullet_sim.pose import IDENTITY, Pose

MODEL = "__model__"
JOINT = "joint "  # before SDF 1.7 a joint may have the same name as a link


class Frames:
    """Named frames of a model and their poses in the model frame, with joints at zero."""

    def __init__(self, source: Source, model: str):
        self._source = source
        self._model = model
        self._placed: dict[str, tuple[str, Pose]] = {}  # name -> (frame it is given in, pose)

    def add(self, name: str, given_in: str, placed: Pose) -> None:
        """Add a named frame, relative to another one that may be added later."""
        self._placed[name] = (given_in or MODEL, placed)

    def add_element(self, element: Element, usual: str, where: str) -> None:
        """Add the frame of a link, joint or `<frame>`; `usual` is its pose's frame by default."""
        name = element.get("name", "")
        given_in, placed = relative_to(element) or usual, pose(element, where)
        if element.tag == "joint":
            self.add(JOINT + name, given_in, placed)
        if element.tag != "joint" or name not in self._placed:
            self.add(name, given_in, placed)

    def __contains__(self, name: str) -> bool:
        return name in (MODEL, "world") or name in self._placed

    def joint_in_model(self, name: str) -> Pose:
        """Pose of a joint's frame in the model frame."""
        return self.in_model(JOINT + name)

    def in_model(self, name: str) -> Pose:
        """Pose of a frame in the model frame."""
        result = IDENTITY
        passed: list[str] = []
        while name not in (MODEL, "world"):
            if name in passed or name not in self._placed:
                reason = "refers to itself" if name in passed else "is not in the model"
                self._source.warn_once(
                    f"model {self._model!r}: pose frame {name!r} {reason}; model frame taken"
                )
                break
            passed.append(name)
            name, placed = self._placed[name]
            result = placed * result
        return result


def relative_to(element: Element) -> str:
    """The frame named by an element's pose: `relative_to` since SDF 1.7, `frame` before."""
    written = element.find("pose")
    if written is None:
        return ""
    return (written.get("relative_to") or written.get("frame") or "").strip()


def end_of(joint: Element, role: str) -> str:
    """Name of a joint's parent or child; SDF 1.2 had it in the attribute `link`."""
    end = joint.find(role)
    return "" if end is None else (end.text or "").strip() or end.get("link", "")


def add_model_frames(frames: Frames, element: Element, where: str) -> None:
    """Add all links, joints and frames that are children of a `<model>`."""
    for link in element.findall("link"):
        frames.add_element(link, MODEL, f"{where}, link {link.get('name')!r}")
    for joint in element.findall("joint"):
        frames.add_element(joint, end_of(joint, "child"), f"{where}, joint {joint.get('name')!r}")
    for frame in element.findall("frame"):
        usual = frame.get("attached_to") or MODEL
        frames.add_element(frame, usual, f"{where}, frame {frame.get('name')!r}")
