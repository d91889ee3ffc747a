"""Driving from browsers: the operations. The process drive_guard.py publishes and stops."""

import asyncio
import json
import os
import subprocess
import sys
import threading
from typing import Any

import rosgraph
import rospy

from sim_viewer.drive_guard import MESSAGES
from sim_viewer.registry import Context, Node, Refused, operation
from sim_viewer.tools.master import asked, connect

FASTEST = 20.0  # m/s and rad/s; more is a mistake, whatever the robot
TIMEOUT = 15.0  # s until the guard has started and opened a topic, on a busy machine
GUARD = "_drive"  # appended to this node's name for that of the guard


class Teleop:
    """The guard's process, started with the first topic driven; all methods run in the loop."""

    def __init__(self, node: Node) -> None:
        self._loop = node.loop
        self._guard: subprocess.Popen | None = None
        self._topics: dict[str, str] = {}  # opened by the guard, with their types
        self._number = 0
        self._answers: dict[int, asyncio.Future] = {}
        self._known: set[int] = set()  # clients whose disconnection is handled

    def is_open(self, topic: str) -> bool:
        return topic in self._topics

    async def open(self, topic: str, kind: str) -> None:
        """Get ready to publish on a topic; Refused where that takes too long."""
        if self._guard is None:
            self._begin()
        await self._ask({"do": "open", "topic": topic, "type": kind})
        self._topics[topic] = kind

    async def press(self, context: Context, topic: str, linear: float, angular: float) -> None:
        """One message of a held key, in order; Refused where another client drives."""
        if context.client not in self._known:
            self._known.add(context.client)
            context.on_close(lambda: self._forget(context.client))
        # 0 instead of -0, which would not count as the same stop.
        answer = await self._ask({"do": "press", "client": context.client, "topic": topic,
                                  "linear": linear + 0.0, "angular": angular + 0.0})
        if answer["taken"]:
            raise Refused("somebody else drives now; let go of the keys, then press again")

    def release(self, client: int) -> None:
        """The client released the controls, or disconnected. Refused if the guard has ended."""
        if self._guard is not None:
            self._send_to_guard({"do": "release", "client": client})

    def close(self) -> None:
        """To be called when the node ends; the guard then stops all robots and ends, too."""
        if self._guard is not None:
            self._guard.stdin.close()

    def _forget(self, client: int) -> None:
        self._known.discard(client)
        self.release(client)

    def _begin(self) -> None:
        # A session of its own: Ctrl-C in the terminal must not end it before all robots stop.
        self._guard = subprocess.Popen(
            [sys.executable, "-m", "sim_viewer.drive_guard", f"__name:={_name()}",
             f"__ns:={rospy.get_namespace()}"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0, start_new_session=True)
        os.set_blocking(self._guard.stdin.fileno(), False)
        threading.Thread(target=self._listen, args=(self._guard,), daemon=True).start()

    def _listen(self, guard: subprocess.Popen) -> None:
        """Receive answers, in a thread of its own."""
        try:
            for line in guard.stdout:
                self._loop.call_soon_threadsafe(self._take, json.loads(line))
            guard.wait()
            self._loop.call_soon_threadsafe(self._ended, guard)
        except RuntimeError:
            pass  # the loop has ended

    def _take(self, answer: dict[str, Any]) -> None:
        waiting = self._answers.get(answer["number"])
        if waiting is not None and not waiting.done():
            waiting.set_result(answer)

    def _ended(self, guard: subprocess.Popen) -> None:
        if guard is not self._guard:
            return
        rospy.logwarn("the process that drives has ended with %s; it restarts", guard.returncode)
        topics, self._topics, self._guard = self._topics, {}, None
        for waiting in self._answers.values():
            waiting.cancel()
        self._stopping = self._loop.create_task(self._stop(topics))

    async def _stop(self, topics: dict[str, str]) -> None:
        """After a restart of the guard: stop whatever the last one drove."""
        for topic, kind in topics.items():
            try:
                await self.open(topic, kind)
                self._send_to_guard({"do": "stop", "topic": topic})
            except Refused as error:
                rospy.logwarn("%s: %s", topic, error)

    async def _ask(self, order: dict[str, Any]) -> dict[str, Any]:
        self._number += 1
        number, waiting = self._number, self._loop.create_future()
        self._answers[number] = waiting
        try:
            self._send_to_guard({**order, "number": number})
            done, _ = await asyncio.wait([waiting], timeout=TIMEOUT)
        finally:
            del self._answers[number]
        if not done or waiting.cancelled():
            raise Refused("the process that drives does not answer; press again")
        return waiting.result()

    def _send_to_guard(self, order: dict[str, Any]) -> None:
        line = json.dumps(order).encode() + b"\n"  # so short that a pipe takes all of it or nothing
        try:
            if self._guard.stdin.write(line) is None:
                raise Refused("the process that drives does not listen; press again")
        except (OSError, ValueError):
            pass  # it has ended, which `_listen` notices


def driven_topics() -> dict[str, str]:
    """Topics with a subscriber and a type that the page can publish, with that type, sorted.

    Refused if the master is gone.
    """
    types, (_, subscribers, _) = asked(lambda: (dict(connect().getTopicTypes()),
                                                connect().getSystemState()))
    listened = sorted(name for name, _ in subscribers)
    return {name: types[name] for name in listened if types.get(name) in MESSAGES}


@operation("drive_topics")
async def drive_topics(context: Context) -> list[dict[str, str]]:
    """What can be driven: [{"topic": name, "type": type}]."""
    found = await context.run_in_thread(driven_topics)
    return [{"topic": name, "type": kind} for name, kind in found.items()]


@operation("drive_open", control=True)
async def drive_open(context: Context, topic: str = "cmd_vel") -> dict[str, str]:
    """Get ready to drive, so that the first key is not lost while connections are made.

    Refused if no robot subscribes to the topic.
    """
    name = _legal(topic)
    found = await context.run_in_thread(driven_topics)
    if name not in found:
        raise Refused(f"no robot listens to {name}; there is {', '.join(found) or 'none yet'}")
    await context.node.shared(Teleop).open(name, found[name])
    return {"topic": name, "type": found[name]}


@operation("drive", control=True)
async def drive(context: Context, linear: float, angular: float, topic: str = "cmd_vel") -> None:
    """A key is held. The first message on a topic only opens it: while it waits, the key may be
    released, and then it must not drive. Refused: too fast, no such topic, another drives."""
    if max(abs(linear), abs(angular)) > FASTEST:
        raise Refused(f"drive: {linear:g} m/s and {angular:g} rad/s are more than {FASTEST:g}")
    driven, name = context.node.shared(Teleop), _legal(topic)
    if driven.is_open(name):
        await driven.press(context, name, linear, angular)
    else:
        await drive_open(context, topic)


@operation("drive_release", control=True)
async def drive_release(context: Context) -> None:
    """All keys are up."""
    context.node.shared(Teleop).release(context.client)


def _legal(topic: str) -> str:
    """The topic's full name; Refused if it is illegal."""
    if len(topic) > 256 or not rosgraph.names.is_legal_name(topic) or topic.startswith("~"):
        raise Refused(f"{topic[:40]!r} is not the name of a topic; cmd_vel is one")
    return rospy.resolve_name(topic)


def _name() -> str:
    return rospy.get_name().rpartition("/")[2] + GUARD
