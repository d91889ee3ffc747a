"""Builds the site of all pages, in English and Chinese: scripts/site.sh runs it.

    python3 tools/site [--out DIR]      DIR: out/site

It is built beside DIR and takes the place of the site there when it is whole; exit code 1 with one
line otherwise. One is built at a time: its lock is .NAME.lock beside DIR.
"""

from __future__ import annotations

import argparse
import fcntl
import glob
import logging
import shutil
import sys
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace

import rjieba
from advice import add_advice
from checking import faults
from material.plugins.search import plugin as search
from mkdocs.commands.build import build
from mkdocs.config import load_config
from mkdocs.exceptions import Abort, MkDocsException
from reference import add_reference
from ros2 import add_ros2
from staging import HERE, ROOT, SAYS, Pages, repository_pages, stage

from bullet_sim.errors import SimulationError

PARTS = {"index.html", "en", "zh", "demo"}  # what a site has
REPLAY = ROOT / "out/course/run.html"


class SiteError(Exception):
    """The site cannot be built; one line says why."""


def short_words(text: bytes) -> list[str]:
    """Chinese words as the search keeps them: the parts of a long word where it is made of some."""
    found = []
    for word in rjieba.cut(text.decode()):
        parts = [part for part in rjieba.cut_for_search(word) if part != word]
        found += parts if "".join(parts) == word else [word]
    return found


# Material's search looks for the words that a query is made of, but never for the whole query as a
# word: of 里程计 it would search 里 alone, as another text has that word.
WORDS, WHOLE = "o<t.length;o++)t.slice(s,o)in e", "o<=t.length;o++)t.slice(s,o)in e"


def search_whole_words(folder: Path) -> None:
    """Mend the search's script; SiteError if it is another one than that of the pinned version."""
    (script,) = (folder / "assets/javascripts/workers").glob("search.*.min.js")
    text = script.read_text("utf-8")
    if text.count(WORDS) != 1:
        raise SiteError(f"{script.name}: mkdocs-material has another search; see WORDS"
                        f" in {__file__}")
    script.write_text(text.replace(WORDS, WHOLE), "utf-8")


def all_pages() -> Pages:
    """The repository's pages and the made ones."""
    pages = repository_pages()
    add_reference(pages)
    add_advice(pages)
    add_ros2(pages)
    pages.add("demo.md", *(says["demo"] for says in SAYS.values()))
    return pages


def build_site(out: Path, replay: Path) -> None:
    """Build at `out`; SiteError names what is wrong."""
    search.jieba = SimpleNamespace(cut=short_words)
    for language, menu in stage(all_pages(), out / "pages"):
        config = load_config(str(HERE / "mkdocs.yml"), docs_dir=str(out / "pages" / language),
                             site_dir=str(out / language), nav=menu,
                             site_name=SAYS[language]["site"])
        config.theme["language"] = language
        config.plugins.on_startup(command="build", dirty=False)
        build(config)
        search_whole_words(out / language)
        (out / language / "404.html").unlink()  # of a server's root alone
    shutil.rmtree(out / "pages")
    shutil.copyfile(HERE / "start.html", out / "index.html")
    (out / "demo").mkdir()
    shutil.copyfile(replay, out / "demo/run.html")
    if wrong := faults(out):
        raise SiteError("\n".join(wrong))


def check_place(out: Path) -> None:
    """SiteError if something other than a site or an empty folder is there."""
    if not out.exists():
        return
    there = {path.name for path in out.iterdir()} if out.is_dir() else {out.name}
    if there and there != PARTS:
        raise SiteError(f"{out} is there and is no site that was built before: name another folder"
                        " with --out")


def replace_site(out: Path, replay: Path) -> None:
    """Build beside `out`, then take its place; SiteError or OSError, and the old one stays."""
    out.parent.mkdir(parents=True, exist_ok=True)
    with (out.parent / f".{out.name}.lock").open("a") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise SiteError(f"{out} is being built by another make site: wait until it ends, then"
                            " type this again") from None
        check_place(out)
        for left in out.parent.glob(f"{glob.escape(out.name)}.*.unfinished"):  # it was killed
            shutil.rmtree(left)
        with tempfile.TemporaryDirectory(".unfinished", f"{out.name}.", out.parent) as folder:
            made = Path(folder) / "site"
            made.mkdir()
            build_site(made, replay)
            check_place(out)  # the build takes a while
            if out.exists():
                out.rename(Path(folder) / "old")
            made.rename(out)


def main() -> int:
    """The exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, metavar="DIR", default=ROOT / "out/site")
    parser.add_argument("--replay", type=Path, metavar="HTML", default=REPLAY,
                        help="the run.html that is shown (default: the last course's)")
    given = parser.parse_args()
    logging.basicConfig(format="site: %(message)s", level=logging.WARNING)
    begun, out = time.monotonic(), given.out.resolve()
    try:
        replace_site(out, given.replay)
    except KeyboardInterrupt:
        return 130
    except OSError as error:
        print(f"site: {error.filename or out}: {error.strerror}", file=sys.stderr)
        return 1
    except (Abort, MkDocsException, SimulationError, SiteError, ValueError) as error:
        print(f"site: {error}", file=sys.stderr)
        return 1
    print(f"{out}/index.html: {len(list(out.rglob('*.html')))} pages in "
          f"{time.monotonic() - begun:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
