"""JupyterLab's settings for a lab: its configuration, the layout of its first start, terminals."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

from folder import PACKAGE, ROOT, Folder, offers, source_of
from jupyterlab_server.workspaces_handler import WorkspacesManager

FIRST_PORT, TRIED = 8888, 100
HERE = Path(__file__).resolve().parent
FIRST = "05follower_proporation.py"  # the lesson that is open at first: the first one that drives
EXTENSIONS = ("jupyterlab", "jupyter_server_proxy", "jupyter_server_terminals", "courses_lab")
TITLES = {"en": "World", "zh": "仿真世界"}
SIMULATOR = "server-proxy:simulator"  # as jupyter-server-proxy calls the tab of its server


def write_settings(folder: Folder, language: str, page_port: int, page_token: str, browser: bool,
                   port: int | None, token: str) -> Path:
    """Write all of them; returns the configuration file, which has both tokens.

    `port`: None for the first free one.
    """
    texts = offers()["texts"]
    config = {
        "ServerApp": {
            "ip": "127.0.0.1", "port": port or FIRST_PORT, "port_retries": 0 if port else TRIED,
            "root_dir": str(folder.path), "open_browser": browser, "allow_root": True,
            "log_level": "WARN",
            "jpserver_extensions": dict.fromkeys(EXTENSIONS, True),
            "terminado_settings": {"shell_command": [
                "bash", "--rcfile", str(folder.state / "bashrc")]},
        },
        "IdentityProvider": {"token": token},
        "LabApp": {"extension_manager": "readonly", "news_url": None,
                   "check_for_updates_class": "jupyterlab.NeverCheckForUpdate",
                   "workspaces_dir": str(folder.state / "workspaces")},
        "LabServerApp": {"extra_labextensions_path": [str(HERE / "labextensions")]},
        "ServerProxy": {"servers": {"simulator": {
            "port": page_port,  # no command: it runs already
            # Who is behind the lab's token may drive; a browser's own cookies stay in the lab.
            "request_headers_override": {"Cookie": f"sim_viewer_{page_port}={page_token}"},
            "launcher_entry": {"title": TITLES[language], "category": texts["lessons"][language],
                               "path_info": f"simulator/?{language}"}}}},
    }
    file = folder.state / "config.json"
    file.touch(0o600)
    file.write_text(json.dumps(config, indent=1), "utf-8")
    overrides = {
        "@jupyterlab/translation-extension:plugin": {
            "locale": {"en": "en", "zh": "zh_CN"}[language]},
        "@jupyterlab/apputils-extension:notification": {
            "fetchNews": "false", "checkForUpdates": False},
    }
    settings = folder.state / "config/labconfig/default_setting_overrides.json"
    settings.parent.mkdir(parents=True, exist_ok=True)
    settings.write_text(json.dumps(overrides), "utf-8")
    return file


def write_terminal(folder: Folder, master_uri: str) -> None:
    """What each terminal of the lab starts with."""
    lab = " ".join(map(shlex.quote, ("python3", str(HERE), "--ws", str(folder.path))))
    (folder.state / "bashrc").write_text(
        "[ ! -f ~/.bashrc ] || . ~/.bashrc\n"
        f". {shlex.quote(str(folder.path / 'devel/setup.bash'))}\n"
        f"export ROS_MASTER_URI={master_uri} ROS_HOSTNAME=localhost\n"
        f'reset_lesson() {{ {lab} --reset "$*"; }}\n'
        "PS1='(lab) \\w\\$ '\n", "utf-8")


def lay_out(folder: Folder, language: str) -> None:
    """The panels of the first start; those that a learner has arranged stay."""
    manager = WorkspacesManager(str(folder.state / "workspaces"))
    if manager.list_workspaces():
        return
    page = page_of("learning_topic", language)
    script = f"src/{PACKAGE}/scripts/learning_topic/{FIRST}"
    widgets = {
        f"markdownviewer-widget:{page}": {"path": page, "factory": "Markdown Preview"},
        f"editor:{script}": {"path": script, "factory": "Editor"},
        f"server-proxy:{SIMULATOR}": {
            "url": f"/simulator/?{language}", "title": TITLES[language],
            "newBrowserTab": False, "id": SIMULATOR},
        "terminal:1": {"name": "1"},
    }
    tabs = [{"type": "tab-area", "currentIndex": 0, "widgets": [name]} for name in widgets]
    above = {"type": "split-area", "orientation": "horizontal", "sizes": [0.3, 0.35, 0.35],
             "children": tabs[:3]}
    dock = {"type": "split-area", "orientation": "vertical", "sizes": [0.7, 0.3],
            "children": [above, tabs[3]]}
    side = {"collapsed": True, "visible": True, "current": None, "widgets": []}
    layout = {"main": {"dock": dock, "current": f"editor:{script}"}, "left": side, "right": side,
              "relativeSizes": [0, 1, 0]}
    data = {"layout-restorer:data": layout} | {
        name: {"data": args} for name, args in widgets.items()}
    manager.save("default", json.dumps({"data": data, "metadata": {"id": "default"}}))


def page_of(package: str, language: str) -> str:
    """The lesson's page in that language, below the learner's folder."""
    end = ".zh-CN" if language == "zh" else ""
    return f"pages/{source_of(package).relative_to(ROOT)}/README{end}.md"
