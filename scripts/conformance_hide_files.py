"""Hides constructs of xacro, arguments of launch files, models and worlds."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path
from xml.dom import minidom

import rospkg
from roslaunch.xmlloader import XmlLoader

from bullet_sim.errors import ResourceNotFound
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.xacro import files, opening  # noqa: F401  (the former's are changed)

# Text to remove from a xacro file, as minidom writes it, and its replacement. Without an entry
# here, `a` of "xacro tags" is an element, of other rows an attribute, and `$(a)` is itself.
XACRO = {
    "xacro substitutions/$$": (r"\$\$", "$"),
    "xacro expressions/arithmetic": (r"(\$\{[\w ]+)[-+*/][^}]*", r"\1"),
    "xacro expressions/math": (r"(math\.\w+|sin|radians)\(", "abs("),
    "xacro expressions/lists and dicts": (r"\$\{[^}]*(\[|dict)[^}]*\}", ""),
    "xacro expressions/python.*": (r"python\.", ""),
    "xacro expressions/load_yaml": (r"(?<!\.)load_yaml", "hidden"),
    "xacro expressions/xacro.load_yaml": (r"xacro\.load_yaml", "hidden"),
    "xacro expressions/xacro.arg": (r"xacro\.arg", "hidden"),
    "xacro macro": (r"(?s)<xacro:macro.*</xacro:macro>", ""),
    "xacro macro/default :=": (r"(\w):=(?!\^)('[^']*'|\w+)", r"\1"),
    "xacro macro/default =": (r'(params="[^"]*\w)=\w+', r"\1"),
    "xacro macro/default ^": (r":=\^(?!\|)", ""),
    "xacro macro/default ^|": (r":=\^\|\w+", ""),
    "xacro macro/*block": (r'(params="[^"*]*)\*\w+', r"\1"),
    "xacro macro/**block": (r"\*\*\w+", ""),
    "xacro macro/nested": (r"(?s)(<xacro:macro[^>]*>)<xacro:macro.*?</xacro:macro>", r"\1"),
    "xacro macro/recursive": (r"(?s)(<xacro:macro.*)<xacro:m [^>]*/>(.*</xacro:macro>)", r"\1\2"),
    "xacro macro/xacro:call": (r"<xacro:call[^>]*/>", ""),
    "xacro property": (r"<xacro:property[^>]*/>", ""),
    "xacro property/scope parent": (r'scope="parent"', ""),
    "xacro property/scope global": (r'scope="global"', ""),
    "xacro property/block": (r"(?s)<xacro:property[^>/]*>.*?</xacro:property>", ""),
    "xacro include": (r"<xacro:include[^>]*/>", ""),
    "xacro include/glob": (r'(<xacro:include [^>]*)\*', r"\1"),
    "xacro tags/arg": (r"<xacro:arg[^>]*/>", ""),
}


def put_in_place_of(original: Callable, other: Callable) -> None:
    """Replace a function in every module that has it by this name."""
    for module in list(sys.modules.values()):
        if getattr(module, original.__name__, None) is original:
            setattr(module, original.__name__, other)


def hide(name: str) -> bool:
    """Hide it; False if this module cannot."""
    row, _, tag = name.rpartition("/")
    if name.startswith("xacro "):
        _hide_in_xacro(name, row, tag)
    elif row.endswith(".launch"):
        _hide_argument(row, tag)
    elif row.startswith("models: "):
        _hide_model(tag)
    elif name.startswith("worlds/") or row == "gazebo_plugins test_worlds":
        _hide_text(name if name.startswith("worlds/") else f"{tag}.world")
    elif row.startswith("find_package"):
        _hide_package(tag)
    else:
        return False
    return True


def _hide_in_xacro(name: str, row: str, tag: str) -> None:
    if name in XACRO:
        pattern, instead = XACRO[name]
    elif tag.startswith("$"):
        pattern, instead = re.escape(tag[:-1]) + r"\b[^)]*\)", ""
    elif row == "xacro tags":
        pattern, instead = rf"(?s)</?xacro:{tag}\b[^>]*>", ""
    else:
        pattern, instead = rf'\b{tag}="[^"]*"', ""
    read = opening.parse

    def parse(source: object, filename: str) -> minidom.Document:
        return minidom.parseString(re.sub(pattern, instead, read(source, filename).toxml()))

    put_in_place_of(read, parse)


def _hide_argument(file: str, argument: str) -> None:
    """Ignore the argument's value on the command line."""
    load = XmlLoader.load

    def without(self, filename, config, core=False, argv=None, verbose=True):
        if Path(filename).name == file:
            argv = [word for word in argv or () if not word.startswith(f"{argument}:=")]
        return load(self, filename, config, core, argv, verbose)

    XmlLoader.load = without


def _hide_model(name: str) -> None:
    resolve = Resources.resolve

    def without(self, uri, base=None):
        if uri.strip() == f"model://{name}":
            raise ResourceNotFound(uri)
        return resolve(self, uri, base)

    Resources.resolve = without


def _hide_text(ending: str) -> None:
    read_text = Path.read_text

    def without(self, *args, **options):
        if str(self).endswith(f"/{ending}"):
            raise FileNotFoundError(str(self))
        return read_text(self, *args, **options)

    Path.read_text = without


def _hide_package(name: str) -> None:
    get_path = rospkg.RosPack.get_path

    def without(self, wanted):
        if wanted == name:
            raise rospkg.ResourceNotFound(wanted)
        return get_path(self, wanted)

    rospkg.RosPack.get_path = without
