"""The site of `make site` below /lessons/: the page's link to it works before it is built, too."""

from functools import cache
from pathlib import Path

import rospkg
from aiohttp import web

FOLDER = "/lessons"
ADDRESS = FOLDER + "/{path:.*}"
# Its pages have scripts and styles within, and show a replay that is one file of its own policy.
POLICY = "default-src 'self' 'unsafe-inline' data: blob:; frame-ancestors 'self'"
NOT_BUILT = ("The lessons' pages are not built yet. In the courses' folder type: make site\n"
             "课程网站还没有生成。请在课程的文件夹里输入：make site\n")

NOT_HERE = ("The lessons' pages are not part of this installation: they are built in a clone of "
            "the courses, there by: make site\n"
            "此安装不含课程网站。请在课程仓库的克隆里输入 make site 来生成。\n")


@cache
def site_folder() -> Path | None:
    """Where `make site` writes: out/site of the repository that this package lies in, if any."""
    folder = Path(rospkg.RosPack().get_path("sim_viewer")).parents[2]
    return (folder / "out/site").resolve() if (folder / "Makefile").is_file() else None


async def to_first_page(request: web.Request) -> web.Response:
    """HTTPFound of the address with its slash, below which the pages' links lead on."""
    raise web.HTTPFound(request.rel_url.with_path(FOLDER + "/").with_query(request.query))


async def serve_lesson(request: web.Request) -> web.StreamResponse:
    """A file of the site; HTTPNotFound for any other, and with what to do if there is no site."""
    site = site_folder()
    if site is None:
        raise web.HTTPNotFound(text=NOT_HERE)
    if not (site / "index.html").is_file():
        raise web.HTTPNotFound(text=NOT_BUILT)
    path = (site / (request.match_info["path"] or "index.html")).resolve()
    if not path.is_relative_to(site) or not path.is_file():
        raise web.HTTPNotFound(text="no such file\n")
    return web.FileResponse(path, headers={"Content-Security-Policy": POLICY})
