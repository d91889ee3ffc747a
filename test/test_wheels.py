"""`make wheels`: equal bytes twice, and what pip installs from them drives without ROS."""

import os
import re
import runpy
import shutil
import subprocess
import sys
import zipfile
from email.parser import Parser
from importlib.metadata import distribution, version
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from bullet_sim import __version__

ROOT = Path(__file__).resolve().parent.parent
pytestmark = pytest.mark.skipif(not (ROOT / ".git").exists(), reason="built in a clone alone")
NAMES = {"ai_robot_tracking", "bullet_sim", "car_control", "driving_courses", "evaluation",
         "node_basics", "racecar_description"}
SECONDS = 1_700_000_000
DRIVE = """
import gymnasium, driving_courses, numpy as np
from driving_courses.randomisation import Randomisation, draw
for name in driving_courses.ENVIRONMENTS:
    env = gymnasium.make(name, size=(16, 12)).unwrapped
    world, _ = env._task.begin(draw(Randomisation(), np.random.default_rng(0)))
    print(len(world.models) > 0, env.course.robot)
env = gymnasium.make("driving_courses/LineFollow-v0", observation="features")
features, _ = env.reset(seed=0)
for _ in range(10):
    features, _, _, _, info = env.step(np.array([0.3, 0.0], np.float32))
print(features[3] == 1.0 and info["progress_m"] > 0.02, driving_courses.__file__)
"""


def build(folder: Path, mask: int, **environment: str) -> subprocess.CompletedProcess:
    """As scripts/wheels.sh builds, with that time and umask."""
    return subprocess.run(
        [sys.executable, ROOT / "scripts/build_wheels.py", folder], text=True, check=True,
        capture_output=True, umask=mask, cwd=folder.parent,
        env={"PATH": os.environ["PATH"], "PYTHONPATH": str(ROOT / ".venv/wheels"),
             "SOURCE_DATE_EPOCH": str(SECONDS), **environment})


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> Path:
    """The folder with wheels and source packages."""
    folder = tmp_path_factory.mktemp("made") / "wheels"
    build(folder, 0o022)
    return folder


@pytest.fixture(scope="module")
def metadata(made) -> dict:
    """Each wheel's, by its name."""
    found = {}
    for path in made.glob("*.whl"):
        with zipfile.ZipFile(path) as wheel:
            (name,) = [name for name in wheel.namelist() if name.endswith(".dist-info/METADATA")]
            found[path.name.partition("-")[0]] = Parser().parsestr(wheel.read(name).decode())
    return found


def test_two_builds_are_equal_to_the_byte(made, tmp_path):
    other = tmp_path / "wheels"
    other.mkdir()
    (other / "bullet_sim-0.9.0-py3-none-any.whl").touch()  # of an older build
    build(other, 0o077, TZ="Asia/Shanghai", PYTHONHASHSEED="7", TMPDIR=str(tmp_path))
    assert contents(other) == contents(made)
    endings = ("-py3-none-any.whl", ".tar.gz")
    assert set(contents(made)) == {f"{name}-{__version__}{end}" for name in NAMES
                                   for end in endings}


@pytest.mark.parametrize("page", ["README.md", "README.zh-CN.md"])
def test_the_page_names_the_folders_that_are_built(page):
    text = (ROOT / "src/driving_courses" / page).read_text(encoding="utf-8")
    packages = runpy.run_path(str(ROOT / "scripts/build_wheels.py"))["PACKAGES"]
    assert tuple(re.findall(r"\./src/(\S+)", text)) == packages


def test_what_they_require_is_what_is_tested_here(metadata):
    assert set(metadata) == NAMES
    for name, fields in metadata.items():
        assert (fields["Version"], fields["License"]) == (__version__, "BSD-3-Clause")
        assert fields["License-File"] == "LICENSE" and fields["Requires-Python"] == ">=3.11"
        for line in fields.get_all("Requires-Dist"):
            needed = Requirement(line)
            own = needed.name.replace("-", "_") in NAMES
            assert own or "<" in line or needed.name == "PyYAML", f"{name}: {line}"
            assert needed.specifier.contains(__version__ if own else version(needed.name))


