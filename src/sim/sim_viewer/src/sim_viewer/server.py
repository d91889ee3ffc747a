"""The web server: the page's files, the WebSocket, and what other modules serve over HTTP."""

from __future__ import annotations

import errno
from collections.abc import Awaitable, Callable
from pathlib import Path

import rospkg
from aiohttp import web

from sim_viewer.access import Access
from sim_viewer.context import Node
from sim_viewer.hub import Hub
from sim_viewer.options import Options

PORTS_TRIED = 100
Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class NoPort(OSError):
    """Nothing could be bound."""


class Server:
    """Serves from `start` to `close`."""

    def __init__(self, node: Node, routes: dict[str, Handler]):
        self._options = node.options
        self._hub = Hub(node)
        self._folder = Path(rospkg.RosPack().get_path("sim_viewer")) / "web"
        app = web.Application(middlewares=[Access(node.options).guard])
        app.router.add_get("/ws", self._hub.serve)
        for path, handler in routes.items():
            app.router.add_get(path, handler)
        app.router.add_get("/", self._index)
        app.router.add_static("/", self._folder)
        self._runner = web.AppRunner(app, access_log=None, shutdown_timeout=1.0)

    async def start(self) -> int:
        """Bind and serve; returns the port, the next free one if the wished one is taken."""
        await self._runner.setup()
        options = self._options
        last = min(options.port + PORTS_TRIED, 65536)
        for port in range(options.port, last):
            try:
                await web.TCPSite(self._runner, options.address, port).start()
                return port
            except OSError as error:
                if error.errno not in (errno.EADDRINUSE, errno.EACCES):
                    raise NoPort(f"cannot listen at {options.address}: {error.strerror}; "
                                 "address:=127.0.0.1 always works") from None
        raise NoPort(f"ports {options.port} to {last - 1} are all taken; give another with port:=")

    async def close(self) -> None:
        """Browsers are told first."""
        await self._hub.close()
        await self._runner.cleanup()

    async def _index(self, request: web.Request) -> web.FileResponse:
        return web.FileResponse(self._folder / "index.html")


def page_url(options: Options, port: int) -> str:
    """What to type into a browser on this machine."""
    everywhere = options.address in ("0.0.0.0", "::", "")
    host = "127.0.0.1" if everywhere else options.address
    host = f"[{host}]" if ":" in host else host
    return f"http://{host}:{port}/" + (f"?token={options.token}" if options.token else "")
