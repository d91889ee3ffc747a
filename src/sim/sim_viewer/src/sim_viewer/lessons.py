"""The site of `make site` below /lessons/: the page's link to it works before it is built, too."""

from pathlib import Path

import rospkg
from aiohttp import web

ADDRESS = "/lessons/{path:.*}"
# Its pages have scripts and styles within, and show a replay that is one file of its own policy.
POLICY = "default-src 'self' 'unsafe-inline' data: blob:; frame-ancestors 'self'"
NOT_BUILT = ("The lessons' pages are not built yet. In the courses' folder type: make site\n"
             "课程网站还没有生成。请在课程的文件夹里输入：make site\n")


def site_folder() -> Path:
    """Where `make site` writes: out/site of the repository that this package lies in."""
    return Path(rospkg.RosPack().get_path("sim_viewer")).parents[2] / "out/site"


async def serve_lesson(request: web.Request) -> web.StreamResponse:
    """A file of the site; HTTPNotFound for any other, and with what to type if there is no site."""
    site = site_folder().resolve()
    if not (site / "index.html").is_file():
        raise web.HTTPNotFound(text=NOT_BUILT)
    path = (site / (request.match_info["path"] or "index.html")).resolve()
    if not path.is_relative_to(site) or not path.is_file():
        raise web.HTTPNotFound(text="no such file\n")
    return web.FileResponse(path, headers={"Content-Security-Policy": POLICY})
