"""Marks of cases and students: marks.csv, marks.html, and a page for each student."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from urllib.parse import quote

from evaluation.run_page import RUN_PAGE
from marking.bubblewrap import Kind
from marking.case_files import FILM, OUTPUT, PATH_PICTURE
from marking.rules import Points, Rules
from marking.submissions import visible
from run_session.files import write_whole


@dataclass(frozen=True)
class Mark:
    """The mark of one case; `outcome` "not run" is the course's fault, not the student's."""

    name: str
    student: str
    case: str
    outcome: str
    points: float
    lost: tuple[str, ...]
    folder: str  # relative to the results folder; "": nothing was driven
    note: str = ""  # a remark, in one line
    submission_sha256: str = ""  # of the submission's files


def by_student(marks: Sequence[Mark]) -> dict[str, list[Mark]]:
    """Marks by student, sorted by name, whatever order they were marked in."""
    return {student: [mark for mark in marks if mark.student == student]
            for student in sorted({mark.student for mark in marks})}


def points_of(drive: Mapping, points: Points) -> tuple[float, list[str]]:
    """Points of one case, and a line for each loss; `drive` is a case's report.json."""
    if drive["violations"]:
        return 0.0, [f"{points.most:g} points: {', '.join(drive['violations'])}"]
    if drive["fault"]:
        return 0.0, [f"{points.most:g} points: {drive['fault']}"]
    closed = drive["laps_closed"] >= drive["laps_wanted"]
    share = 1.0 if closed else drive["driven_share"]
    rows = [(points.finish, share, drive["why"] or "")]
    # Points for closeness and speed are scaled by how far the car came.
    line = _share(drive["rms_lateral_m"], points.line_best_m, points.line_worst_m)
    rows.append((points.line, line * share,
                 f"{drive['rms_lateral_m'] * 100:.1f} cm RMS beside the line"
                 f" (all points at {points.line_best_m * 100:g} cm)"))
    speed = _share(drive["mean_speed_m_s"], points.speed_best_m_s, points.speed_worst_m_s)
    rows.append((points.speed, speed * share,
                 f"{drive['mean_speed_m_s']:.3f} m/s on average"
                 f" (all points at {points.speed_best_m_s:g} m/s)"))
    lost = [f"{most * (1 - share):.1f} points: {why}" for most, share, why in rows
            if round(most * (1 - share), 1) > 0]
    return round(sum(most * share for most, share, _ in rows), 2), lost


def mean(points: Sequence[float]) -> float:
    """Mean points of a submission's cases."""
    return round(sum(points) / len(points), 2) if points else 0.0


def _share(value: float, best: float, worst: float) -> float:
    """1 at `best` or better, 0 at `worst` or worse, linear between."""
    if best == worst:
        return float(value <= best)
    return min(max((worst - value) / (worst - best), 0.0), 1.0)


MARKS, PAGE, STUDENTS, STUDENT_PAGE = "marks.csv", "marks.html", "students", "index.html"
SHOWN = (PATH_PICTURE, FILM, RUN_PAGE)  # of a case, on the student's page
FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r")  # a spreadsheet would evaluate such cells
STYLE = ("<style>body{font-family:sans-serif;max-width:60em;margin:2em auto}"
         "img,video{max-width:100%}table{border-collapse:collapse}ul{margin:0;padding-left:1em}"
         "td,th{text-align:left;padding:.4em 1em;border-bottom:1px solid #ccc;"
         "vertical-align:top}td:nth-child(2){text-align:right}td:first-child{white-space:nowrap}"
         "pre{white-space:pre-wrap;background:#f4f4f4;padding:.5em}</style>")


