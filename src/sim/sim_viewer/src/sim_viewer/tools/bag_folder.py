"""The folder of bags: safe file names, the list of bags, the contents of a bag."""

import re
import time
from collections import Counter
from pathlib import Path
from typing import Any

import rosbag

from sim_viewer.registry import Refused

DEFAULT_FOLDER = "~/bags"
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,79}")
MOST_LISTED = 500


def bag_folder(wanted: str) -> Path:
    """The folder of bags, by the option `bags`; made when the first is recorded."""
    return Path(wanted or DEFAULT_FOLDER).expanduser().resolve()


def bag_path(folder: Path, name: str) -> Path:
    """The file of a bag, inside the folder and nowhere else; Refused for other names."""
    if not NAME.fullmatch(name):
        raise Refused(f"{name!r:.60} is not a name for a bag: letters, digits, _ - and . only, "
                      "80 at most")
    path = folder / (name if name.endswith(".bag") else name + ".bag")
    if path.resolve().parent != folder.resolve():
        raise Refused(f"{name} leads out of {folder}")
    return path


def existing_bag(folder: Path, name: str) -> Path:
    """As `bag_path`; Refused if there is no such bag."""
    path = bag_path(folder, name)
    if not path.is_file():
        raise Refused(f"there is no {path.name} in {folder}")
    return path


def new_bag(folder: Path, name: str) -> Path:
    """The file to record into; without a name it is named after the time. Refused if it exists."""
    path = bag_path(folder, name or time.strftime("%Y-%m-%d-%H-%M-%S"))
    if path.exists() or path.with_name(path.name + ".active").exists():
        raise Refused(f"{path.name} exists already; choose another name")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise Refused(f"cannot make {folder}: {error.strerror}") from None
    return path


def listing(folder: Path) -> list[dict[str, Any]]:
    """`[{name, size: byte, changed: s since 1970}]`, the newest first."""
    if not folder.is_dir():
        return []
    found = []
    for path in folder.glob("*.bag"):
        try:
            facts = path.stat()
        except OSError:
            continue  # deleted meanwhile, or a link to nowhere
        found.append({"name": path.name, "size": facts.st_size, "changed": facts.st_mtime})
    return sorted(found, key=lambda bag: (-bag["changed"], bag["name"]))[:MOST_LISTED]


def contents(path: Path) -> dict[str, Any]:
    """`{duration: s, start, messages, topics: [{name, type, count}]}`, as `rosbag info`; Refused
    for a bag that is damaged or was not closed."""
    try:
        with rosbag.Bag(str(path)) as bag:
            topics = _topics(bag)
            messages = bag.get_message_count()
            start, end = (bag.get_start_time(), bag.get_end_time()) if messages else (0.0, 0.0)
    except rosbag.ROSBagUnindexedException:
        raise Refused(f"{path.name} was not closed; type: rosbag reindex {path}") from None
    except (rosbag.ROSBagException, OSError, ValueError, KeyError) as error:
        raise Refused(f"{path.name} cannot be read: {error}") from None
    return {"duration": end - start, "start": start, "messages": messages,
            "topics": [{"name": name, "type": kind, "count": count}
                       for name, (kind, count) in sorted(topics.items())]}


def _topics(bag: rosbag.Bag) -> dict[str, tuple[str, int]]:
    """Type and number of messages by topic; `get_type_and_topic_info` takes the square of their
    number: 7 s for 4000 topics."""
    counts: Counter[int] = Counter()
    for chunk in bag._chunks:
        counts.update(chunk.connection_counts)
    found: dict[str, tuple[str, int]] = {}
    for number, connection in bag._connections.items():
        kind, count = found.get(connection.topic, (connection.datatype, 0))
        found[connection.topic] = kind, count + counts[number]
    return found
