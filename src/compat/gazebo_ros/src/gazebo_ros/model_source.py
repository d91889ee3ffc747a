"""Where spawn_model takes its XML from, with upstream's message for each way that can fail."""

import os
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
    content, place = _read(options), _place(options)
    if isinstance(content, bytes) and (line := _first_line_that_is_not_utf8(content)):
        raise SourceError(f"Invalid XML: {place}, line {line}: not UTF-8; save it as UTF-8")
    try:
        root = ElementTree.fromstring(content)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        xacro = b"xacro:" if isinstance(content, bytes) else "xacro:"
        advice = f"; {_run_xacro(options)}" if xacro in content else ""
        raise SourceError(f"Invalid XML: {error} ({place}){advice}") from None
    if _is_unprocessed(root):
        raise SourceError(f"Error: {place} has xacro's tags in it, which Gazebo does not read; "
                          f"{_run_xacro(options)}")
    if options.package_to_model:
        for mesh in root.iter("mesh"):
            name = mesh.get("filename", "")
            if name.startswith("package://"):
                mesh.set("filename", "model" + name.removeprefix("package"))
    return ElementTree.tostring(root).decode("ascii")


def _place(options) -> str:
    """Where the XML is from, for an error's line."""
    if options.file is not None:
        return f"file {options.file}"
    return "stdin" if options.param is None else f"parameter {rospy.resolve_name(options.param)}"


def _first_line_that_is_not_utf8(content: bytes) -> int:
    """Its number; 0 if there is none, or if the text says UTF-16 by its first bytes."""
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return 0
    try:
        content.decode("utf-8")
    except UnicodeDecodeError as error:
        return content.count(b"\n", 0, error.start) + 1
    return 0


def _is_unprocessed(root: ElementTree.Element) -> bool:
    """Whether xacro has still to be run: its tags and its ${} are there, or macros."""
    tags = {each.tag.rpartition("}")[2] for each in root.iter()
            if "xacro" in each.tag.rpartition("}")[0]}
    values = [value for each in root.iter() for value in each.attrib.values()]
    return bool(tags & {"macro", "include", "property"}
                or (tags and any("${" in value or "$(" in value for value in values)))


def _run_xacro(options) -> str:
    if options.file is not None:
        written = options.file.removesuffix(".xacro").removesuffix(".urdf") + ".urdf"
        if written == options.file:  # the shell would empty it before xacro reads it
            written = written.removesuffix(".urdf") + "_processed.urdf"
        return f"run xacro first: rosrun xacro xacro {options.file} > {written}"
    if options.param is not None:
        return (f'run xacro first: <param name="{options.param}" '
                'command="$(find xacro)/xacro FILE"/>')
    return "run xacro first: rosrun xacro xacro FILE | rosrun gazebo_ros spawn_model ..."


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
    try:
        return _not_empty(sys.stdin.read(), "Error: stdin buffer was empty")
    except UnicodeDecodeError:
        raise SourceError("Invalid XML: stdin: not UTF-8; save the file as UTF-8") from None


def _from_file(name: str) -> bytes:
    path = Path(name)
    if not path.exists():
        meant = os.path.expanduser(os.path.expandvars(name))
        advice = "" if meant == name else f"; ~ and $ are not expanded here: write {meant}"
        raise NoSuchFileError(f"Error: specified file {name} does not exist{advice}")
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
