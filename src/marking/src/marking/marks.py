"""The marks of a class: marks.csv, marks.html, and a page for each student."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from urllib.parse import quote

from terminal_language import heading, translated

from evaluation.run_page import RUN_PAGE
from marking.bubblewrap import Kind
from marking.case_files import FILM, OUTPUT, PATH_PICTURE, THUMBNAIL
from marking.points import (
    Mark,
    case_title,
    colon,
    figure,
    headline,
    is_chinese,
    losses,
    mean,
    sentence,
)
from marking.rules import Rules
from marking.submissions import visible
from run_session.files import write_whole

MARKS, PAGE, STUDENTS, STUDENT_PAGE = "marks.csv", "marks.html", "students", "index.html"
SHOWN = (PATH_PICTURE, THUMBNAIL, FILM, RUN_PAGE)  # of a case, in the student's folder
FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r")  # a spreadsheet would evaluate such cells
STYLE = (
    "body{font-family:sans-serif;line-height:1.45;max-width:64em;margin:1.5em auto;padding:0 1em;"
    "overflow-wrap:break-word}img,video{max-width:100%}table{border-collapse:collapse;width:100%}"
    "ul,p{margin:.3em 0}ul{padding-left:1.2em}h2{margin:1.6em 0 .3em}td,th{text-align:left;"
    "padding:.6em .8em .6em 0;border-bottom:1px solid #ccc;vertical-align:top}"
    "th{white-space:nowrap}td:first-child{max-width:14em}td:last-child{overflow-wrap:anywhere}"
    ".points{font-weight:bold}.case{display:flex;gap:1em}.case+.case{margin-top:.8em}"
    ".case>:last-child{flex:1;min-width:0}"
    ".case img{width:180px;border-radius:4px}"
    "pre{white-space:pre-wrap;background:#f4f4f4;padding:.5em}@media(max-width:40em){"
    "table,tbody,tr,td{display:block;border:0;padding:.1em 0}th{display:none}"
    "tr{border-bottom:1px solid #ccc;padding:.8em 0}.case img{width:120px}}")


def write_marks(marks: Mapping[str, Sequence[Mark]], rules: Rules, kind: Kind, out: Path) -> None:
    """Write the table of all students, for a spreadsheet and for a browser."""
    cases = sorted({mark.case for rows in marks.values() for mark in rows})
    most = rules.points.most
    table = io.StringIO(newline="")
    writer = csv.writer(table)
    keys = ["student", "points", "of", *cases, "sandbox", "why points were lost", "note"]
    writer.writerow(keys)
    if is_chinese():  # the first row is for programs, whatever the language
        writer.writerow([case_title(key) if key in cases else _word(key) for key in keys])
    for student, rows in marks.items():
        points = {mark.case: mark.points for mark in rows}
        writer.writerow([_cell(student), mean(list(points.values())), most,
                         *[points.get(case, "") for case in cases],
                         "no" if kind is Kind.NONE else "yes", _cell(_said(rows, most)),
                         _notes(rows)])
    write_whole(out / MARKS, table.getvalue().encode("utf-8-sig"))  # Excel needs the BOM
    body = "".join(
        f'<tr><td><a href="{STUDENTS}/{quote(student)}/{STUDENT_PAGE}">{escape(student)}</a></td>'
        f'<td class="points">{figure(mean([mark.points for mark in rows]))}</td>'
        f"<td>{''.join(_case_row(mark, len(rows) > 1, out) for mark in rows)}</td></tr>\n"
        for student, rows in marks.items())
    warned = translated("These submissions ran without a sandbox.") if kind is Kind.NONE else ""
    class_mean = figure(mean([mean([mark.points for mark in rows]) for rows in marks.values()]))
    summary = translated(f"Course: {rules.course}, {len(marks)} submissions, {class_mean} of "
                         f"{most:g} points on average.")
    heads = "".join(f"<th>{escape(_word(each))}</th>"
                    for each in ("student", "points", "what the car did"))
    write_whole(out / PAGE, _page(
        _word("Marks"), f'{_line(warned)}<p>{escape(summary)} <a href="{MARKS}">{MARKS}</a></p>'
        f"<table><tr>{heads}</tr>\n{body}</table>").encode())


def write_student_pages(marks: Mapping[str, Sequence[Mark]], rules: Rules, out: Path) -> None:
    """Write students/ID/index.html, beside what `student_file` names."""
    most = rules.points.most
    for student, rows in marks.items():
        folder = out / STUDENTS / student
        folder.mkdir(parents=True, exist_ok=True)
        for mark in rows:
            for made in SHOWN if not mark.folder else ():  # of an earlier submission
                student_file(out, student, mark.case, made).unlink(missing_ok=True)
        total = translated(f"{figure(mean([mark.points for mark in rows]))} of {most:g} points")
        parts = "".join(_case_part(mark, most, out) for mark in rows)
        write_whole(folder / STUDENT_PAGE, _page(
            student, f'<p class="points">{escape(total)}</p>{parts}').encode())


def student_file(out: Path, student: str, case: str, made: str) -> Path:
    """Where a drive's file of SHOWN is kept: in the folder that the student may be sent."""
    return out / STUDENTS / student / f"{case}{Path(made).suffix}"


