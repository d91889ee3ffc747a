"""Nothing in the repository names a folder of the machine it was written on."""

import os
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
MADE_HERE = {".git", ".venv", ".setup", "build", "devel", "install", "out", "__pycache__",
             ".pytest_cache", ".ruff_cache"}
# The made-up user of docker/ and of examples, and what marking's sandbox shows.
PLAIN_HOMES = {"learner", "student", "submission"}
LOCAL = re.compile(r"(?<![\w.$}~*-])/(?:work|root)/\w|(?<![\w.$}~*-])/(?:home|Users)/(\w+)")


def our_files() -> list[Path]:
    """What git tracks or would; without git (in an image), all that was not made here."""
    listed = subprocess.run(
        ["git", "-C", str(ROOT), "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        capture_output=True, check=False) if (ROOT / ".git").exists() else None
    if listed and listed.returncode == 0:
        paths = [ROOT / os.fsdecode(name) for name in listed.stdout.split(b"\0") if name]
    else:
        paths = [Path(folder) / name for folder, folders, names in os.walk(ROOT)
                 if not folders.__setitem__(slice(None), set(folders) - MADE_HERE)
                 for name in names]
    return sorted(path for path in paths if path.is_file() and not path.is_symlink()
                  and not learners_own(path))


def learners_own(path: Path) -> bool:
    """An exercise's starting file; src/exercises/test looks at it as git has it."""
    return path.parent.name == "exercises" and (path.parent.parent / "exercises.yaml").exists()


def local_paths(text: str) -> list[str]:
    return [match.group() for match in LOCAL.finditer(text)
            if match.group(1) not in PLAIN_HOMES]


def test_no_local_paths() -> None:
    found = []
    for path in our_files():
        content = path.read_bytes()
        if path == Path(__file__).resolve() or b"\0" in content[:1000]:
            continue
        for number, line in enumerate(content.decode("utf-8", "replace").splitlines(), 1):
            found += [f"{path.relative_to(ROOT)}:{number}: {place}" for place in local_paths(line)]
    assert not found, "\n" + "\n".join(found)


def test_no_link_that_would_be_text_on_windows() -> None:
    """git makes no links there, and Docker Desktop mounts such a checkout. Four are upstream's."""
    links = [path for folder in ("scripts", "src", "test", "docker")
             for path in (ROOT / folder).rglob("*")
             if path.is_symlink() and not {"__pycache__", "node_modules"} & set(path.parts)]
    assert {path.name for path in links} <= {
        "python2.7", "xacro.py", "listener", "talker", "CMakeLists.txt"}


def test_the_check_itself() -> None:
    assert local_paths("see /root/x") and local_paths("file:///home/anna/x.png")
    assert not local_paths("/home/learner/ws") and not local_paths("src/work/x $HOME/work/y")


@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="no git checkout")
@pytest.mark.parametrize("path", ["env/pyvenv.cfg", "src/evaluation/build/lib/evaluation/a.py"])
def test_what_the_pages_have_pip_make_here_is_ignored(path) -> None:
    done = subprocess.run(["git", "-C", str(ROOT), "check-ignore", "-q", path], check=False)
    assert done.returncode == 0


def test_scripts_can_be_run() -> None:
    """A file that starts with #! and is meant to be run has its executable bit.

    An exercise's solution is meant to be copied: rosrun shall find the learner's file.
    """
    scripts = [path for path in our_files()
               if path.read_bytes()[:2] == b"#!" and path.parent.name != "solutions"]
    assert scripts
    dead = [str(path.relative_to(ROOT)) for path in scripts if not os.access(path, os.X_OK)]
    assert not dead, dead
