"""What the verbs share: scripts/common.sh."""

import os
import shutil
import signal
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


def ros_home(home: Path | None) -> str:
    """ROS_HOME of a verb for a user with that home; empty: ROS's own default."""
    environment = {name: value for name, value in os.environ.items()
                   if name not in ("HOME", "ROS_HOME")} | ({"HOME": str(home)} if home else {})
    done = subprocess.run(
        ["bash", "-c", '. scripts/common.sh; enter_workspace; echo "${ROS_HOME:-}"',
         ROOT / "scripts/course.sh"],
        cwd=ROOT, env=environment, text=True, capture_output=True, check=True)
    return done.stdout.strip()


@pytest.mark.skipif(subprocess.run(["unshare", "-rm", "true"], check=False).returncode,
                    reason="no namespaces")
def test_a_full_tmp_is_one_line() -> None:
    done = subprocess.run(
        ["unshare", "-rm", "bash", "-c", "mount -t tmpfs -o size=64k tmpfs /tmp; cd scripts; "
         "head -c 60k /dev/zero > /tmp/x; . ./common.sh; enter_workspace", ROOT / "scripts/a.sh"],
        cwd=ROOT, text=True, capture_output=True, check=False,
        env={**os.environ, "LC_ALL": "C.UTF-8", "LANGUAGE": "en"})
    assert (done.returncode, done.stderr) == (
        1, "a: /tmp is full, or cannot be written: make room there, then type this again\n")


def test_chinese_is_not_under_the_name_for_which_glibc_translates_nothing() -> None:
    done = subprocess.run(
        ["bash", "-c", '. scripts/common.sh; echo "$LC_ALL"; locale charmap'], cwd=ROOT, text=True,
        capture_output=True, check=True, env={**os.environ, "LANGUAGE": "zh_CN", "LANG": "C.UTF-8"})
    name, charmap = done.stdout.split()
    assert not name.startswith("C.") and charmap == "UTF-8" and done.stderr == ""


@pytest.mark.parametrize("has_ros", [True, False])
def test_ros_writes_below_the_home(tmp_path: Path, has_ros: bool) -> None:
    if has_ros:
        (tmp_path / ".ros").mkdir()
    assert ros_home(tmp_path) == ""


def test_without_a_home_that_can_be_written_ros_writes_here(tmp_path: Path) -> None:
    assert ros_home(None) == ros_home(tmp_path / "gone") == str(ROOT / ".setup/ros")


@pytest.mark.parametrize(("platform", "sound"), [("trixie-arm64", "yes"), ("trixie-amd64", "no")])
def test_a_venv_of_another_architecture_is_made_again(
        tmp_path: Path, platform: str, sound: str) -> None:
    venv = tmp_path / "venv"
    subprocess.run(["/usr/bin/python3", "-m", "venv", "--without-pip", "--system-site-packages",
                    venv], check=True)
    (venv / "bin/pip").symlink_to("python3")  # pip itself takes 10 s
    (tmp_path / "state").mkdir()
    (tmp_path / "state/venv").write_text(f"{venv} trixie-arm64\n")
    done = subprocess.run(
        ["bash", "-c", f". scripts/setup/python.sh; venv={venv} state={tmp_path}/state "
         f"platform={platform}; venv_is_sound && echo yes || echo no"],
        cwd=ROOT, text=True, capture_output=True, check=True)
    assert done.stdout.strip() == sound


@pytest.mark.parametrize(("asked", "options"), [
    ("", ""), ("--seeds 2", ""), ("--workers 2", "--workers"), ("--workers 0", ""),
    ("--workers=1", ""), ("--workers -2", ""), ("--workers=12", "--workers"),
    ("--seeds 2 --workers=2", "--workers"), ("--scheduler tcp://a:1 --workers 1", "--workers"),
    ("--scheduler=tcp://a:1", "--workers"),
])
def test_a_trial_sets_up_what_its_arguments_need(tmp_path: Path, asked: str, options: str) -> None:
    (tmp_path / "scripts").mkdir()
    common = tmp_path / "scripts/common.sh"
    common.write_text((ROOT / "scripts/common.sh").read_text(encoding="utf-8"))
    setup = tmp_path / "scripts/setup.sh"
    setup.write_text('echo "$*"\n')
    setup.chmod(0o755)
    done = subprocess.run(["bash", "-c", f". {common}; set_up_trial {asked}"], text=True,
                          capture_output=True, check=True)
    assert done.stdout.strip() == options


def test_mending_apt_removes_no_package() -> None:
    setup = (ROOT / "scripts/setup/debian.sh").read_text(encoding="utf-8")
    assert setup.count("install -f") == setup.count("install -f --no-remove") == 1


