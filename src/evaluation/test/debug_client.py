"""A client of the debug adapter protocol, which speaks it with debugpy as an editor does."""

from __future__ import annotations

import json
import socket
import subprocess
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, BinaryIO

LIMIT = 120.0  # s, wall, for each answer and event


class DebugClient:
    """Requests and their answers, and the events that came; over a socket or a program's pipes."""

    def __init__(self, reads: BinaryIO, writes: BinaryIO):
        self._reads, self._writes = reads, writes
        self._seq = 0
        self._came = threading.Condition()
        self._messages: list[dict] = []
        self.terminal: Callable[[dict], None] = lambda _arguments: None  # runs what is asked for
        threading.Thread(target=self._read, daemon=True).start()

    @classmethod
    def connect(cls, port: int) -> DebugClient:
        """To a program that waits at a port; tries until it listens."""
        until = time.monotonic() + LIMIT
        while True:
            try:
                link = socket.create_connection(("127.0.0.1", port))
                return cls(link.makefile("rb"), link.makefile("wb"))
            except ConnectionRefusedError:
                assert time.monotonic() < until, f"nobody listens at port {port}"
                time.sleep(0.1)

    @classmethod
    def of(cls, adapter: subprocess.Popen) -> DebugClient:
        """Of an adapter that this process has started."""
        return cls(adapter.stdout, adapter.stdin)

    def begin(self, request: str, arguments: dict, breakpoints: dict[Path, list[int]]) -> None:
        """`launch` or `attach`, with these breakpoints (lines by file), as an editor begins."""
        self.ask("initialize", adapterID="debugpy", clientID="test", pathFormat="path",
                 linesStartAt1=True, columnsStartAt1=True, supportsRunInTerminalRequest=True)
        started = self.send(request, **arguments)
        came = self._take(lambda each: each.get("event") == "initialized"
                          or (each.get("request_seq") == started and not each["success"]))
        assert "event" in came, came["message"]
        for path, lines in breakpoints.items():
            answer = self.ask("setBreakpoints", source={"path": str(path)},
                              breakpoints=[{"line": line} for line in lines])
            assert all(each["verified"] for each in answer["breakpoints"]), answer
        self.ask("configurationDone")
        self.answer(started)

    def stopped(self) -> tuple[int, dict]:
        """Wait until a thread stands; its number, and its innermost frame."""
        thread = self.event("stopped")["threadId"]
        return thread, self.ask("stackTrace", threadId=thread, levels=1)["stackFrames"][0]

    def locals(self, frame: dict) -> dict[str, str]:
        """The frame's variables, as they are shown."""
        scopes = self.ask("scopes", frameId=frame["id"])["scopes"]
        found = self.ask("variables", variablesReference=scopes[0]["variablesReference"])
        return {each["name"]: each["value"] for each in found["variables"]}

    def ask(self, command: str, **arguments: Any) -> dict:
        """A request's answer; AssertionError if it failed."""
        return self.answer(self.send(command, **arguments))

    def send(self, command: str, **arguments: Any) -> int:
        """Send a request; returns its number."""
        return self._write({"type": "request", "command": command, "arguments": arguments})

    def answer(self, number: int) -> dict:
        """The answer to a request."""
        found = self._take(lambda each: each.get("request_seq") == number)
        assert found["success"], found.get("message")
        return found.get("body", {})

    def event(self, name: str) -> dict:
        """The next event of a kind."""
        return self._take(lambda each: each.get("event") == name).get("body", {})

    def _take(self, wanted: Callable[[dict], bool]) -> dict:
        def found() -> dict | None:
            return next(filter(wanted, self._messages), None)

        with self._came:
            assert self._came.wait_for(found, LIMIT), self._messages
            message = found()
            self._messages.remove(message)
            return message

    def _write(self, message: dict) -> int:
        self._seq += 1
        body = json.dumps(message | {"seq": self._seq}).encode()
        self._writes.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        self._writes.flush()
        return self._seq

    def _read(self) -> None:
        while header := self._reads.readline():
            while self._reads.readline().strip():
                pass
            message = json.loads(self._reads.read(int(header.split(b":")[1])))
            if message["type"] == "request":  # runInTerminal
                self.terminal(message["arguments"])
                self._write({"type": "response", "request_seq": message["seq"], "success": True,
                             "command": message["command"], "body": {}})
                continue
            with self._came:
                self._messages.append(message)
                self._came.notify_all()
