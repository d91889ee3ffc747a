"""What a browser may send to the page's server: HTTP, WebSocket messages, filled-in forms."""

from __future__ import annotations

import asyncio
import inspect
import io
import json
import os
import random
import re
import socket
from pathlib import Path
from typing import Any
from unittest import mock

from gazebo_msgs.srv import SetModelState, SetPhysicsProperties, SpawnModel
from mutating import BINARY, TEXT, WORDS, spoilt
from sensor_msgs.msg import Joy, LaserScan
from sim_viewer import hub, registry
from sim_viewer.options import Options
from sim_viewer.registry import Context, Node, Refused
from sim_viewer.server import Server
from sim_viewer.tools.messages import fill, template
from target import Target

from bullet_sim_ros.without_master import without_master

registry.load_all()
STARTING = ("record", "play")  # programs of their own
VALUES = [None, True, -1, 0, 1, 1e308, 2**70, "", "x" * 3000, "/cmd_vel", "../../etc/passwd",
          "\0", "\ud800", "a\nb", "机器人", [], [[]], {}, {"a": {"b": []}}, "/gazebo", "data",
          "1e999"]
EXAMPLES = {"name": "/gazebo", "topic": "/cmd_vel", "topics": ["/odom"], "value": "1",
            "tool": "goal", "frame": "map", "path": "/odom/pose", "request": "{}",
            "field": "/odom/pose"}
NOT_MEANT = re.compile(r"(Type|Value|Key|Index|Attribute|ZeroDivision|Overflow|Runtime|Recursion|"
                       r"Unicode\w*|Assertion|Memory)Error: |(^|: )error: ")
KEY = b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
UPGRADE = (b"GET /ws HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
           + KEY)
PATIENCE = 0.5  # s, wall, for an answer: none is needed


def ask(path: Path) -> None:
    """One message of a browser that may do all."""
    text = path.read_text("utf-8", errors="replace")
    nowhere = mock.patch.dict(os.environ, ROS_MASTER_URI="http://127.0.0.1:9")
    with without_master("/sim_viewer"), nowhere:
        for answer in asyncio.run(_answers(text)):
            said = json.loads(answer).get("error", "")
            if NOT_MEANT.search(said):
                raise RuntimeError(said)


async def _answers(text: str) -> list[str]:
    node = Node(Options(control=True, bags="/proc/none"), asyncio.get_running_loop())
    client = hub.Client(None, Context(node, 1), hub.speaker("zh_CN"))
    client._take(text)
    await asyncio.wait([*client._tasks, asyncio.ensure_future(asyncio.sleep(0))], timeout=PATIENCE)
    answers = list(client._outbox._answers)
    await client.close()
    node.close()
    return answers


def request(path: Path) -> None:
    """Bytes on a connection."""
    answer = asyncio.run(_exchange(path.read_bytes()))
    if answer and not re.match(rb"HTTP/(?:0\.9|1\.[01]) ([1234]\d\d|501|505) ", answer):
        raise RuntimeError(f"answers {answer[:100]!r}")


async def _exchange(content: bytes) -> bytes:
    node = Node(Options(port=_free_port()), asyncio.get_running_loop())
    server = Server(node)
    port = await server.start()
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        writer.write(content)
        return await asyncio.wait_for(reader.read(1 << 16), PATIENCE)
    except (ConnectionError, TimeoutError):
        return b""
    finally:
        writer.close()
        await server.close()
        node.close()


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def _messages() -> list[bytes]:
    """A good one for each operation and each thing to watch."""
    asked = [{"id": 1, "op": name, **{key: EXAMPLES.get(key, _example(of.annotation)) for key, of in
                                      list(inspect.signature(one.function).parameters.items())[1:]}}
             for name, one in sorted(registry._operations.items()) if name not in STARTING]
    asked += [{"id": 1, "op": "watch", "what": name, "args": EXAMPLES}
              for name in sorted(registry._watchables)]
    return [json.dumps(one).encode() for one in [*asked, {"id": 2, "op": "unwatch", "watch": 1}]]


def _example(annotation: Any) -> Any:
    return {str: "a", int: 1, float: 0.5, bool: True, dict: {}, list: []}.get(annotation, "a")


def value_put(content: bytes, rng: random.Random) -> bytes:
    """One value of a JSON object is another, at the top or one below."""
    try:
        whole = json.loads(content)
        inside = [one for one in whole.values() if isinstance(one, dict) and one]
        place = rng.choice([whole, *inside])
        key = rng.choice(sorted(place))
        if key != "op":
            place[key] = rng.choice(VALUES)
    except (ValueError, AttributeError, IndexError, RecursionError):
        return rng.choice(WORDS)
    return json.dumps(whole).encode()


def frame(kind: int, data: bytes) -> bytes:
    """A masked WebSocket frame of at most 125 bytes."""
    return bytes((0x80 | kind, 0x80 | len(data))) + b"\0" * 4 + data


REQUESTS = [b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n",
            b"GET /mesh/1 HTTP/1.1\r\nHost: 127.0.0.1\r\nRange: bytes=0-10\r\n\r\n",
            b"GET /main.js?token=a HTTP/1.1\r\nHost: localhost\r\nIf-None-Match: \"a\"\r\n"
            b"Cookie: a=b\r\nOrigin: http://localhost\r\n\r\n",
            b"POST /texture/2 HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\n\r\na=b",
            UPGRADE + b"\r\n" + frame(1, b'{"id":1,"op":"about"}') + frame(2, b"\0\1")
            + frame(9, b"a") + frame(8, b"\x03\xe8"),
            UPGRADE + b"\r\n" + frame(1, b'{"id":1,')[:1].replace(b"\x81", b"\x01")
            + frame(1, b'{"id":1,')[1:] + frame(0, b'"op":"about"}')]


KINDS = (SpawnModel._request_class, SetModelState._request_class,
         SetPhysicsProperties._request_class, LaserScan, Joy)


def fill_in(path: Path) -> None:
    """A form of the kind that takes it, and the message as it would be sent."""
    text = path.read_text("utf-8", errors="replace")
    fill(kind_of(text), text).serialize(io.BytesIO())


def kind_of(text: str) -> type:
    """The kind of which the text has the most fields, for how many there are."""
    return max(KINDS, key=lambda kind: sum(
        f"{name}:" in text for name in kind.__slots__) / len(kind.__slots__))


TARGETS = (
    Target("page", "message.json", spoilt(_messages(), (value_put,) * 6 + TEXT), ask, ()),
    Target("http", "request", spoilt(REQUESTS, TEXT + BINARY), request, ()),
    Target("form", "form.yaml", spoilt([template(kind).encode() for kind in KINDS], TEXT), fill_in,
           (Refused,)),
)
