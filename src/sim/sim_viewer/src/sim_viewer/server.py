"""The web server: the page's files, the WebSocket, and the shapes of scenes."""

import errno
import logging
from pathlib import Path
from typing import Any

import rosgraph
import rospkg
import rospy
from aiohttp import web
from aiohttp.http_exceptions import HttpProcessingError

from bullet_sim import __version__
from bullet_sim.errors import FormatError
from sim_viewer.access import Access
from sim_viewer.hub import Hub
from sim_viewer.lessons import ADDRESS, FOLDER, serve_lesson, to_first_page
from sim_viewer.options import Options
from sim_viewer.page_scene import Meshes
from sim_viewer.registry import Context, Node, operation
from sim_viewer.urls import ABOUT

PORTS_TRIED = 100


def facts(options: Options) -> dict[str, Any]:
    """Which node serves the page for which master, and options that a person may miss."""
    return {"node": rospy.get_name(), "master": rosgraph.get_master_uri(),
            "control": options.control, "rviz": options.rviz, "address": options.address,
            "version": __version__}


@operation("about")
async def about(context: Context) -> dict[str, Any]:
    """Whether this page may change anything, and the name of the node that serves it."""
    return facts(context.node.options)


class NoPort(OSError):
    """No port could be bound."""


class Server:
    """Serves from `start` to `close`."""

    def __init__(self, node: Node):
        self._node, self._options = node, node.options
        self._hub = Hub(node)
        self._folder = Path(rospkg.RosPack().get_path("sim_viewer")) / "web"
        app = web.Application(middlewares=[Access(node.options).guard])
        app.router.add_get("/ws", self._hub.serve)
        app.router.add_get("/{kind:mesh|texture}/{number:[0-9]{1,9}}", self.serve_shape)
        app.router.add_get("/", self._index)
        app.router.add_get(ABOUT, self._about)
        app.router.add_get(FOLDER, to_first_page)
        app.router.add_get(ADDRESS, serve_lesson)
        app.router.add_static("/", self._folder)
        self._runner = web.AppRunner(app, access_log=None, logger=_logger(), shutdown_timeout=1.0)

    async def start(self) -> int:
        """Bind and serve; returns the port, the next free one if that one is taken, or NoPort."""
        await self._runner.setup()
        options = self._options
        last, denied = min(options.port + PORTS_TRIED, 65536), False
        for port in range(options.port, last):
            try:
                await web.TCPSite(self._runner, options.address, port).start()
                return port
            except OSError as error:
                denied = denied or error.errno == errno.EACCES
                if error.errno not in (errno.EADDRINUSE, errno.EACCES):
                    raise NoPort(f"cannot listen at {options.address}: {error.strerror}; "
                                 "address:=127.0.0.1 always works") from None
        if denied:
            raise NoPort(f"port {options.port} is root's; give one from 1024 with port:=")
        raise NoPort(f"ports {options.port} to {last - 1} are all taken; give another with port:=")

    async def close(self) -> None:
        """Close the browsers' connections, then the server."""
        await self._hub.close()
        await self._runner.cleanup()

    async def serve_shape(self, request: web.Request) -> web.Response:
        """HTTPNotFound if no present scene has it any more, or its file is no image."""
        meshes: Meshes = self._node.shared(Meshes)
        read = meshes.mesh if request.match_info["kind"] == "mesh" else meshes.texture
        try:
            content_type, data = await self._node.run_in_thread(
                read, int(request.match_info["number"]))
        except (KeyError, FormatError, OSError):
            raise web.HTTPNotFound from None
        return web.Response(body=data, content_type=content_type)

    async def _about(self, request: web.Request) -> web.Response:
        return web.json_response(facts(self._options))

    async def _index(self, request: web.Request) -> web.FileResponse:
        return web.FileResponse(self._folder / "index.html")


def _logger() -> logging.Logger:
    """Logs errors of the server only: for a malformed request, the client gets status 400."""
    logger = logging.getLogger("sim_viewer.http")
    logger.addFilter(_is_fault_of_server)
    return logger


def _is_fault_of_server(record: logging.LogRecord) -> bool:
    return not (record.exc_info and isinstance(record.exc_info[1], HttpProcessingError))