def test_a_file_that_root_left_behind_stops_no_build(tmp_path: Path) -> None:
    (tmp_path / "devel").mkdir()
    (tmp_path / "devel/setup.bash").touch()
    (tmp_path / "build-inputs").write_text("inputs\n")
    (tmp_path / "build-inputs.now").symlink_to("/nowhere/x")  # cannot be written either
    done = subprocess.run(
        ["bash", "-c", ". scripts/common.sh; . scripts/setup/workspace.sh; python3() { :; };"
         " build_inputs() { echo inputs; }; cpp=OFF force_build=no;"
         f" root={tmp_path} state={tmp_path}; build_workspace"],
        cwd=ROOT, text=True, capture_output=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_setup_makes_the_models_where_nothing_is_to_be_built(tmp_path: Path) -> None:
    package = tmp_path / "src/sim/bullet_sim/src/bullet_sim"
    shutil.copytree(ROOT / package.relative_to(tmp_path) / "data/props", package / "data/props")
    shutil.copy(ROOT / package.relative_to(tmp_path) / "props.py", package)
    (tmp_path / "devel").mkdir()
    (tmp_path / "devel/setup.bash").touch()
    (tmp_path / "scripts").mkdir()
    (tmp_path / "scripts/own_packages.py").touch()
    (tmp_path / "build-inputs").write_text("inputs\n")
    done = subprocess.run(
        ["bash", "-c", ". scripts/common.sh; . scripts/setup/workspace.sh; "
         " build_inputs() { echo inputs; }; cpp=OFF force_build=no;"
         f" root={tmp_path} state={tmp_path}; build_workspace"],
        cwd=ROOT, text=True, capture_output=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (package / "data/models/sun/model.sdf").is_file()


def test_a_program_in_cpp_that_is_not_built_says_how(tmp_path: Path) -> None:
    for file in ("src/lessons/wiki/talker/talker.cpp", "src/lessons/wiki/src/library.cpp",
                 "src/lessons/lesson/src/client.cpp", "src/lessons/ignored/src/node.cpp",
                 "src/learning_topic/src/built.cpp"):
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).write_text("" if "library" in file else "int main() {}\n")
    for package in ("wiki", "lesson", "learning_topic"):
        (tmp_path / "devel/share" / package).mkdir(parents=True)
    (tmp_path / "devel/lib/learning_topic").mkdir(parents=True)
    (tmp_path / "devel/lib/learning_topic/built").write_text("a program")
    subprocess.run(["bash", "-c", ". scripts/common.sh; . scripts/setup/workspace.sh;"
                    f" root={tmp_path}; cpp_stand_ins; cpp_stand_ins"], cwd=ROOT, check=True)
    made = {str(path.relative_to(tmp_path / "devel/lib"))
            for path in (tmp_path / "devel/lib").rglob("*") if path.is_file()}
    assert made == {"wiki/talker", "lesson/client", "learning_topic/built"}
    assert (tmp_path / "devel/lib/learning_topic/built").read_text() == "a program"
    done = subprocess.run([tmp_path / "devel/lib/wiki/talker"], text=True, capture_output=True,
                          check=False)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == ("wiki talker is in C++ and not built yet; type: "
                           f"make -C {tmp_path} build CPP=1\n")


@pytest.mark.parametrize(("retries", "said"), [
    (range(4, -1, -1), "setup: no network: pip cannot reach its package index"),
    (range(4, 3, -1), "setup: pip install failed: ERROR: No matching distribution"),
])
def test_a_connection_that_is_reset_again_and_again_is_no_network(
        tmp_path: Path, retries: range, said: str) -> None:
    broken = ("WARNING: Retrying (Retry(total={}, connect=None)) after connection broken by "
              "'ProtocolError('Connection aborted.', ConnectionResetError(104))': /simple/a/\n")
    (tmp_path / "pip.log").write_text("".join(map(broken.format, retries))
                                      + "ERROR: No matching distribution found for a==1\n")
    (tmp_path / "venv-unfinished").touch()
    done = subprocess.run(
        ["bash", "-c", ". scripts/common.sh; . scripts/setup/logged.sh; . scripts/setup/python.sh;"
         f" fail() {{ echo \"setup: $1\"; exit 1; }}; state={tmp_path}; pip_failed install"],
        cwd=ROOT, text=True, capture_output=True, check=False)
    assert done.returncode == 1 and done.stdout.startswith(said), done
    # Without a network nothing was installed: the environment stays, and need not be made again.
    assert (tmp_path / "venv-unfinished").exists() is ("no network" not in said)


def test_a_method_that_is_not_there_is_one_line():
    done = subprocess.run([ROOT / "scripts/lane.sh", "--method", "nope"], text=True,
                          capture_output=True, check=False)
    assert done.returncode == 2 and not done.stdout
    assert done.stderr.startswith("lane: no method 'nope' (METHOD=); there are: sliding_windows, ")
    assert len(done.stderr.splitlines()) == 1


def test_what_pip_leaves_in_a_package_needs_no_build(tmp_path: Path) -> None:
    def inputs():
        script = f"root={tmp_path}; . {ROOT}/scripts/setup/workspace.sh; build_inputs"
        return subprocess.run(["bash", "-c", script], text=True, capture_output=True,
                              check=True).stdout

    (tmp_path / "src/car").mkdir(parents=True)
    (tmp_path / "src/car/package.xml").touch()
    before = inputs()
    assert "src/car/package.xml" in before
    (tmp_path / "src/car/build/lib/car").mkdir(parents=True)
    for name in ("package.xml", "__init__.py"):
        (tmp_path / "src/car/build/lib/car" / name).touch()
    assert inputs() == before


@pytest.mark.parametrize(("stays", "who"), [("yes", "root"), ("", "person")])
def test_with_sudo_a_verb_goes_on_as_the_folders_owner_unless_it_stays_root(
        tmp_path: Path, stays: str, who: str) -> None:
    (tmp_path / "scripts").mkdir()
    common = (ROOT / "scripts/common.sh").read_text(encoding="utf-8")
    (tmp_path / "scripts/common.sh").write_text(common, encoding="utf-8")
    (tmp_path / "scripts/verb.sh").write_text(
        f'stays_root={stays}\nid() {{ echo 0; }}; stat() {{ echo person; }}\n'
        'exec() { echo person; exit; }\n. "$(dirname "$0")/common.sh"\necho root\n',
        encoding="utf-8")
    done = subprocess.run(["bash", tmp_path / "scripts/verb.sh"], text=True, capture_output=True,
                          env={**os.environ, "SUDO_USER": "person"}, check=True)
    assert done.stdout == f"{who}\n"


def test_without_an_answer_about_masters_nothing_starts(tmp_path: Path) -> None:
    choose = ('. scripts/common.sh; python3() { return 3; }; '
              'if choose_master; then echo starts; fi')
    done = subprocess.run(["bash", "-c", choose, ROOT / "scripts/viewer.sh"], cwd=ROOT,
                          env=os.environ | {"ROS_MASTER_URI": ""}, text=True, capture_output=True,
                          check=True)
    assert done.stdout == ""


@pytest.mark.parametrize("script", sorted(
    path.name for path in (ROOT / "scripts").glob("*.sh") if '/run.sh"' in path.read_text()))
def test_each_script_of_run_starts_its_program_after_setup(tmp_path: Path, script: str) -> None:
    (tmp_path / "bin").mkdir()
    (tmp_path / "devel").mkdir()
    (tmp_path / "devel/setup.bash").write_text(f"export PATH={tmp_path}/bin:$PATH\n")
    (tmp_path / "scripts").mkdir()
    for name, text in (("bin/python3", 'echo "$@"'), ("scripts/setup.sh", 'echo setup "$@"')):
        (tmp_path / name).write_text(f"#!/bin/sh\n{text}\n")
        (tmp_path / name).chmod(0o755)
    for name in ("common.sh", "run.sh", script):
        shutil.copy(ROOT / "scripts" / name, tmp_path / "scripts")
    done = subprocess.run([tmp_path / "scripts" / script, "--seed", "1"], text=True,
                          capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    setup, started = done.stdout.splitlines()
    program, options = started.split(" ", 1)
    assert setup.startswith("setup") and options == "--seed 1"
    assert (ROOT / Path(program).relative_to(tmp_path)).is_file()


def interrupted(script: Path, **environment: str) -> subprocess.CompletedProcess:
    """A script in whose process group a program of its own plays Ctrl-C."""
    return subprocess.run([script], text=True, capture_output=True, timeout=60, check=False,
                          start_new_session=True, env=os.environ | environment)


def write_program(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)


@pytest.mark.parametrize("verb", ["drive", "viewer"])
def test_ctrl_c_at_the_first_program_is_the_end_without_a_word(tmp_path: Path, verb: str) -> None:
    write_program(tmp_path / "dirname", "kill -INT 0")
    done = interrupted(ROOT / f"scripts/{verb}.sh", PATH=f"{tmp_path}:{os.environ['PATH']}")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_ctrl_c_ends_setup_also_where_a_program_takes_it_for_a_fault(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "scripts", tmp_path / "scripts")
    shutil.copytree(ROOT / "dependencies", tmp_path / "dependencies",
                    ignore=shutil.ignore_patterns("requirements*"))  # nothing to install
    write_program(tmp_path / ".venv/bin/pip", "")
    write_program(tmp_path / ".venv/bin/python3", "trap '' INT; kill -INT 0; exit 1")
    (tmp_path / ".venv/pyvenv.cfg").write_text(
        "home = /usr/bin\ninclude-system-site-packages = true\n")
    done = interrupted(tmp_path / "scripts/setup.sh")
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGINT, "", "")
