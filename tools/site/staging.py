"""The repository's pages as mkdocs reads them: a folder for each language, with the same paths.

The path of a page is that of its English file; a page without a Chinese file is English in both.
"""

from __future__ import annotations

import json
import posixpath
import re
import subprocess
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path

import yaml
from pymdownx.slugs import slugify

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
LANGUAGES = ("en", "zh")
CHINESE = ".zh-CN.md"
NOTEBOOK = ".ipynb"
PICTURES = (".png", ".webp", ".svg", ".jpg", ".gif")
LEFT_OUT = re.compile(r"\.github/|tools/|.*/vendor/|.*/models/|test/")
OTHER_LANGUAGE = re.compile(r"^\[(中文|English)\]\([^)]*\)\n+", re.MULTILINE)
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
HAN = re.compile(r"[\u4e00-\u9fff]")
BROKEN = re.compile(r"(?<=[\u3001-\u9fff\uff00-\uffef])\n(?=[\u3001-\u9fff\uff00-\uffef])")
ROW = re.compile(r"^\|.*\|$", re.MULTILINE)
CODE = re.compile(r"(^```.*?^```\s*?$|``.+?``|`[^`\n]+`)", re.MULTILINE | re.DOTALL)
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)
CODE_BLOCK = re.compile(r"^```.*?^```\s*?$", re.MULTILINE | re.DOTALL)
TITLE = re.compile(r"^# (.+)$", re.MULTILINE)
SAYS = {language: {name: texts[i] for name, texts in yaml.safe_load(
    (HERE / "words.yaml").read_text("utf-8")).items()} for i, language in enumerate(LANGUAGES)}


@dataclass
class Pages:
    """Texts by language and path, and the pictures that they show, by path below ROOT."""

    texts: dict[str, dict[str, str]]
    pictures: set[str] = field(default_factory=set)

    def add(self, path: str, english: str, chinese: str) -> None:
        """A made page."""
        self.texts["en"][path], self.texts["zh"][path] = english, chinese


def tracked() -> list[str]:
    """Paths of the repository's files, those that git does not know yet too."""
    said = subprocess.run(["git", "-C", ROOT, "ls-files", "-co", "--exclude-standard"],
                          capture_output=True, text=True, check=True)
    return said.stdout.splitlines()


def repository_pages() -> Pages:
    """All .md files and notebooks that are for readers."""
    files = [path for path in tracked() if path.endswith((".md", NOTEBOOK))
             and (ROOT / path).is_file() and not LEFT_OUT.match(path)]
    english = [path for path in files if not path.endswith((CHINESE, NOTEBOOK))]
    pages = Pages({language: {} for language in LANGUAGES})
    for path in set(files).difference(english):
        if path.endswith(NOTEBOOK):
            pages.add(path.removesuffix(NOTEBOOK) + ".md", *notebook_texts(ROOT / path))
    for path in english:
        chinese = path.removesuffix(".md") + CHINESE
        for language, source in (("en", path), ("zh", chinese if chinese in files else path)):
            text = OTHER_LANGUAGE.sub("", (ROOT / source).read_text("utf-8"), count=1)
            if language == "zh" and source == path:
                text = TITLE.sub(r"\g<0>\n\n" + SAYS["zh"]["english only"], text, count=1)
            pages.texts[language][path] = text
    for language, texts in pages.texts.items():
        for path, text in texts.items():
            texts[path] = _with_links(text, path, pages, language)
    return pages


def notebook_texts(path: Path) -> list[str]:
    """A notebook, without results, in English and in Chinese.

    A paragraph is in one language; a heading has both, English first; code is the same in both.
    """
    texts: list[list[str]] = [[], []]
    for cell in json.loads(path.read_text("utf-8"))["cells"]:
        source = "".join(cell["source"])
        parts = ([f"```python\n{source}\n```"] if cell["cell_type"] == "code"
                 else source.split("\n\n"))
        for part in parts:
            english, slash, chinese = part.partition(" / ")
            if part.startswith("```"):
                both = (part, part)
            elif part.startswith("#") and slash:
                both = (english, f"{english[:english.index(' ')]} {chinese}")
            else:
                both = ("", part) if HAN.search(part) else (part, "")
            for text, words in zip(texts, both):
                text += [words] if words else []
    return ["\n\n".join(text) + "\n" for text in texts]


