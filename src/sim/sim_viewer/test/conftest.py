"""The web server in the test's own process, without a ROS master."""

from __future__ import annotations

import asyncio
import socket

import aiohttp
import pytest
from sim_viewer import registry
from sim_viewer.options import Options
from sim_viewer.registry import Node
from sim_viewer.server import Server

LIMIT = 120.0  # s that a story may take


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@pytest.fixture
def visit(monkeypatch):
    """`visit(story, **options)` runs the coroutine `story(http, port)` with a server on that port.

    `http` is a session whose addresses begin at that server.
    """
    monkeypatch.setenv("ROS_MASTER_URI", "http://127.0.0.1:9")  # nobody is there
    registry.load_all()

    async def whole(story, options):
        node = Node(Options(port=free_port(), **options), asyncio.get_running_loop())
        server = Server(node)
        port = await server.start()
        try:
            async with aiohttp.ClientSession(f"http://127.0.0.1:{port}") as http:
                return await asyncio.wait_for(story(http, port), LIMIT)
        finally:
            await server.close()
            node.close()

    return lambda story, **options: asyncio.run(whole(story, options))
