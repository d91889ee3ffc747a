"""rosed after sourcing: the editor that is asked for, or one that is here."""

import os
import subprocess
from pathlib import Path

import pytest

HOOK = Path(__file__).resolve().parents[1] / "env-hooks" / "51.bullet_sim_ros.bash"
FILE = HOOK.parents[1] / "package.xml"


@pytest.fixture
def bash(tmp_path):
    """Runs a command after the hook, with an editor called nano and no screen."""
    nano = tmp_path / "nano"
    nano.write_text('#!/bin/sh\necho nano "$@"\n', encoding="utf-8")
    nano.chmod(0o755)
    screens = ("DISPLAY", "WAYLAND_DISPLAY", "EDITOR")
    plain = {name: value for name, value in os.environ.items() if name not in screens}

    def run(command, **variables):
        path = f"{tmp_path}:{os.environ['PATH']}"
        return subprocess.run(["bash", "-c", f". {HOOK}; . {HOOK}; {command}"], text=True,
                              env=plain | {"PATH": path} | variables, capture_output=True,
                              timeout=60, check=False)
    return run


@pytest.mark.parametrize("editor, said", [
    ("nano -w", ""), ("gedit", "rosed: gedit has no screen here; nano opens {}\n"),
    ("no-such", "rosed: no-such is not installed; nano opens {}\n")])
def test_a_file_of_a_package_is_opened(bash, editor, said):
    done = bash("rosed bullet_sim_ros package.xml", EDITOR=editor)
    assert done.stdout == f"nano {'-w ' if editor == 'nano -w' else ''}{FILE}\n"
    assert done.stderr == said.format(FILE)


def test_the_line_is_chinese_in_a_chinese_terminal(bash):
    done = bash("rosed bullet_sim_ros package.xml", EDITOR="no-such",
                LANGUAGE="zh_CN", LC_ALL="C.UTF-8")
    assert done.stderr == f"rosed：没有安装 no-such；改用 nano 打开 {FILE}\n"


def test_without_editor_set_it_is_vim(bash, tmp_path):
    (tmp_path / "vim").symlink_to(tmp_path / "nano")
    assert bash("rosed bullet_sim_ros package.xml").stdout == f"nano {FILE}\n"


def test_with_none_at_all_it_says_which_to_install(bash, tmp_path):
    done = bash(f"PATH={tmp_path}/nowhere; _rosed_with vim a.txt")
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == ("rosed: vim is not installed, and no other editor is installed; type: "
                           "sudo apt-get install nano\n")