def _anchors(text: str) -> list[str]:
    """The anchors of its headings."""
    slug = slugify(case="lower")
    return [slug(re.sub(r"[`*]", "", words), "-")
            for words in HEADING.findall(CODE_BLOCK.sub("", text))]


def _anchor(name: str, anchor: str, pages: Pages, language: str) -> str:
    """`#anchor`; in Chinese that of the same heading, as an English text names the English one."""
    here = _anchors(pages.texts[language][name])
    english = _anchors(pages.texts["en"][name])
    if anchor not in here and anchor in english and len(here) == len(english):
        anchor = here[english.index(anchor)]
    return "#" + anchor if anchor else ""


def _with_links(text: str, page: str, pages: Pages, language: str) -> str:
    """The text with links to pages and pictures of the site; other files' links are their paths."""
    folder, paths = posixpath.dirname(page), pages.texts[language]

    def link(found: re.Match) -> str:
        shown, label, target = found.groups()
        label = LINK.sub(link, label)  # a picture that is a link
        path, _, anchor = target.partition("#")
        if "://" in target or not path:
            return f"{shown}[{label}]({target})"
        path = posixpath.normpath(posixpath.join(folder, path))
        for name in (re.sub(rf"({CHINESE}|{NOTEBOOK})$", ".md", path),
                     posixpath.join(path, "README.md")):
            if name in paths:
                to = posixpath.relpath(name, folder or ".")
                return f"[{label}]({to}{_anchor(name, anchor, pages, language)})"
        if path.endswith(PICTURES):
            pages.pictures.add(path)
            return f"{shown}[{label}]({posixpath.relpath(path, folder or '.')})"
        return f"`{path}`" if label.strip("`") in path else f"{label} (`{path}`)"

    text = text.replace("<details>", '<details markdown="1">')
    text = ROW.sub(lambda row: re.sub(  # GitHub alone needs the backslash
        r"`[^`]+`", lambda code: code[0].replace("\\|", "|"), row[0]), text)
    # Code is not searched for links; a link's own label may have code.
    kept: list[str] = []

    def keep(code: re.Match) -> str:
        kept.append(code[0])
        return f"\0{len(kept) - 1}\0"

    def label_code(found: re.Match) -> str:
        return kept[int(found[1])]

    hidden = BROKEN.sub("", CODE.sub(keep, text))
    linked = LINK.sub(lambda found: re.sub(r"\0(\d+)\0", label_code, link(
        re.match(LINK, re.sub(r"\0(\d+)\0", label_code, found[0])) or found)), hidden)
    return re.sub(r"\0(\d+)\0", label_code, linked)


def in_sections(file: str, names: Iterable[str]) -> list[tuple[dict, list[str]]]:
    """Each section of a file and its names, in the order of the patterns that it `has`.

    A name is in the first section with a pattern for it; ValueError if none has.
    """
    left, made = sorted(names), []
    for section in yaml.safe_load((HERE / file).read_text("utf-8")):
        chosen = list(dict.fromkeys(
            name for pattern in section["has"] for name in left if fnmatchcase(name, pattern)))
        left = [name for name in left if name not in chosen]
        made.append((section, chosen))
    if left:
        raise ValueError(f"{file}: no section has {', '.join(left)}")
    return made


def menu(texts: Mapping[str, str], language: str) -> list:
    """mkdocs' nav."""
    return [{section[language]: [{title(texts[path]): path} for path in chosen]}
            for section, chosen in in_sections("sections.yaml", texts) if chosen]


def table(language: str, columns: str, rows: Iterable[Iterable[str]]) -> list[str]:
    """A table's lines; none without rows. `columns`: words of words.yaml, with commas between."""
    names = [SAYS[language][column] for column in columns.split(", ")]
    lines = [f"| {' | '.join(cells)} |" for cells in rows]
    return [f"| {' | '.join(names)} |", "|---" * len(names) + "|", *lines, ""] if lines else []


def title(text: str) -> str:
    """A page's title as plain text."""
    found = TITLE.search(text)
    return re.sub(r"[`*]", "", found[1]) if found else "?"


def stage(pages: Pages, folder: Path) -> Iterator[tuple[str, list]]:
    """Write all pages below folder/LANGUAGE; yields each language and its menu."""
    for language, texts in pages.texts.items():
        for path, text in texts.items():
            _write(folder / language / path, text.encode())
        for path in pages.pictures:
            _write(folder / language / path, (ROOT / path).read_bytes())
        yield language, menu(texts, language)


def _write(path: Path, data: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
