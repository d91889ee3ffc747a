"""Where spawn_model takes its XML from, with upstream's message for each way that can fail."""

import sys
from pathlib import Path
from xml.etree import ElementTree

import rospy

DATABASE_WORLD = (
    '<sdf version="1.4"><world name="default">'
    "<include><uri>model://{}</uri></include></world></sdf>"
)


class SourceError(Exception):
    """No usable XML; the message is the line to log."""


class NoSuchFileError(SourceError):
    """The one kind that upstream logs as fatal."""


def load(options) -> str:
    """The model's XML, parsed and written anew in ASCII as upstream does."""
    try:
        root = ElementTree.fromstring(_read(options))
    except ElementTree.ParseError as error:
        raise SourceError(f"Invalid XML: {error}") from None
    if options.package_to_model:
        for mesh in root.iter("mesh"):
            name = mesh.get("filename", "")
            if name.startswith("package://"):
                mesh.set("filename", "model" + name.removeprefix("package"))
    return ElementTree.tostring(root).decode("ascii")


def _read(options) -> str | bytes:
    if options.file is not None:
        rospy.loginfo(f"Loading model XML from file {options.file}")
        return _from_file(options.file)
    if options.param is not None:
        rospy.loginfo(f"Loading model XML from ros parameter {options.param}")
        return _from_parameter(options.param)
    if options.database is not None:
        rospy.loginfo("Loading model XML from Gazebo Model Database")
        return DATABASE_WORLD.format(options.database)
    rospy.loginfo("Loading model XML from stdin")
    return _not_empty(sys.stdin.read(), "Error: stdin buffer was empty")


def _from_file(name: str) -> bytes:
    path = Path(name)
    if not path.exists():
        raise NoSuchFileError(f"Error: specified file {name} does not exist")
    if not path.is_file():
        raise NoSuchFileError(f"Error: specified file {name} is not a file")
    try:
        content = path.read_bytes()
    except OSError as error:
        raise SourceError(f"Error reading file {name}: {error}") from None
    return _not_empty(content, f"Error: file {name} is empty")


def _from_parameter(name: str) -> str:
    try:
        value = rospy.get_param(name)
    except KeyError:
        there = [known for known in rospy.get_param_names() if known.endswith("robot_description")]
        raise SourceError(
            f"Error: parameter {rospy.resolve_name(name)} is not set; "
            f"there are: {', '.join(sorted(there)) or 'none that end in robot_description'}"
        ) from None
    return _not_empty(str(value), "Error: param does not exist or is empty")


def _not_empty(content: str | bytes, message: str) -> str | bytes:
    if not content:
        raise SourceError(message)
    return content
