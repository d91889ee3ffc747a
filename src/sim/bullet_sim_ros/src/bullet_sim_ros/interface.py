"""The support table of Gazebo's interface, as data: the files of the folder interface/.

One file per section. A row is a plugin, service, topic, parameter, program flag, launch file or
element of a format; its tags are what can be written inside. The README's table, `check` and the
tests all read these files.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import rospkg
import yaml

WORKS, APPROXIMATED, ACCEPTED, ABSENT = STATUSES = ("works", "approximated", "accepted", "absent")
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # libyaml's is six times as fast
KINDS = ("sensor", "actuator", "world", "visual")  # what a plugin is for


class InterfaceError(ValueError):
    """A file of the table is invalid; the message names file and key."""


@dataclass(frozen=True)
class Entry:
    """How one element of the interface is supported; `how` describes it unless it simply works."""

    name: str
    status: str
    how: str = ""
    how_zh: str = ""


@dataclass(frozen=True)
class Row(Entry):
    """An entry with what can be written inside of it."""

    does: str = ""  # of a plugin: one of KINDS
    tags: dict[str, Entry] = field(default_factory=dict)

    def names(self) -> Iterator[tuple[str, Entry]]:
        """`ROW` and each `ROW/TAG`, as tests name them."""
        yield self.name, self
        for tag in self.tags.values():
            yield f"{self.name}/{tag.name}", tag


@dataclass(frozen=True)
class Section:
    """The rows of one file."""

    title: str
    title_zh: str
    rows: tuple[Row, ...]


def read_interface(folder: Path | None = None) -> list[Section]:
    """All sections, by file name; InterfaceError names what is wrong.

    `folder`: where the files are, if not in the package's interface/.
    """
    folder = folder or Path(rospkg.RosPack().get_path("bullet_sim_ros")) / "interface"
    sections = [_read_section(path) for path in sorted(folder.glob("*.yaml"))]
    seen: dict[str, str] = {}
    for section in sections:
        for row in section.rows:
            if row.name in seen:
                raise InterfaceError(f"{row.name!r} is there twice: in {seen[row.name]!r} and "
                                     f"{section.title!r}")
            seen[row.name] = section.title
    return sections


def rows_by_name(sections: list[Section]) -> dict[str, Row]:
    """All rows, by name."""
    return {row.name: row for section in sections for row in section.rows}


@cache
def documented() -> dict[str, Row]:
    """All rows of the package's own files, by name; read once."""
    return rows_by_name(read_interface())


def _read_section(path: Path) -> Section:
    try:
        content = yaml.load(path.read_text(encoding="utf-8"), Loader=_LOADER)
    except yaml.YAMLError as error:
        raise InterfaceError(f"{path.name}: {error}") from None
    values = _known(content, {"title", "title_zh", "rows"}, path.name)
    rows = tuple(_read_row(row, path.name) for row in values["rows"])
    return Section(str(values["title"]), str(values["title_zh"]), rows)


def _read_row(content: Any, where: str) -> Row:
    values = _known(content, {"name", "status", "how", "how_zh", "does", "tags"}, where)
    name = str(values.get("name", ""))
    where = f"{where}: {name!r}"
    if not name:
        raise InterfaceError(f"{where}: a row needs a name")
    does = str(values.get("does") or "")
    if does and does not in KINDS:
        raise InterfaceError(f"{where}: does is {does!r}, none of {', '.join(KINDS)}")
    tags = {str(tag): _read_tag(str(tag), value, where)
            for tag, value in (values.get("tags") or {}).items()}
    entry = _entry(name, values, where)
    return Row(entry.name, entry.status, entry.how, entry.how_zh, does, tags)


def _read_tag(name: str, value: Any, where: str) -> Entry:
    where = f"{where}: tag {name!r}"
    if isinstance(value, str):
        value = {"status": value}
    return _entry(name, _known(value, {"status", "how", "how_zh"}, where), where)


def _entry(name: str, values: dict, where: str) -> Entry:
    status = str(values.get("status"))
    how, how_zh = str(values.get("how") or ""), str(values.get("how_zh") or "")
    if status not in STATUSES:
        raise InterfaceError(f"{where}: status is {status!r}, none of {', '.join(STATUSES)}")
    if status in (APPROXIMATED, ABSENT) and not (how and how_zh):
        raise InterfaceError(f"{where}: {status} needs how and how_zh")
    return Entry(name, status, how, how_zh)


def _known(content: Any, keys: set[str], where: str) -> dict:
    if not isinstance(content, dict):
        raise InterfaceError(f"{where}: {content!r} is not a mapping")
    for key in content:
        if key not in keys:
            raise InterfaceError(f"{where}: unknown key {key!r}; there are {', '.join(keys)}")
    return content
