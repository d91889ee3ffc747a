"""Packages of built workspaces that a terminal has not sourced."""

import os
from pathlib import Path

from bullet_sim_ros.unsourced import unsourced


def built(folder: Path, *packages: str) -> Path:
    """A workspace that looks built, with these packages."""
    (folder / "devel").mkdir(parents=True)
    (folder / "devel/setup.bash").touch()
    for package in packages:
        (folder / "src" / package).mkdir(parents=True)
        (folder / "src" / package / "package.xml").touch()
    return folder


def test_a_built_workspace_around_here_or_in_the_home_has_it(tmp_path, monkeypatch):
    home = built(tmp_path / "home/my_ws", "legs", "robots/wings").parent
    monkeypatch.setattr(Path, "home", lambda: home)
    monkeypatch.chdir(tmp_path)
    said = f"; its workspace is not sourced: source {home}/my_ws/devel/setup.bash"
    assert unsourced("legs") == unsourced("wings") == said
    assert unsourced("fins") == ""
    here = built(tmp_path / "work", "legs")
    monkeypatch.chdir(here / "src/legs")
    assert unsourced("legs").endswith(f"source {here}/devel/setup.bash")


def test_folders_that_are_gone_or_somebody_elses_have_no_workspace(tmp_path, monkeypatch):
    home, gone = built(tmp_path / "home/my_ws", "legs").parent, tmp_path / "gone"
    (home / "a_private").mkdir()
    gone.mkdir()
    monkeypatch.setattr(Path, "home", lambda: home)
    monkeypatch.chdir(gone)
    gone.rmdir()
    stat = os.stat

    def refusing(path, *given, **options):
        if "a_private/" in os.fspath(path):
            raise PermissionError(13, "Permission denied", path)
        return stat(path, *given, **options)

    monkeypatch.setattr(os, "stat", refusing)
    assert unsourced("legs").endswith(f"source {home}/my_ws/devel/setup.bash")
