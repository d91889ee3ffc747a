"""A page's WebSocket without a browser: what a script of somebody else could send."""

from __future__ import annotations

import itertools
from urllib.parse import urlsplit

import aiohttp
from background import loop, run, wait_until


class PageLink:
    """Connected to the page at `url`. `answers` by number, `events` of all that is watched."""

    def __init__(self, url: str) -> None:
        self._numbers = itertools.count(1)
        self.answers: dict[int, dict] = {}
        self.events: list[dict | bytes] = []  # bytes: a picture's JPEG
        run(self._connect(urlsplit(url)._replace(scheme="ws", path="/ws").geturl()))

    def send(self, op: str, **args) -> int:
        """The message's number; the answer is not waited for."""
        number = next(self._numbers)
        run(self._socket.send_json({"id": number, "op": op, **args}))
        return number

    def ask(self, op: str, **args) -> dict:
        number = self.send(op, **args)
        return wait_until(lambda: self.answers.get(number), f"an answer to {op}")

    def pause(self) -> None:
        """From now on nothing is read from the connection."""
        loop.call_soon_threadsafe(self._socket._response.connection.transport.pause_reading)

    def abort(self) -> None:
        """The connection is cut without a goodbye."""
        loop.call_soon_threadsafe(self._socket._response.connection.transport.abort)

    def close(self) -> None:
        self._reader.cancel()
        run(self._socket.close())
        run(self._client.close())

    async def _connect(self, url: str) -> None:
        self._client = aiohttp.ClientSession()
        self._socket = await self._client.ws_connect(url, max_msg_size=0)
        self._reader = loop.create_task(self._read())

    async def _read(self) -> None:
        async for message in self._socket:
            if message.type is aiohttp.WSMsgType.BINARY:
                self.events.append(message.data[4:])  # behind the watch's number
                continue
            data = message.json()
            if "watch" in data:
                self.events.append(data["data"])
            else:
                self.answers[data["id"]] = data
