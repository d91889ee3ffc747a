"""Pieces of robots in xacro, and what came out of them."""

from pathlib import Path
from xml.etree import ElementTree

NAMESPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
ARGUMENT = '<xacro:arg name="n" default="3"/>'
SET = '<xacro:property name="p" value="9"/>'


def written(path: Path, inside: str, namespace: str = NAMESPACE) -> Path:
    """The file, with a robot that has this inside."""
    path.write_text(f'<robot name="r" {namespace}>{inside}</robot>', encoding="utf-8")
    return path


def names(text: str, tag: str = "link") -> list[str]:
    """The names of the links that came out, or of other elements."""
    return [element.get("name") for element in ElementTree.fromstring(text).iter(tag)]


def one_link(expression: str, before: str = "") -> str:
    """A link of that name."""
    return f'{before}<link name="{expression}"/>'


def macro(params: str, inside: str) -> str:
    """A macro named m."""
    return f"<xacro:macro name='m' params=\"{params}\">{inside}</xacro:macro>"
