"""MIRROR=: apt and pip ask a local server in place of this machine's own sources."""

import hashlib
import os
import subprocess
import threading
import zipfile
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
USE = ('fail() { echo "$1" >&2; exit 1; }; . scripts/setup/mirror.sh; use_mirror "$1" bookworm; ')


def shell(command: str, folder: Path, **environment: str) -> subprocess.CompletedProcess:
    """Run a command after use_mirror; $1 is the folder."""
    return subprocess.run(["bash", "-euc", USE + command, "_", folder], cwd=ROOT, text=True,
                          capture_output=True, check=False, timeout=60,
                          env={"PATH": os.environ["PATH"], "HOME": str(folder), **environment})


@pytest.fixture
def served(tmp_path: Path):
    """A local server of a folder: its address, the folder, and the paths asked for so far."""
    asked, folder = [], tmp_path / "served"
    folder.mkdir()

    class Handler(SimpleHTTPRequestHandler):
        def __init__(self, *arguments):
            super().__init__(*arguments, directory=str(folder))

        def log_message(self, *_):
            asked.append(self.path)

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}", folder, asked
    server.shutdown()
    server.server_close()


def test_apt_asks_the_mirror_alone(served, tmp_path: Path) -> None:
    address, _, asked = served
    (tmp_path / "lists/partial").mkdir(parents=True)
    (tmp_path / "cache").mkdir()
    state = "".join(f"-o {name}={value} " for name, value in {
        "Dir::State::Lists": tmp_path / "lists", "Dir::Cache": tmp_path / "cache",
        "Acquire::http::Proxy": "DIRECT", "Debug::NoLocking": "1",
        "APT::Sandbox::User": "root"}.items())
    told = shell(f'apt-get {state} "${{sources[@]}}" update', tmp_path, LC_ALL="C",
                 MIRROR=f"{address}/debian/")
    assert {path for path in asked if path.endswith("/InRelease")} == {
        "/debian/dists/bookworm/InRelease", "/debian/dists/bookworm-updates/InRelease",
        "/debian-security/dists/bookworm-security/InRelease"}
    places = {line.split()[1] for line in told.stdout.splitlines()
              if line.startswith(("Get:", "Err:", "Ign:"))}
    assert places <= {f"{address}/debian", f"{address}/debian-security"}


def test_pip_asks_the_index_that_the_mirror_has(served, tmp_path: Path) -> None:
    address, folder, asked = served
    name = "courses_probe-1-py3-none-any.whl"
    (folder / "simple/courses-probe").mkdir(parents=True)
    with zipfile.ZipFile(folder / f"simple/courses-probe/{name}", "w") as wheel:
        wheel.writestr("courses_probe-1.dist-info/METADATA",
                       "Metadata-Version: 2.1\nName: courses-probe\nVersion: 1\n")
        wheel.writestr("courses_probe-1.dist-info/WHEEL", "Wheel-Version: 1.0\nTag: py3-none-any\n")
    digest = hashlib.sha256((folder / f"simple/courses-probe/{name}").read_bytes()).hexdigest()
    (folder / "simple/courses-probe/index.html").write_text(
        f'<a href="{name}#sha256={digest}">{name}</a>', encoding="utf-8")
    (tmp_path / "wanted.txt").write_text(f"courses-probe==1 --hash=sha256:{digest}\n",
                                         encoding="utf-8")
    install = (". scripts/setup/python.sh; venv=$PWD/.venv; "
               'pip download --require-hashes -r "$1/wanted.txt" -d "$1/got"')
    told = shell(install, tmp_path, MIRROR="cn", PIP_INDEX_URL=f"{address}/simple")
    assert told.returncode == 0, told.stderr
    assert (tmp_path / "got" / name).is_file() and "/simple/courses-probe/" in asked


def test_china_has_a_mirror_of_both(tmp_path: Path) -> None:
    told = shell('echo "$archive $PIP_INDEX_URL"', tmp_path, MIRROR="cn")
    archive, index = told.stdout.split()
    assert archive.endswith(".cn/debian") and ".cn/pypi/" in index
    assert (tmp_path / "mirror.list").read_text(encoding="utf-8").count(archive) == 3


def test_without_a_mirror_apt_and_pip_read_their_own_settings(tmp_path: Path) -> None:
    told = shell('echo "${sources[@]}$archive${PIP_INDEX_URL:-}"', tmp_path)
    assert told.stdout == "\n" and not list(tmp_path.iterdir())


@pytest.mark.parametrize("wrong", ("china", "ftp://mirror.example.edu", "http://"))
def test_another_value_is_refused(wrong: str, tmp_path: Path) -> None:
    told = shell("echo went on", tmp_path, MIRROR=wrong)
    assert told.returncode == 1 and not told.stdout
    assert told.stderr == (f"MIRROR={wrong}: write cn, or the address of a Debian archive, such as "
                           "http://mirror.example.edu/debian\n")


def test_each_make_command_takes_it_and_an_image_too() -> None:
    said = subprocess.run(["make", "-n", "course", "MIRROR=cn"], cwd=ROOT, text=True,
                          capture_output=True, check=False)
    assert said.returncode == 0, said.stderr
    for name in ("docker/Dockerfile", "docker/compose.yaml"):
        assert "MIRROR" in (ROOT / name).read_text(encoding="utf-8")