def link_what_pip_would_fetch(lines: list[str], modules: Path) -> None:
    """Links what these requirements, and theirs, have installed here, and nothing else."""
    seen, wanted = set(), [Requirement(line) for line in lines]
    while wanted:
        needed = wanted.pop()
        name = needed.name.lower().replace("-", "_")
        applies = not needed.marker or needed.marker.evaluate({"extra": ""})
        if name in NAMES | seen or not applies:
            continue
        seen.add(name)
        found = distribution(needed.name)
        wanted += map(Requirement, found.requires or ())
        # Debian's packages have no list of their files.
        tops = ({file.parts[0] for file in found.files} if found.files
                else (found.read_text("top_level.txt") or "").split())
        for top in tops:
            there = Path(found.locate_file(top))
            if there.exists() and top not in ("..", "__pycache__"):
                (modules / top).symlink_to(there)


def test_what_is_installed_from_them_drives_without_ros(made, metadata, tmp_path):
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path / "env"], check=True)
    python = tmp_path / "env/bin/python"
    subprocess.run([sys.executable, "-m", "pip", "--python", python, "install", "--quiet",
                    "--no-index", "--no-deps", "--no-compile", *made.glob("*.whl")], check=True)
    (modules,) = (tmp_path / "env").glob("lib/python*/site-packages")
    link_what_pip_would_fetch([line for fields in metadata.values()
                               for line in fields.get_all("Requires-Dist")], modules)
    done = subprocess.run([python, "-I", "-c", DRIVE], cwd=tmp_path, text=True,
                          capture_output=True, check=False)
    assert done.returncode == 0 and not done.stderr, done.stderr
    *courses, last = done.stdout.splitlines()
    assert len(courses) == 4 and all(line.startswith("True ") for line in courses)
    assert last == f"True {modules}/driving_courses/__init__.py"


def test_a_package_that_cannot_be_built_is_named_and_the_old_ones_stay(made, tmp_path):
    (tmp_path / "setuptools").mkdir()
    (tmp_path / "setuptools/__init__.py").touch()
    before = contents(made)
    with pytest.raises(subprocess.CalledProcessError) as failed:
        build(made, 0o022, PYTHONPATH=str(tmp_path))
    assert failed.value.stderr.splitlines()[-1] == (
        "src/sim/bullet_sim cannot be built: the lines above say why")
    assert contents(made) == before


def test_without_a_commit_one_line_says_so():
    done = subprocess.run([ROOT / "scripts/wheels.sh"], text=True, capture_output=True, check=False,
                          env={"PATH": os.environ["PATH"], "GIT_DIR": "/nonexistent"})
    assert (done.returncode, done.stderr) == (1, (
        "wheels: git does not know this folder's commit: wheels are built in a clone\n"))


@pytest.mark.parametrize("name, value, said", [
    ("SOURCE_DATE_EPOCH", "abc", "SOURCE_DATE_EPOCH is abc: write whole seconds since 1970"),
    ("SOURCE_DATE_EPOCH", "-1", "SOURCE_DATE_EPOCH is -1: write whole seconds since 1970"),
    ("SOURCE_DATE_EPOCH", "4294967296", "SOURCE_DATE_EPOCH is 4294967296: write whole"),
    ("GIT_DIR", "/nowhere", "git does not know this folder's commit"),
])
def test_a_time_that_is_none_is_one_line_before_anything_is_installed(
        tmp_path, name, value, said):
    scripts = tmp_path / "scripts"
    shutil.copytree(ROOT / "scripts", scripts)
    (scripts / "setup.sh").write_text("echo installs\n")
    done = subprocess.run([scripts / "wheels.sh"], text=True, capture_output=True, check=False,
                          env=os.environ | {"LC_ALL": "C", "SOURCE_DATE_EPOCH": "", name: value})
    assert (done.returncode != 0, done.stdout) == (True, "")
    assert said in done.stderr and done.stderr.count("\n") == 1
