"""What setup builds from source is kept for the next clone; pip is a stand-in here."""

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
SETUP = """
state=$root/.setup lists=$root/lists platform=trixie-amd64
mkdir -p "$state" "$lists"
printf 'numpy==2.2.6 \\\\\\n    --hash=sha256:%064d\\n' "${NUMPY:-1}" >"$lists/requirements.txt"
printf 'pybullet==3.2.7 \\\\\\n    --hash=sha256:%064d\\n' 2 >"$lists/requirements-source.txt"
say() { echo "$1"; }; step() { echo "$2"; }; fail() { echo "$1" >&2; exit 1; }
logged() { shift; "$@"; }; pip_failed() { fail "pip $1 failed"; }
free_mb() { echo "${FREE:-5000}"; }
pip() {
  if [ "$1" = install ]; then cat "${@: -1}"; return; fi
  case "$CXXFLAGS $CFLAGS" in *-O2*-Wno-error=incompatible-pointer-types) ;; *) return 1 ;; esac
  [ -z "${STOPPED:-}" ] || { touch "$TMPDIR/half"; return 1; }
  [ -z "${MEANWHILE:-}" ] || eval "$MEANWHILE"
  mkdir -p "${@: -1}"; echo "wheel of $root" >"${@: -1}/pybullet-3.2.7-cp313-x.whl"
}
. "$parts/source_packages.sh"
source_packages
"""


@pytest.fixture
def clone(tmp_path):
    """Runs setup's step in a clone of that name, one cache for all clones."""
    def run(name: str, **environment: str) -> subprocess.CompletedProcess:
        root = tmp_path / name
        root.mkdir(exist_ok=True)
        return subprocess.run(
            ["bash", "-euo", "pipefail", "-c", SETUP], capture_output=True, text=True, check=False,
            cwd=root, env={"PATH": "/usr/bin:/bin", "XDG_CACHE_HOME": str(tmp_path / "cache"),
                 "root": str(root), "parts": str(ROOT / "scripts/setup"), **environment})
    return run


def wheels(tmp_path: Path) -> list[Path]:
    return sorted((tmp_path / "cache/ros1-driving-courses/wheels").glob("*/*.whl"))


def test_the_next_clone_finds_the_wheel(clone, tmp_path):
    first, second = clone("one"), clone("two")
    assert first.stdout.startswith("building pybullet 3.2.7 from source"), first.stderr
    assert second.stdout.startswith("installing pybullet 3.2.7 as built before")
    assert second.stdout.endswith(f"wheel of {tmp_path}/one\n")
    assert len(wheels(tmp_path)) == 1 and not list((tmp_path / "one/.setup").iterdir())


def test_another_numpy_is_another_wheel(clone, tmp_path):
    clone("one")
    assert "building" in clone("two", NUMPY="3").stdout
    assert len(wheels(tmp_path)) == 2


def test_a_damaged_wheel_is_built_again(clone, tmp_path):
    clone("one")
    wheels(tmp_path)[0].write_text("half")
    assert clone("two").stdout.endswith(f"wheel of {tmp_path}/two\n")
    assert "as built before" in clone("three").stdout


def test_a_wheel_that_others_may_change_is_built_again(clone, tmp_path):
    clone("one")
    wheels(tmp_path)[0].chmod(0o666)
    assert clone("two").stdout.endswith(f"wheel of {tmp_path}/two\n")
    kept = wheels(tmp_path)[0].parent.parent
    kept.chmod(0o777)
    assert "as built before" in clone("three").stdout
    assert not kept.stat().st_mode & 0o022


@pytest.mark.skipif(os.getuid() != 0, reason="only root makes another user's file")
def test_another_users_wheel_is_not_installed(clone, tmp_path):
    clone("one")
    os.chown(wheels(tmp_path)[0], 54321, 54321)
    assert clone("two").stdout.endswith(f"wheel of {tmp_path}/two\n")


def test_a_wheel_that_was_not_built_here_is_not_installed(clone, tmp_path):
    clone("one")
    wheels(tmp_path)[0].with_name("zlib-1.whl").write_text("not ours\n")
    assert clone("two").stdout.endswith(f"wheel of {tmp_path}/two\n")
    assert len(wheels(tmp_path)) == 1


def test_a_wheel_kept_under_a_lax_umask_is_the_users_alone(clone, tmp_path):
    clone("one", MEANWHILE="umask 000")
    folder = wheels(tmp_path)[0].parent
    assert not [path for path in (wheels(tmp_path)[0], folder, folder.parent)
                if path.stat().st_mode & 0o022]


def test_what_another_clone_has_kept_meanwhile_stays(clone, tmp_path):
    first = (f'cd "{tmp_path}" && mkdir -p one && (unset MEANWHILE; root={tmp_path}/one '
             'bash -euo pipefail -c "$SETUP" >/dev/null); cd "$root"')
    assert clone("two", MEANWHILE=first, SETUP=SETUP).stdout.endswith(f"wheel of {tmp_path}/one\n")


@pytest.mark.parametrize("places", [{"XDG_CACHE_HOME": "relative"}, {"XDG_CACHE_HOME": ""}])
def test_without_a_folder_for_caches_the_wheel_stays_in_the_clone(clone, tmp_path, places):
    clone("one", **places)
    assert "as built before" in clone("one", **places).stdout
    assert {path.name for path in (tmp_path / "one").iterdir()} == {".setup", "lists"}
    assert list((tmp_path / "one/.setup/cache").rglob("*.whl"))


def test_a_relative_cache_folder_counts_as_none(clone, tmp_path):
    clone("one", XDG_CACHE_HOME="relative", HOME=str(tmp_path / "home"))
    assert list((tmp_path / "home/.cache").rglob("*.whl"))


def test_an_interrupted_build_starts_again(clone, tmp_path):
    assert clone("one", STOPPED="1").returncode == 1 and not wheels(tmp_path)
    assert clone("one").stdout.endswith(f"wheel of {tmp_path}/one\n")
    assert not list((tmp_path / "one/.setup").iterdir())


def test_a_cache_that_cannot_be_written_is_one_line(clone, tmp_path):
    (tmp_path / "cache").touch()
    done = clone("one")
    assert (done.returncode, done.stderr) == (0, "")
    lines = done.stdout.splitlines()
    assert "cannot be kept in" in lines[1] and lines[2] == f"wheel of {tmp_path}/one"


def test_too_little_disk_is_told_before_the_build(clone):
    done = clone("one", FREE="100")
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    assert "100 MB free, building pybullet 3.2.7 needs" in done.stderr
