"""`make lab`: who gets in, what is laid out, what its buttons do, and what is left at its end."""

import asyncio
import errno
import itertools
import json
import re
import subprocess
import sys
import urllib.error
import urllib.parse
import urllib.request
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import aiohttp
import psutil
import pytest
import yaml
from running_lab import LIMIT, ROOT, SCRIPTS, TOOL, ended, free_port, page_port, started

pytestmark = pytest.mark.processes
sys.path.append(str(TOOL))
import courses_lab  # noqa: E402
import folder  # noqa: E402
import settings  # noqa: E402


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    lab = started(tmp_path_factory.mktemp("lab"), "--port", str(free_port()))
    yield lab
    assert ended(lab) == 0, lab.output.read_text()


def words(process: psutil.Process) -> list[str]:
    """Its command line; of one that has just ended there is none."""
    try:
        return process.cmdline()
    except (psutil.ZombieProcess, psutil.NoSuchProcess):
        return []


def test_nobody_gets_in_without_the_token(lab):
    for token in ("", "wrong"):
        assert lab.ask("/api/contents", token=token)[0] == 403
        assert lab.ask("/courses/menu", token=token)[0] == 403
        assert lab.ask("/courses/do", {"act": "course", "what": "line"}, token=token)[0] == 403
        status, text = lab.ask("/simulator/about", token=token)
        assert status == 403 or "password_input" in text  # Jupyter's page that asks for it
        assert "password_input" in lab.ask("/lab", token=token)[1]
    with pytest.raises(urllib.error.HTTPError, match="403"):  # the page itself, past the lab
        urllib.request.urlopen(f"http://127.0.0.1:{page_port(lab)}/about")
    assert lab.ask("/api/contents")[0] == 200
    family = {child: words(child)
              for child in psutil.Process(lab.process.pid).children(recursive=True)}
    listening = {one.laddr.ip for child, its in family.items() if "jupyterlab" in its
                 for one in child.net_connections() if one.status == psutil.CONN_LISTEN}
    assert listening == {"127.0.0.1"}
    assert (lab.ws / ".lab").stat().st_mode & 0o077 == 0
    assert lab.token not in " ".join(itertools.chain(*family.values()))


def test_who_has_the_token_may_drive(lab):
    assert lab.ask("/simulator/about")[1]["control"] is True
    assert lab.ask("/simulator/about")[1]["master"].rstrip("/") == lab.master()

    async def story():
        headers = {"Authorization": f"token {lab.token}", "Origin": lab.base}
        async with (aiohttp.ClientSession(headers=headers) as http,
                    http.ws_connect(f"{lab.base}/simulator/ws") as link, asyncio.timeout(LIMIT)):
            await link.send_json({"id": 1, "call": "about", "args": {}})
            async for message in link:
                if message.type == aiohttp.WSMsgType.TEXT and "id" in message.json():
                    return message.json()
    assert asyncio.run(story())["id"] == 1


def test_the_first_start_lays_out_page_script_world_and_terminal(lab):
    status, workspace = lab.ask("/lab/api/workspaces/default")
    assert status == 200
    widgets = {name.partition(":")[0]: entry["data"] for name, entry in workspace["data"].items()
               if name != "layout-restorer:data"}
    assert set(widgets) == {"markdownviewer-widget", "editor", "server-proxy", "terminal"}
    for name in ("markdownviewer-widget", "editor"):
        assert lab.ask(f"/api/contents/{widgets[name]['path']}")[0] == 200
    assert lab.ask(widgets["server-proxy"]["url"])[0] == 200
    proxied = lab.ask("/server-proxy/servers-info")[1]["server_processes"]
    assert [entry["name"] for entry in proxied] == ["simulator"]


def test_every_tile_leads_somewhere(lab):
    menu = lab.ask("/courses/menu")[1]
    assert [course["name"] for course in menu["courses"]] == [
        "line", "waits", "racecar", "house", "lanes", "tracking", "autorace", "turtlesim"]
    courses = yaml.safe_load((TOOL / "lessons.yaml").read_text("utf-8"))["courses"]
    assert all(course["zh"] for course in courses.values())
    for entry in menu["lessons"] + menu["exercises"]:
        for path in (entry["page"], entry["script"]):
            assert lab.ask(f"/api/contents/{path}?content=0")[0] == 200, path
    assert len(menu["lessons"]) > 20 and len(menu["exercises"]) > 10
    config = re.search(r'id="jupyter-config-data"[^>]*>(.*?)</script>', lab.ask("/lab")[1],
                       re.DOTALL)
    extensions = {one["name"] for one in json.loads(config[1])["federated_extensions"]}
    assert {"courses-lab", "@jupyterhub/jupyter-server-proxy"} <= extensions


