"""Recording and playing bags: `rosbag record` and `play` as child processes, and their folder."""

import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from collections import Counter
from pathlib import Path
from typing import Any

import rosbag
import rosgraph
from roslib.packages import find_node

from sim_viewer.registry import Refused, operation, watchable
from sim_viewer.tools.paced import Paced

DEFAULT_FOLDER = "~/bags"
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,79}")
MOST_LISTED = 500
LEAST_FREE = 1 << 30  # bytes on the disk; recording ends before it is full
TIMEOUT = 10.0  # s for a bag to be closed
RATES = (0.01, 100.0)


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


class Child:
    """`record` or `play` of package rosbag; interrupted when this process dies, which closes a bag.

    The command `rosbag` is not used: it takes a second to start, and loses the bag if stopped
    before. Refused if rosbag is not installed.
    """

    def __init__(self, program: str, arguments: list[str], path: Path):
        found = find_node("rosbag", program)
        if not found:
            raise Refused(f"package rosbag has no {program} here; type: apt install rosbag")
        self.path = path
        self.started = time.monotonic()
        self._output = tempfile.TemporaryFile()  # noqa: SIM115 (closed with the object)
        self._process = subprocess.Popen(
            ["setpriv", "--pdeathsig", "INT", found[0], *arguments], stdin=subprocess.DEVNULL,
            stdout=self._output, stderr=subprocess.STDOUT, start_new_session=True)

    @property
    def running(self) -> bool:
        return self._process.poll() is None

    @property
    def failure(self) -> str:
        """Its last line of output if it failed by itself, else empty."""
        if self._process.poll() in (None, 0, -signal.SIGINT):
            return ""
        self._output.seek(0)
        lines = self._output.read().decode(errors="replace").strip().splitlines()
        return lines[-1] if lines else f"rosbag ended with {self._process.returncode}"

    def interrupt(self) -> None:
        """End it as Ctrl-C does; waits until the bag is closed."""
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            if self.running:
                self._process.send_signal(number)
            try:
                self._process.wait(TIMEOUT)
                return
            except subprocess.TimeoutExpired:
                continue

    def state(self) -> dict[str, Any]:
        """`{name, seconds, size}` for the page; the size grows in `NAME.bag.active`."""
        growing = self.path.with_name(self.path.name + ".active")
        file = growing if growing.exists() else self.path
        return {"name": self.path.name, "seconds": round(time.monotonic() - self.started, 1),
                "size": file.stat().st_size if file.exists() else 0}


class Bags:
    """At most one recording and one playback, shared by all pages."""

    def __init__(self, node: Any):
        self.folder = bag_folder(node.options.bags)
        self._lock = threading.Lock()  # for the two below
        self._recording: Child | None = None
        self._playing: Child | None = None
        self.note = ""  # why something ended by itself

    def record(self, name: str, topics: list[str]) -> str:
        """Start recording; no topics: all. Call it from a thread that lasts until the process ends.

        Refused: a bag is being recorded, invalid name or topics, a full disk.
        """
        for topic in topics:
            check_topic(topic)
        with self._lock:
            if self._recording and self._recording.running:
                raise Refused(f"{self._recording.path.name} is being recorded; stop it first")
            path = new_bag(self.folder, name)
            self._check_disk()
            self.note = ""
            self._recording = Child("record", ["--quiet", "-O", str(path), *(topics or ["--all"])],
                                    path)
        threading.Thread(target=self._guard, args=(self._recording,), daemon=True).start()
        return path.name

    def play(self, name: str, rate: float, loop: bool, clock: bool) -> str:
        """Start playing; the same thread rule as for `record`.

        Refused: a bag is being played, invalid rate, no such bag.
        """
        if not RATES[0] <= rate <= RATES[1]:
            raise Refused(f"rate is {rate:g}; give {RATES[0]:g} to {RATES[1]:g}")
        with self._lock:
            if self._playing and self._playing.running:
                raise Refused(f"{self._playing.path.name} is being played; stop it first")
            path = existing_bag(self.folder, name)
            self.note = ""
            options = ["--loop"] * loop + ["--clock"] * clock
            self._playing = Child("play", ["--quiet", "--rate", f"{rate:g}", *options, str(path)],
                                  path)
        return path.name

    def stop(self, what: str) -> None:
        """Stop `record` or `play`, if it runs."""
        child = self._recording if what == "record" else self._playing
        if child:
            child.interrupt()

    def state(self) -> dict[str, Any]:
        """`{folder, recording, playing, note, bags}`; the two are null or a child's state."""
        children = (self._recording, self._playing)
        recording, playing = (c.state() if c and c.running else None for c in children)
        failures = [c.failure for c in children if c and c.failure]
        return {"folder": str(self.folder), "recording": recording, "playing": playing,
                "note": self.note or "; ".join(failures), "bags": listing(self.folder)}

    def close(self) -> None:
        """End both, and close the bag."""
        for child in (self._recording, self._playing):
            if child and child.running:
                child.interrupt()

    def _check_disk(self) -> None:
        try:
            free = shutil.disk_usage(self.folder).free
        except OSError as error:
            raise Refused(f"{self.folder}: {error.strerror}") from None
        if free < LEAST_FREE:
            raise Refused(f"only {free >> 20} MiB are free in {self.folder}; "
                          f"recording needs {LEAST_FREE >> 20}")

    def _guard(self, child: Child) -> None:
        while child.running:
            try:
                self._check_disk()
            except Refused as error:
                self.note = str(error)
                child.interrupt()
            time.sleep(1.0)


def check_topic(topic: Any) -> None:
    """Refused unless it is a full name, so that it cannot be an option of rosbag either."""
    if not isinstance(topic, str) or not topic.startswith("/") \
            or not rosgraph.names.is_legal_name(topic):
        raise Refused(f"{topic!r:.60} is not a topic's full name")


@watchable("bags")
class BagState(Paced):
    """Sends `Bags.state`, once a second where it changes."""

    PERIOD = 1.0

    def __init__(self, context: Any, args: dict[str, Any], send: Any):
        super().__init__(context, args, send)
        self._bags: Bags = context.node.shared(Bags)

    def collect(self) -> Any:
        return self.changed(self._bags.state())


@operation("bag_info")
async def bag_info(context: Any, name: str) -> dict[str, Any]:
    """The contents of a bag. Refused if there is no such bag."""
    path = existing_bag(context.node.shared(Bags).folder, name)
    return await context.run_in_thread(contents, path)


@operation("record", control=True)
async def record(context: Any, topics: list, name: str = "") -> str:
    """Start to record these topics, or all if there are none; answers with the bag's name."""
    # Here, in the loop's thread: the child is interrupted when the thread that made it ends.
    return context.node.shared(Bags).record(name, topics)


@operation("play", control=True)
async def play(context: Any, name: str, rate: float = 1.0, loop: bool = False,
               clock: bool = False) -> str:
    """Start to play a bag."""
    return context.node.shared(Bags).play(name, rate, loop, clock)


@operation("stop_record", control=True)
async def stop_record(context: Any) -> None:
    """Stop recording; answers when the bag is closed."""
    await context.run_in_thread(context.node.shared(Bags).stop, "record")


@operation("stop_play", control=True)
async def stop_play(context: Any) -> None:
    """Stop playing."""
    await context.run_in_thread(context.node.shared(Bags).stop, "play")
