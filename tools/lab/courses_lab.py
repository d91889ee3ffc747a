"""The lab's part of the Jupyter server: what its tiles and buttons do, in terminals that stay.

    GET  /courses/menu   what there is to start, open and check, in the lab's language
    POST /courses/do     {"act": ..., "what": ...}: run, lap or reset a file, check an exercise,
                         start a course, go back to an image of the marked lap

An act types a command into its terminal, where Ctrl-C first ends what still runs there.
"""

from __future__ import annotations

import asyncio
import json
import os
import shlex
from pathlib import Path
from typing import Any
from weakref import WeakSet

from folder import PACKAGE, ROOT, Folder, LabError, offers
from jupyter_server.base.handlers import APIHandler
from jupyter_server.utils import url_path_join
from settings import page_of
from terminal_language import translated
from tornado import web

from exercises.catalogue import find_exercises

READY = "(lab) "  # how the prompt begins
START_TIME = 60.0  # s until a new terminal has a prompt
END_TIME = 20.0  # s that what runs may take to end after Ctrl-C
BEGIN_TIME = 3.0  # s until the shell has started it
PERIOD = 0.1  # s between two looks
PROGRAMS = ROOT / "src/evaluation/scripts"
RUNNERS = {".py": "python3", ".launch": "roslaunch", ".sh": "bash"}
TERMINALS = {"course": "course", "back": "course", "run": "run", "lap": "run", "check": "check"}
MARKED = "out/course"  # where a marked lap's results are, below the folder


class Terminals:
    """The terminals in which acts run, by name."""

    def __init__(self, settings: dict[str, Any]) -> None:
        self._settings = settings  # in which another extension puts its manager later
        self._turns: dict[str, asyncio.Lock] = {}
        self._ready: WeakSet[Any] = WeakSet()  # their first prompt may have left the buffer since

    async def type(self, name: str, command: str, folder: Path) -> None:
        """Type this command, once what runs there has ended; LabError if it does not end."""
        async with self._turns.setdefault(name, asyncio.Lock()):
            manager = self._settings["terminal_manager"]
            if name not in manager.terminals:
                manager.create(name=name, cwd=str(folder))
            terminal = manager.terminals[name]
            if terminal not in self._ready and not await _becomes(
                    lambda: READY in "".join(terminal.read_buffer), START_TIME):
                raise LabError(f"the terminal {name} does not start: close it, then try again")
            self._ready.add(terminal)
            shell = terminal.ptyproc
            if os.tcgetpgrp(shell.fd) != shell.pid:
                shell.write("\x03")
                if not await _becomes(lambda: os.tcgetpgrp(shell.fd) == shell.pid, END_TIME):
                    raise LabError(f"what runs in the terminal {name} did not end by Ctrl-C: "
                                   "close that terminal, then try again")
            shell.write(f"\x15{command}\r")  # Ctrl-U: what was typed there and not sent
            # The next act must find it running; one that has ended meanwhile is missed.
            await _becomes(lambda: os.tcgetpgrp(shell.fd) != shell.pid, BEGIN_TIME)


async def _becomes(condition: Any, limit: float) -> bool:
    end = asyncio.get_running_loop().time() + limit
    while not condition():
        if asyncio.get_running_loop().time() > end:
            return False
        await asyncio.sleep(PERIOD)
    return True


def command_of(act: str, folder: Folder, what: str) -> str:
    """What is typed for an act: a path below the folder, or a name; LabError if there is none."""
    if act == "course":
        if what not in offers()["courses"]:
            raise LabError(f"there is no course {what}")
        return offers()["courses"][what]["command"]
    if act == "check":
        exercise = find_exercises().get(what)
        if exercise is None:
            raise LabError(f"there is no exercise {what}")
        own = f"src/{PACKAGE}/exercises/{exercise.start.name}"
        file = own if (folder.path / own).exists() else str(exercise.start)
        return shlex.join(["rosrun", "exercises", "check_exercise", what, file])
    if act == "back":  # in the course's terminal: there is one world at a time
        return shlex.join(["python3", str(PROGRAMS / "replay.py"), "--here", "--run", MARKED,
                           "--at", what])
    file = (folder.path / what).resolve()
    if not (file.is_relative_to(folder.path) and file.is_file()):
        raise LabError(f"there is no file {what}")
    if act == "lap":
        return shlex.join([
            "python3", str(PROGRAMS / "course_run.py"), "--fast", "--any-port", "--no-video",
            "--out", MARKED, "--launch", "learning_topic", "course_follow.launch",
            "--launch-arg", f"package:={PACKAGE}", "--launch-arg", f"follower:={file.name}"])
    if file.suffix not in RUNNERS:
        raise LabError(f"{file.name} cannot be run: open a file that ends in "
                       f"{', '.join(RUNNERS)}")
    return shlex.join([RUNNERS[file.suffix], what])


def menu(folder: Folder, language: str) -> dict[str, Any]:
    """All that the tiles and buttons offer, in this language."""
    at = {"en": 0, "zh": 1}[language]
    table = offers()
    lessons = [{"label": f"{package}/{name}", "page": page_of(package, language),
                "script": f"src/{PACKAGE}/scripts/{package}/{name}", "course": lesson["course"]}
               for package, lesson in table["lessons"].items() for name in lesson["scripts"]]
    checks = [{"name": name, "label": f"{name}: {exercise.title.split('  ')[at]}",
               "page": page_of(exercise.file.parent.name, language),
               "script": f"src/{PACKAGE}/exercises/{exercise.start.name}"}
              for name, exercise in find_exercises().items()
              if exercise.start.suffix == ".py"
              and (folder.path / page_of(exercise.file.parent.name, language)).exists()]
    return {"texts": {key: text[language] for key, text in table["texts"].items()},
            "lessons": lessons, "exercises": checks, "marks": MARKED,
            "courses": [{"name": name, "label": course[language]}
                        for name, course in table["courses"].items()]}


class MenuHandler(APIHandler):
    """GET /courses/menu."""

    @web.authenticated
    def get(self) -> None:
        lab = self.settings["courses_lab"]
        self.finish(json.dumps(menu(lab["folder"], lab["language"])))


class ActHandler(APIHandler):
    """POST /courses/do: answers {"terminal": name} or {"kept": path}; 409 with the reason."""

    @web.authenticated
    async def post(self) -> None:
        asked = self.get_json_body()
        lab = self.settings["courses_lab"]
        folder: Folder = lab["folder"]
        try:
            act, what = str(asked["act"]), str(asked["what"])
            if act == "reset":
                kept = folder.reset(Path(what))
                self.finish({"kept": str(kept.relative_to(folder.path))})
                return
            terminal = TERMINALS[act]
            await lab["terminals"].type(terminal, command_of(act, folder, what), folder.path)
            self.finish({"terminal": terminal})
        except (KeyError, TypeError):
            raise web.HTTPError(400, reason="act and what are missing or unknown") from None
        except (LabError, OSError) as error:
            self.set_status(409)
            self.finish({"message": translated(str(error))})


def _jupyter_server_extension_points() -> list[dict[str, str]]:
    return [{"module": "courses_lab"}]


def _load_jupyter_server_extension(server: Any) -> None:
    settings = server.web_app.settings
    settings["courses_lab"] = {
        "folder": Folder(Path(server.root_dir)), "language": os.environ["LAB_LANGUAGE"],
        "terminals": Terminals(settings)}
    base = settings["base_url"]
    server.web_app.add_handlers(".*$", [
        (url_path_join(base, "courses/menu"), MenuHandler),
        (url_path_join(base, "courses/do"), ActHandler)])
