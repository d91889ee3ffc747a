"""A page's connection that keeps apart what it watches."""

from __future__ import annotations

from collections import defaultdict

import aiohttp
from background import LIMIT, wait_until
from page_link import PageLink


class ToolLink(PageLink):
    """`watch` gives a Watched; `data` and `error` are an operation's answer."""

    def __init__(self, url: str) -> None:
        self.by_watch: dict[int, list] = defaultdict(list)
        super().__init__(url)

    def data(self, op: str, **args):
        answer = self.ask(op, **args)
        assert answer["ok"], answer
        return answer["data"]

    def error(self, op: str, **args) -> str:
        answer = self.ask(op, **args)
        assert not answer["ok"], answer
        return answer["error"]

    def watch(self, what: str, **args) -> Watched:
        return Watched(self, self.data("watch", what=what, args=args)["watch"])

    async def _read(self) -> None:
        async for message in self._socket:
            if message.type is not aiohttp.WSMsgType.TEXT:
                continue
            data = message.json()
            if "watch" in data:
                self.by_watch[data["watch"]].append(data["data"])
            else:
                self.answers[data["id"]] = data


class Watched:
    """One thing watched; `events` are all that has come, oldest first."""

    def __init__(self, link: ToolLink, number: int) -> None:
        self._link = link
        self._number = number

    @property
    def events(self) -> list:
        return list(self._link.by_watch[self._number])

    def until(self, fits, what: str, limit: float = LIMIT):
        """The first event that fits, from the beginning."""
        return wait_until(lambda: [event for event in self.events if fits(event)], what, limit)[0]

    def stop(self) -> None:
        self._link.data("unwatch", watch=self._number)
