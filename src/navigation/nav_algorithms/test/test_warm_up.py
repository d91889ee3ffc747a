"""Machine code that was kept is stale when a file that it was made from has changed."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from nav_algorithms import compiled


def names_of(name: str) -> set[str]:
    """Files, without suffix, that the stamp of a module looks at."""
    return {path.stem for path in compiled._sources(compiled.PACKAGE / name)}


def test_the_stamp_follows_both_ways_of_importing():
    assert {"footprint", "likelihood_field", "compiled"} <= names_of("costmap/footprint.py")
    assert {"particle_slam", "poses", "hit_maps"} <= names_of("particle_slam.py")
    assert "rays" not in names_of("poses.py")


def test_the_stamp_changes_with_what_is_called(tmp_path, monkeypatch):
    monkeypatch.setattr(compiled, "PACKAGE", tmp_path)
    caller, callee = tmp_path / "caller.py", tmp_path / "callee.py"
    caller.write_text("from nav_algorithms.callee import one\n")
    callee.write_text("one = 1\n")

    def stamp() -> str:
        compiled._text.cache_clear()
        locator = compiled.BesideSource.__new__(compiled.BesideSource)
        locator._py_file = str(caller)
        return locator.get_source_stamp()

    before = stamp()
    assert stamp() == before
    callee.write_text("one = 2\n")
    assert stamp() != before
    compiled._text.cache_clear()


def test_an_installed_package_keeps_its_machine_code_with_the_user(tmp_path):
    modules, home = tmp_path / "lib/python3/dist-packages", tmp_path / "home"
    (modules / "nav_algorithms").mkdir(parents=True)
    for name in ("__init__.py", "compiled.py"):
        shutil.copy(Path(compiled.__file__).parent / name, modules / "nav_algorithms")
    (modules / "nav_algorithms/one.py").write_text(
        "from nav_algorithms.compiled import compiled\n"
        "@compiled('i8(i8)')\ndef one(x):\n    return x + 1\n")
    environment = {"HOME": str(home), "PYTHONPATH": str(modules), "PATH": os.environ["PATH"],
                   "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-c", "from nav_algorithms.one import one; print(one(1))"]
    first, second = (subprocess.run(command, env=environment, capture_output=True, text=True,
                                    timeout=120, check=True) for _ in range(2))
    assert first.stdout == second.stdout == "2\n"
    assert first.stderr.count("compiling the inner loops") == 1 and not second.stderr
    assert str(home / ".cache") in first.stderr
    assert list(home.rglob("*.nbi")) and not list(modules.rglob("*.nbi"))