def test_a_script_runs_again_after_ctrl_c(lab):
    script = lab.ws / SCRIPTS / "forever.py"
    script.write_text("import os, time\nprint('begun as', os.getpid(), flush=True)\n"
                      "import rospy\nprint('rospy is', rospy.__name__, flush=True)\n"
                      "while True:\n    time.sleep(1)\n")
    for _ in range(2):
        status, answer = lab.do("run", f"{SCRIPTS}/forever.py")
        assert (status, answer) == (200, {"terminal": "run"})
        lab.shown("run", r"begun as \d+")
    text = lab.shown("run", r"begun as \d+.*KeyboardInterrupt.*begun as \d+.*rospy is rospy")
    first, second = re.findall(r"begun as (\d+)", text)
    assert not psutil.pid_exists(int(first)) and psutil.pid_exists(int(second))


def test_what_is_wrong_with_a_script_is_said(lab):
    (lab.ws / SCRIPTS / "broken.py").write_text("print('x'\n")
    assert lab.do("run", f"{SCRIPTS}/broken.py")[0] == 200
    lab.shown("run", "broken.py.*SyntaxError")
    for what, word in (("../../etc/passwd", "there is no file"), ("nothing.py", "there is no file"),
                       ("src/my_lessons/package.xml", "cannot be run")):
        status, answer = lab.do("run", what)
        assert (status, word in answer["message"]) == (409, True), answer
    assert lab.do("course", "nowhere") == (409, {"message": "there is no course nowhere"})
    assert lab.ask("/courses/do", {"act": "dance", "what": ""})[0] == 400


