"""Reads `<transmission>` elements: which interface commands which joint.

Unusable ones are left out with a line that says why, as in transmission_interface's parser and
gazebo_ros_control's DefaultRobotHWSim; types and reductions have no effect there either.
"""

import logging
from dataclasses import dataclass
from xml.etree.ElementTree import Element

from bullet_sim.errors import FormatError

log = logging.getLogger(__name__)

PREFIX = "hardware_interface/"
INTERFACES = {"EffortJointInterface": "effort", "PositionJointInterface": "position",
              "VelocityJointInterface": "velocity"}


@dataclass(frozen=True)
class Transmission:
    """A transmission that the simulation can use."""

    name: str
    joint: str
    interface: str  # effort, position or velocity


def read_transmissions(robot: Element) -> list[Transmission]:
    """All usable ones of a `<robot>`, one per joint; FormatError for a joint with an interface
    that is none of the three."""
    found: dict[str, Transmission] = {}
    for element in robot.findall("transmission"):
        made = _read(element)
        if made is None:
            continue
        if made.joint in found:
            log.warning("transmission '%s': joint '%s' already has transmission '%s'; this one is "
                        "left out", made.name, made.joint, found[made.joint].name)
            continue
        found[made.joint] = made
    return list(found.values())


def _read(element: Element) -> Transmission | None:
    name = element.get("name", "")
    if not name:
        log.error("A <transmission> has no name; it is left out")
        return None
    wrong = _fault(element)
    if wrong:
        log.error("transmission '%s' is left out: %s", name, wrong)
        return None
    joints = element.findall("joint")
    if len(joints) > 1:
        log.warning("Transmission %s has more than one joint. Currently the default robot hardware "
                    "simulation interface only supports one. It is left out.", name)
        return None
    return Transmission(name, joints[0].get("name", ""), _interface(joints[0], name))


def _fault(element: Element) -> str:
    """Why a transmission is invalid; empty if it is valid."""
    if not (element.findtext("type") or "").strip():
        return "it has no <type>; usual is transmission_interface/SimpleTransmission"
    for tag in ("joint", "actuator"):
        if element.find(tag) is None:
            return f"it has no <{tag}>"
        if any(not part.get("name") for part in element.findall(tag)):
            return f"a <{tag}> of it has no name"
    for joint in element.findall("joint"):
        if not _interfaces(joint):
            where = ("; its actuator has one, which belongs into the <joint>"
                     if _interfaces(element.find("actuator")) else "")
            return ("No valid hardware interface element found in joint "
                    f"'{joint.get('name')}'{where}. Failed to load joints for transmission "
                    f"'{element.get('name')}'.")
    return ""


def _interfaces(element: Element) -> list[str]:
    texts = [(found.text or "").strip() for found in element.findall("hardwareInterface")]
    return [text for text in texts if text]


def _interface(joint: Element, transmission: str) -> str:
    name, texts = joint.get("name"), _interfaces(joint)
    if len(texts) > 1:
        log.warning("Joint %s of transmission %s specifies multiple hardware interfaces. Currently "
                    "the default robot hardware simulation interface only supports one. Using the "
                    "first entry, %s", name, transmission, texts[0])
    plain = texts[0].removeprefix(PREFIX)
    if plain not in INTERFACES:
        known = ", ".join(PREFIX + known for known in INTERFACES)
        raise FormatError(f"No matching hardware interface found for '{texts[0]}' while loading "
                          f"interfaces for {name} (transmission {transmission}); there are: "
                          f"{known}")
    if plain == texts[0]:
        log.warning("Deprecated syntax, please prepend 'hardware_interface/' to '%s' within the "
                    "<hardwareInterface> tag in joint '%s'.", plain, name)
    return INTERFACES[plain]