def _case_row(mark: Mark, several: bool, out: Path) -> str:
    """A case in the table of the class."""
    kept = {made: student_file(out, mark.student, mark.case, made) for made in SHOWN}
    at = {made: quote(str(path.relative_to(out))) for made, path in kept.items() if path.exists()}
    picture = (f'<a href="{at[PATH_PICTURE]}"><img src="{at[THUMBNAIL]}" '
               f'alt="{escape(_word("path"))}"></a>' if {PATH_PICTURE, THUMBNAIL} <= set(at)
               else "")
    named = f"{case_title(mark.case)}{colon()}{figure(mark.points)}, " if several else ""
    links = " · ".join(f'<a href="{at[made]}">{escape(word)}</a>' for made, word in (
        (FILM, _word("film")), (RUN_PAGE, _word("replay in 3D"))) if made in at)
    return (f'<div class="case">{picture}<div>{escape(named + translated(mark.did))}'
            f"{_list(losses(mark))}{_line(translated(mark.note))}"
            f"{f'<p>{links}</p>' if links else ''}</div></div>")


def _case_part(mark: Mark, most: float, out: Path) -> str:
    """A case on the student's page."""
    forms = {PATH_PICTURE: f'<p><img src="{{}}" alt="{escape(_word("path"))}"></p>',
             FILM: '<p><video src="{}" controls></video></p>',
             RUN_PAGE: f'<p><a href="{{}}">{escape(_word("replay in 3D"))}</a></p>'}
    paths = {made: student_file(out, mark.student, mark.case, made) for made in forms}
    shown = "".join(forms[made].format(path.name) for made, path in paths.items() if path.exists())
    return (f"<h2>{escape(case_title(mark.case))}</h2>{_line(headline(mark, most))}"
            f"{_list(losses(mark))}{_line(translated(mark.note))}{shown}{_output(mark, out)}")


def _output(mark: Mark, out: Path) -> str:
    path = out / mark.folder / OUTPUT
    if not mark.folder or not path.exists():
        return ""
    text = visible(path.read_text(encoding="utf-8", errors="replace"))
    said = _line(translated("What the program printed:"))
    return f"{said}<pre>{escape(text)}</pre>" if text.strip() else ""


def _said(rows: Sequence[Mark], most: float) -> str:
    """What happened in each case, for the table's cell."""
    if len(rows) == 1:
        return sentence(rows[0], most)
    return "; ".join(f"{case_title(mark.case)}{colon()}{sentence(mark, most)}" for mark in rows)


def _list(lines: Sequence[str]) -> str:
    return f"<ul>{''.join(f'<li>{escape(each)}</li>' for each in lines)}</ul>" if lines else ""


def _notes(rows: Sequence[Mark]) -> str:
    return "; ".join(dict.fromkeys(translated(mark.note) for mark in rows if mark.note))


def _line(text: str) -> str:
    return f"<p>{escape(text)}</p>" if text else ""


def _word(text: str) -> str:
    """A heading in the wanted language."""
    return translated(text) if " " in text else heading(text)


def _cell(text: str) -> str:
    return f"'{text}" if text.startswith(FORMULA_STARTS) else text


def _page(title: str, body: str) -> str:
    language = "zh-CN" if is_chinese() else "en"
    return (f'<!DOCTYPE html>\n<html lang="{language}"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            f"<title>{escape(title)}</title><style>{STYLE}</style></head><body>\n"
            f"<h1>{escape(title)}</h1>\n{body}\n</body></html>\n")
