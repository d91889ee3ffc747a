"""Checks built pages: each link and anchor leads somewhere, and nothing asks another host."""

from __future__ import annotations

import posixpath
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = {("script", "src"), ("link", "href"), ("img", "src"), ("iframe", "src"),
          ("source", "src"), ("video", "src"), ("object", "data")}


class _Page(HTMLParser):
    """A page's ids and links."""

    def __init__(self, path: Path):
        super().__init__()
        self.ids: set[str] = {"", "__skip"}
        self.links: list[tuple[bool, str]] = []  # whether the browser loads it with the page
        self.feed(path.read_text("utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Collect from one tag."""
        for name, value in attrs:
            if name in ("id", "name") and value:
                self.ids.add(value)
            elif (tag, name) in LOADED or (tag, name) == ("a", "href"):
                self.links.append((tag != "a", value or ""))


def faults(site: Path) -> list[str]:
    """A line for each link of the HTML files below `site` that leads nowhere or loads from afar."""
    read = cache(_Page)
    found = []
    for page in sorted(site.rglob("*.html")):
        if page.parent == site / "demo":  # one file, which may ask nobody by its own policy
            continue
        for loaded, link in read(page).links:
            if problem := _problem(site, page, loaded, link, read):
                found.append(f"{page.relative_to(site)}: {link or '(empty link)'}: {problem}")
    return found


def _problem(site: Path, page: Path, loaded: bool, link: str, read) -> str:
    parts = urlsplit(link)
    if parts.scheme or parts.netloc:
        local = parts.scheme in ("data", "mailto")
        return "is loaded from another host" if loaded and not local else ""
    path = unquote(parts.path)
    if path.startswith("/"):
        return "begins at the server's root, which another place of the site breaks"
    target = Path(posixpath.normpath(page.parent / path)) if path else page
    if target.is_dir():
        return "leads to a folder, not to a page"
    if not target.is_relative_to(site) or not target.is_file():
        return "there is no such file"
    if parts.fragment and target.suffix == ".html" and \
            unquote(parts.fragment) not in read(target).ids:
        return "the page has no such anchor"
    return ""
