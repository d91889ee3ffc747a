"""Errors in xacro files as one line for users: where, what, what to do."""

import os
import re
from pathlib import Path
from xml.parsers.expat import ExpatError

import xacro
from xacro import substitution_args

from bullet_sim.errors import FormatError

NAMESPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
LONGEST = 600  # characters of a line
UNSET = re.compile(r"environment variable '(\w+)' is not set")


def located(error: BaseException, path: str) -> str:
    """Place and reason; `path` is the requested file."""
    where, reason = place(path), _reason(error)
    text = reason if reason.startswith(where) else f"{where}: {reason}"
    return text if len(text) <= LONGEST else text[:LONGEST] + " …"


def place(default: str) -> str:
    """The file being read, and the macro being expanded in it."""
    place = xacro.filestack[-1] if xacro.filestack else default
    if xacro.macrostack:
        place += f": macro {xacro.macrostack[-1].body.getAttribute('name')}"
    return place


def root_of(error: BaseException) -> BaseException:
    """The innermost exception of xacro's wrapping ones."""
    while getattr(error, "exc", None) is not None:
        error = error.exc
    return error


def _reason(error: BaseException) -> str:
    """The text of an exception for users."""
    root = root_of(error)
    if isinstance(root, FormatError):
        return one_line(str(root))
    if isinstance(root, RecursionError):
        return ("macros call each other without end, or elements are nested too deep; end the "
                "calls with an <xacro:if>")
    if isinstance(root, MemoryError):
        return "an expression or macro needs more memory than there is; make it smaller"
    if isinstance(root, OSError) and isinstance(error, xacro.XacroException):
        return one_line(error.args[0] or str(root))
    if isinstance(root, substitution_args.ArgException):
        return f"argument {root} has no value: pass {root}:=VALUE or give its xacro:arg a default"
    if isinstance(root, substitution_args.SubstitutionException):
        return f"{one_line(str(root))}{_variable_hint(str(root))}"
    if isinstance(root, ExpatError):
        return f"XML error: {root}{_xml_hint(root)}"
    text = one_line(str(error))
    if not text or text.startswith("<class"):  # xacro's text for something unexpected
        text = f"{type(root).__name__}: {one_line(str(root))}"
    if text.startswith("unknown macro name: xacro:"):
        name = text.rpartition("xacro:")[2]
        return f'{text}; include the file with <xacro:macro name="{name}"> before it is called'
    if isinstance(root, NameError):
        text = text.replace("NameError: name '", "$(eval …): argument '", 1)
        return text.replace("name '", "property '", 1)
    return text


def includes_itself(files: list[str]) -> str:
    """The message for a stack of files in which the last one is repeated."""
    other = os.path.normpath(files[-2])
    if other == os.path.normpath(files[-1]):
        return "the file includes itself without end; put the <xacro:include> into an <xacro:if>"
    return f"this file and {other} include each other without end; remove one include"


def _variable_hint(text: str) -> str:
    """How to set a missing environment variable."""
    named = UNSET.match(text)
    return f"; type export {named[1]}=VALUE, or write $(optenv {named[1]} DEFAULT)" if named else ""


def _xml_hint(error: ExpatError) -> str:
    """Advice for the usual mistakes."""
    text = str(error)
    if text.startswith("unbound prefix"):
        return f"; declare it in the <robot> tag, such as {NAMESPACE}"
    if "entit" in text:
        return "; write the entity's text where it is used"
    if text.startswith("not well-formed") and not _is_utf8():
        return "; the file is not UTF-8, save it as UTF-8"
    return ""


def _is_utf8() -> bool:
    try:
        Path(xacro.filestack[-1]).read_bytes().decode()
    except (UnicodeDecodeError, OSError):
        return False
    return True


def one_line(text: str) -> str:
    """With single spaces for any white space."""
    return " ".join(text.split())
