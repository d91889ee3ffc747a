"""Writes the tables of what works: docs/interface.md and docs/interface.zh-CN.md.

    python3 scripts/interface_table.py            write them
    python3 scripts/interface_table.py --check    exit code 1 if they are not what would be written
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from bullet_sim_ros.interface import (
    ABSENT,
    ACCEPTED,
    APPROXIMATED,
    WORKS,
    Entry,
    Section,
    read_interface,
)

ROOT = Path(__file__).resolve().parent.parent
WORDS = {
    "en": {WORKS: "works", APPROXIMATED: "approximated", ACCEPTED: "accepted, no effect",
           ABSENT: "not there", "what": "what", "how": "how", "tags": "inside",
           "title": "What of Gazebo's interface works here",
           "note": "Made by `scripts/interface_table.py` from `src/sim/bullet_sim_ros/interface/`. "
                   "Each row and tag that works or is approximated has a test that names it.",
           "other": "[中文](interface.zh-CN.md)", "part": "part", "colon": ": ", "stop": "; ",
           "reason": " ({})"},
    "zh": {WORKS: "可用", APPROXIMATED: "近似", ACCEPTED: "接受但无作用", ABSENT: "没有",
           "what": "内容", "how": "说明", "tags": "其中",
           "title": "Gazebo 接口在这里的支持情况",
           "note": "由 `scripts/interface_table.py` 根据 `src/sim/bullet_sim_ros/interface/` 生成。"
                   "每个可用或近似的条目都有写明它的测试。",
           "other": "[English](interface.md)", "part": "部分", "colon": "：", "stop": "；",
           "reason": "（{}）"},
}


def document(sections: list[Section], language: str) -> str:
    """The summary, then the complete table, with a chapter for each section."""
    words = WORDS[language]
    lines = [f"# {words['title']}", "", words["other"], "", words["note"], "",
             *summary(sections, language), ""]
    for section in sections:
        lines += [f"## {_title(section, language)}", "",
                  f"| {words['what']} | | {words['how']} | {words['tags']} |", "|---|---|---|---|"]
        lines += [f"| `{row.name}` | {words[row.status]} | {_cell(_how(row, language))} | "
                  f"{_cell(_tags(row.tags.values(), language))} |" for row in section.rows]
        lines.append("")
    return "\n".join(lines)


def summary(sections: list[Section], language: str) -> list[str]:
    """One line per section: how many rows work, and which are approximated or missing."""
    words = WORDS[language]
    lines = [f"| {words['part']} | {words[WORKS]} | {words[APPROXIMATED]} | {words[ABSENT]} |",
             "|---|---|---|---|"]
    for section in sections:
        of = {status: [row.name for row in section.rows if row.status == status]
              for status in (WORKS, APPROXIMATED, ACCEPTED, ABSENT)}
        lines.append(f"| {_title(section, language)} | {len(of[WORKS])} | "
                     f"{_names(of[APPROXIMATED])} | {_names(of[ABSENT])} |")
    return lines


def _names(names: list[str]) -> str:
    return ", ".join(f"`{name}`" for name in names) or "–"


def _title(section: Section, language: str) -> str:
    return section.title_zh if language == "zh" else section.title


def _how(entry: Entry, language: str) -> str:
    return entry.how_zh if language == "zh" else entry.how


def _tags(tags, language: str) -> str:
    """Tags by status; those that do not simply work come with a reason."""
    words, parts = WORDS[language], []
    working = [f"`{tag.name}`" for tag in tags if tag.status == WORKS]
    if working:
        parts.append(", ".join(working))
    for tag in tags:
        if tag.status != WORKS:
            how = _how(tag, language)
            parts.append(f"`{tag.name}`{words['colon']}{words[tag.status]}"
                         + (words["reason"].format(how) if how else ""))
    return words["stop"].join(parts)


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")


def written(sections: list[Section]) -> dict[Path, str]:
    """Every file with its tables as they should be."""
    return {ROOT / f"docs/interface{suffix}.md": document(sections, language)
            for language, suffix in (("en", ""), ("zh", ".zh-CN"))}


def main() -> int:
    """Write, or compare."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing, only compare")
    args = parser.parse_args()
    stale = 0
    for path, text in written(read_interface()).items():
        if path.is_file() and path.read_text(encoding="utf-8") == text:
            continue
        if args.check:
            print(f"{path.relative_to(ROOT)} is not up to date: python3 scripts/interface_table.py",
                  file=sys.stderr)
            stale = 1
        else:
            path.write_text(text, encoding="utf-8")
            print(f"written: {path.relative_to(ROOT)}")
    return stale


if __name__ == "__main__":
    sys.exit(main())