def test_reset_brings_the_lesson_s_file_back_and_keeps_the_other(lab):
    ours = ROOT / "src/learning_topic/scripts/05follower_proporation.py"
    before, path = ours.read_text(), f"{SCRIPTS}/05follower_proporation.py"
    lab.ask(f"/api/contents/{path}", {"type": "file", "format": "text", "content": "mine\n"},
            method="PUT")
    assert (lab.ws / path).read_text() == "mine\n" and ours.read_text() == before
    status, answer = lab.do("reset", path)
    assert status == 200
    assert (lab.ws / path).read_text() == before
    assert (lab.ws / answer["kept"]).read_text() == "mine\n"
    status, answer = lab.do("reset", f"{SCRIPTS}/broken.py")
    assert status == 409 and "no copy of a lesson's file" in answer["message"]
    done = subprocess.run([sys.executable, TOOL, "--ws", lab.ws, "--reset", ours.name],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "your version is kept as" in done.stdout


def test_an_exercise_is_checked(lab):
    assert lab.do("check", "white_line") == (200, {"terminal": "check"})
    lab.shown("check", "FAIL")


def test_the_pages_are_read_only_and_ours_are_not_in_reach(lab):
    page = lab.ws / "pages/src/learning_topic/README.md"
    assert page.stat().st_mode & 0o222 == 0 and not page.is_symlink()
    assert not [path for path in (lab.ws / "src").rglob("*")
                if path.is_symlink() and ROOT in path.resolve().parents
                and path.name != "CMakeLists.txt"]


def test_an_image_of_the_marked_lap_is_gone_back_to_in_the_course_s_terminal(lab):
    assert lab.do("back", "lost") == (200, {"terminal": "course"})
    lab.shown("course", r"replay: no run at out/course")
    command = courses_lab.command_of("back", folder.Folder(lab.ws), "12.5; ls")
    assert command.endswith("replay.py --here --run out/course --at '12.5; ls'")


def test_a_full_disk_leaves_no_half_of_a_lesson(tmp_path, monkeypatch):
    own = folder.Folder(tmp_path)
    (own.package / "devel").mkdir(parents=True)
    (own.package / "package.xml").touch()

    def half(source, target):
        Path(target).write_text(Path(source).read_text()[:10])
        raise OSError(errno.ENOSPC, "No space left on device", str(source))

    with monkeypatch.context() as disk, pytest.raises(OSError, match="No space") as full:
        disk.setattr(folder.shutil, "copy", half)
        own.fill()
    assert full.value.filename.startswith(str(own.package))  # where there is to be room
    assert not [path for path in own.package.rglob("*.py*") if path.is_file()]


def test_nobody_else_reads_the_token_also_in_a_folder_that_was_copied(tmp_path):
    own = folder.Folder(tmp_path / "ws")
    own.state.mkdir(0o755, parents=True)
    with own.take():
        assert own.state.stat().st_mode & 0o777 == 0o700


def test_a_second_reset_keeps_what_the_first_one_kept(tmp_path, monkeypatch):
    own, name = folder.Folder(tmp_path), "05follower_proporation.py"
    monkeypatch.setattr(folder.time, "strftime", lambda _format: "20260101-120000")
    file = tmp_path / SCRIPTS / name
    file.parent.mkdir(parents=True)
    file.write_text("mine\n")
    first, second = own.reset(file), own.reset(file)
    assert first.read_text() == "mine\n" and second != first


@pytest.mark.parametrize(("name", "line"), [
    ("", "name a file: reset_lesson 05follower_proporation.py"),
    ("05folower.py", "05folower.py is no copy of a lesson's file: there is "
     "nothing to reset it to; is 05follower_proporation.py meant?"),
    ("zzz", "zzz is no copy of a lesson's file: there is nothing to reset it to")])
def test_reset_names_the_file_that_is_meant(name, line, tmp_path):
    assert refused("--ws", str(tmp_path), "--reset", name) == f"lab: {line}\n"
    assert not list(tmp_path.iterdir())


def test_reset_lesson_passes_on_what_is_typed(tmp_path):
    own = folder.Folder(tmp_path)
    own.state.mkdir()
    settings.write_terminal(own, "http://localhost:1")
    define = next(line for line in (own.state / "bashrc").read_text().splitlines()
                  if line.startswith("reset_lesson"))
    for typed, said in (("", "name a file"), ("a b", "a b is no copy")):
        done = subprocess.run(["bash", "-c", f"{define}\nreset_lesson {typed}"], text=True,
                              capture_output=True, timeout=LIMIT, check=False)
        assert done.stderr.startswith(f"lab: {said}") and done.stderr.count("\n") == 1


def refused(*words: str) -> str:
    """What a lab prints that does not start."""
    done = subprocess.run([sys.executable, TOOL, *words], capture_output=True, text=True,
                          timeout=LIMIT, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("lab: ") and done.stderr.count("\n") == 1, done.stderr
    return done.stderr


def test_what_cannot_be_is_one_line(lab, tmp_path):
    taken = lab.base.rsplit(":", 1)[1]
    assert f"port {taken} is taken" in refused("--ws", str(tmp_path / "a"), "--port", taken)
    assert "give one from 1024" in refused("--ws", str(tmp_path / "a"), "--port", "80")
    assert f"A lab runs already in {lab.ws}: {lab.base}" in refused("--ws", str(lab.ws))
    assert "the courses' own folder" in refused("--ws", str(ROOT / "src/mine"))
    (tmp_path / "file").write_text("")
    for path in (tmp_path / "file", "/proc/lab"):  # there, and not to be made
        assert refused("--ws", str(path)) == (
            f"lab: {path} cannot be written by you: name a folder of your own, such as: make lab "
            "WS=~/my_ws\n")
    assert not (tmp_path / "a").exists()


def test_two_labs_that_start_at_once_find_a_port_each(tmp_path):
    with ThreadPoolExecutor() as pool:
        labs = list(pool.map(lambda name: started(tmp_path / name), "ab"))
    try:
        assert labs[0].base != labs[1].base
    finally:
        assert [ended(one) for one in labs] == [0, 0]


def test_two_labs_never_meet(lab, tmp_path):
    other = started(tmp_path, "--port", str(free_port()), language="zh_CN")
    try:
        assert other.master() != lab.master() and page_port(other) != page_port(lab)
        assert other.ask("/api/contents", token=lab.token)[0] == 403
        menu = other.ask("/courses/menu")[1]
        assert menu["texts"]["run"] == "运行"
        assert all(lesson["page"].endswith("README.zh-CN.md") for lesson in menu["lessons"])
        locale = other.ask("/lab/api/settings/@jupyterlab/translation-extension:plugin")[1]
        assert locale["schema"]["properties"]["locale"]["default"] == "zh_CN"
        (other.ws / SCRIPTS / "01follower.py").write_text("mine\n")
    finally:
        assert ended(other) == 0
    again = started(tmp_path, "--port", str(free_port()))
    try:
        assert again.token != other.token
        assert (again.ws / SCRIPTS / "01follower.py").read_text() == "mine\n"
    finally:
        assert ended(again) == 0