def write_marks(marks: Mapping[str, Sequence[Mark]], rules: Rules, kind: Kind, out: Path) -> None:
    """Write the table of all students, for a spreadsheet and for a browser."""
    cases = sorted({mark.case for rows in marks.values() for mark in rows})
    table = io.StringIO(newline="")
    writer = csv.writer(table)
    writer.writerow(["student", "points", "of", *cases, "sandbox", "why points were lost", "note"])
    for student, rows in marks.items():
        points = {mark.case: mark.points for mark in rows}
        writer.writerow([_cell(student), mean(list(points.values())), rules.points.most,
                         *[points.get(case, "") for case in cases],
                         "no" if kind is Kind.NONE else "yes", _cell("; ".join(_lost(rows))),
                         _notes(rows)])
    write_whole(out / MARKS, table.getvalue().encode("utf-8-sig"))  # Excel needs the BOM
    body = "".join(
        f'<tr><td><a href="{STUDENTS}/{_link(student)}/{STUDENT_PAGE}">{escape(student)}</a></td>'
        f"<td>{mean([mark.points for mark in rows]):g}</td><td>{_list(_lost(rows))}"
        f"{_line(_notes(rows))}</td>"
        f"<td>{''.join(_thumbnail(mark, out) for mark in rows)}</td></tr>\n"
        for student, rows in marks.items())
    warning = ("<p><b>These submissions ran without a sandbox.</b></p>" if kind is Kind.NONE
               else "")
    class_mean = mean([mean([mark.points for mark in rows]) for rows in marks.values()])
    write_whole(out / PAGE, _page(
        "Marks", f"{warning}<p>Course: {escape(rules.course)}. Submissions: {len(marks)}; "
        f"mean: {class_mean:g} of {rules.points.most:g} points. "
        f'<a href="{MARKS}">{MARKS}</a></p><table><tr><th>student</th><th>points</th>'
        f"<th>why points were lost</th><th>path</th></tr>\n{body}</table>").encode())


def write_student_pages(marks: Mapping[str, Sequence[Mark]], rules: Rules, out: Path) -> None:
    """Write students/ID/index.html, beside what `student_file` names."""
    for student, rows in marks.items():
        folder = out / STUDENTS / student
        folder.mkdir(parents=True, exist_ok=True)
        total = mean([mark.points for mark in rows])
        for mark in rows:
            for made in SHOWN if not mark.folder else ():  # of an earlier submission
                student_file(out, student, mark.case, made).unlink(missing_ok=True)
        parts = "".join(_case_part(mark, out) for mark in rows)
        write_whole(folder / STUDENT_PAGE, _page(
            student, f"<p>{total:g} of {rules.points.most:g} points</p>{parts}").encode())


def student_file(out: Path, student: str, case: str, made: str) -> Path:
    """Where a drive's file of SHOWN is kept: in the folder that the student may be sent."""
    return out / STUDENTS / student / f"{case}{Path(made).suffix}"


def _case_part(mark: Mark, out: Path) -> str:
    lost = f"<p>Why points were lost:</p>{_list(mark.lost)}" if mark.lost else ""
    forms = ('<p><img src="{}" alt="the path"></p>', '<p><video src="{}" controls></video></p>',
             '<p><a href="{}">replay in 3D</a></p>')
    paths = [student_file(out, mark.student, mark.case, made) for made in SHOWN]
    shown = "".join(form.format(path.name) for form, path in zip(forms, paths, strict=True)
                    if path.exists())
    outcome = "laps closed" if mark.outcome == "closed" else mark.outcome
    return (f"<h2>{escape(mark.case)}: {mark.points:g} points, {escape(outcome)}</h2>"
            f"{lost}{_line(mark.note)}{shown}{_output(mark, out)}")


def _output(mark: Mark, out: Path) -> str:
    path = out / mark.folder / OUTPUT
    if not mark.folder or not path.exists():
        return ""
    text = visible(path.read_text(encoding="utf-8", errors="replace"))
    return f"<p>What the program printed:</p><pre>{escape(text)}</pre>" if text.strip() else ""


def _thumbnail(mark: Mark, out: Path) -> str:
    paths = [student_file(out, mark.student, mark.case, made) for made in (PATH_PICTURE, FILM)]
    forms = ('<a href="{0}"><img style="width:10em" src="{0}" alt="path"></a>',
             '<br><a href="{0}">film</a>')
    return "".join(form.format(_link(str(path.relative_to(out))))
                   for form, path in zip(forms, paths, strict=True) if path.exists())


def _lost(rows: Sequence[Mark]) -> list[str]:
    several = len(rows) > 1
    return [f"{mark.case}: {each}" if several else each for mark in rows for each in mark.lost]


def _list(lines: Sequence[str]) -> str:
    return f"<ul>{''.join(f'<li>{escape(each)}</li>' for each in lines)}</ul>" if lines else ""


def _notes(rows: Sequence[Mark]) -> str:
    return "; ".join(dict.fromkeys(mark.note for mark in rows if mark.note))


def _line(text: str) -> str:
    return f"<p>{escape(text)}</p>" if text else ""


def _cell(text: str) -> str:
    return f"'{text}" if text.startswith(FORMULA_STARTS) else text


def _link(path: str) -> str:
    return quote(path)


def _page(title: str, body: str) -> str:
    return ('<!DOCTYPE html>\n<html><head><meta charset="utf-8"><title>'
            f"{escape(title)}</title>{STYLE}</head><body>\n<h1>{escape(title)}</h1>\n{body}\n"
            "</body></html>\n")
