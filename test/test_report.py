"""The version, which stands in one file, and `make report`, which a bug report wants."""

import os
import re
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml

from bullet_sim import __version__

ROOT = Path(__file__).resolve().parent.parent
SECRETS = r"""
http://zhang-robot.local:11311 192.168.7.9 ip=10.3.2.1 at 192.168.1.17. host_192.168.1.17
2001:db8:1:2::9 [2001:db8::17:5] fe80::1%eth0 52:54:00:ab:cd:ef
zhang@lab-pc zhang@localhost 张伟@学校.cn Lin.Yue@example.org git@gitlab.uni.edu:zhangwei/robot.git
Authorization: Bearer Geheim1
password: Geheim1 api_key=Geheim1 access_token=Geheim1 https://lin:Geheim1@pypi.org/simple
/home/{who} wei/ws /media/zhang wei/stick /var/spool/mail/zhang /Users/{who} %2Fhome%2Fzhangwei
C:\\Users\\zhang wei C:\Users\zhang wei
roslaunch-Kontor-7-4711.log Zhang_Wei_20231234/track0-seed1
""".strip().replace("{who}", "zhang").splitlines()
PLACES = """Traceback (most recent call last):
  File "{root}/src/learning_topic/scripts/20231234_zhang.py", line 5, in <module>
  File "{root}/src/lessons/../../../zhang.py", line 3, in <module>
  File "/usr/lib/python3/../../home/zhang.py", line 3, in <module>
  File "/srv/usr/lib/python3/zhang.py", line 3, in <module>
  File "/usr/lib/python3zhang/x.py", line 3, in <module>
  File "{root}/src/exercises/zhang/zhang.py", line 6, in <module>
  File "{root}/.venv/lib/python3.11/site-packages/zhang/x.py", line 8, in <module>
  File "{root}/.venv/lib/python3.11/site-packages/numpy/core.py", line 9, in <module>
  File "{root}/src/sim/bullet_sim/a.py", line 12, in <module>
  File "/usr/lib/python3/dist-packages/rospy/client.py", line 7, in zhang
  File "{root}/src/zhang_bot/talker.py", line 3, in <module>
rospy.exceptions.ROSException: of zhang at 192.168.7.9
[zhang_bot-2] process has died [pid 7, exit code -11, cmd {root}/src/zhang_bot/talker.py].
E: Unable to locate package zhang
ZhangError: no
zhang_bot.talker.ZhangException: no
bullet_sim.errors.SimulationError: of zhang
AssertionError
"""
TOLD = """
  src/learning_topic/:5
  src/exercises/:6
  .venv/lib/python3.11/site-packages/:8
  .venv/lib/python3.11/site-packages/numpy/core.py:9
  src/sim/bullet_sim/a.py:12
  /usr/lib/python3/dist-packages/rospy/client.py:7
  ROSException
  process has died
  exit code -11
  Unable to locate package
  SimulationError
  AssertionError
"""

def test_all_that_name_the_version_name_this_one() -> None:
    manifest = ElementTree.parse(ROOT / "src/sim/bullet_sim/package.xml")
    assert manifest.findtext("version") == __version__  # catkin compares it with setup.py's
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert citation["version"] == __version__
    headings = re.findall(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.MULTILINE)
    assert headings[0] == __version__


def test_make_alone_begins_with_the_version() -> None:
    done = subprocess.run(["make"], cwd=ROOT, capture_output=True, text=True, check=True,
                          env={**os.environ, "LC_ALL": "C"})
    assert done.stdout.splitlines()[0] == f"ROS 1 driving courses, version {__version__}"


def report(root: Path, **environment: str) -> tuple[str, str]:
    """out/report.txt of that checkout, and what the terminal shows."""
    done = subprocess.run([root / "scripts/report.sh"], check=True, capture_output=True, text=True,
                          env={"PATH": os.environ["PATH"], **environment})
    return (root / "out/report.txt").read_text("utf-8"), done.stdout + done.stderr


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """One in the home of zhang wei, without git and setup."""
    root = tmp_path / "zhang wei/ws"
    for name in ("scripts", "dependencies"):
        shutil.copytree(ROOT / name, root / name)
    version = "src/sim/bullet_sim/src/bullet_sim/__init__.py"
    (root / version).parent.mkdir(parents=True)
    shutil.copy(ROOT / version, root / version)
    return root


def write_log(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, "utf-8")


def test_a_report_names_nobody(checkout: Path) -> None:
    home = checkout.parent
    wrong = [f"{before}{secret}{after}\n" for secret in SECRETS for before, after in (
        ("", ""), ("E: ", ": Connection refused"), ("ValueError: ", ""),
        (f'  File "{checkout}/', '", line 3, in <module>'), ("CMake Error at ", ":3 (message):"))]
    for log in ("out/course/log/roslaunch-Kontor-7-4711.log", "out/viewer.log", ".setup/pip.log",
                "../.ros/log/latest/zhang_bot-1-stdout.log", "out/zhang/x.log",
                "out/mark/cases/Zhang_Wei_20231234/track0-seed1/log/roslaunch.log"):
        write_log(checkout / log, "".join(wrong) + PLACES.format(root=checkout))
    settings = {"HOME": str(home), "USER": "zhang", "HOSTNAME": "kontor", "LANG": "zhang",
                "ROS_MASTER_URI": "http://zhang-robot.local:11311", "ROS_IP": "192.168.7.9",
                "ROS_HOSTNAME": "zhang-robot.local", "TURTLEBOT3_MODEL": "zhang_bot"}
    said, _ = report(checkout, **settings)
    assert said.count(TOLD) == said.count("\nlog: ") == 4
    for word in ("zhang", "张", "geheim", "lin:", "lin.", "kontor", "192.168", "10.3.2", "2001:",
                 "fe80", "52:54", "20231234", "localhost", "gitlab", "example", str(home).lower()):
        assert word not in said.lower(), word
    for name in settings.keys() - {"HOME", "USER", "HOSTNAME"}:
        assert f"{name} another" in said


def test_known_settings_are_told(checkout: Path) -> None:
    said, _ = report(checkout, LANG="zh_CN.UTF-8", TURTLEBOT3_MODEL="waffle_pi", ROS_IP="127.0.0.1",
                     ROS_MASTER_URI="http://localhost:11311/", HOSTNAME="debian")
    assert "setting: LANG zh_CN.UTF-8\nsetting: TURTLEBOT3_MODEL waffle_pi\n" in said
    assert "ROS_MASTER_URI http://localhost:11311/\n" in said
    assert "ROS_HOSTNAME not set, ROS_IP 127.0.0.1\n" in said
    assert "\nsystem: Debian GNU/Linux " in said


def test_a_log_that_cannot_be_read_hides_no_other(checkout: Path) -> None:
    write_log(checkout / "out/course/a.log", "ValueError: no\n")
    (checkout / "out/course/b.log").symlink_to("none")  # root may read what is forbidden
    write_log(checkout / "out/track/c.log", "KeyError: no\n")
    said, shown = report(checkout)
    assert "Can't open" in shown and "course/b.log" in shown
    assert "  ValueError\n" in said and said.endswith("  KeyError\n")


@pytest.mark.parametrize(("spoil", "reason"), [
    (lambda out: out.write_text(""), "File exists"),
    (lambda out: (out / "report.txt").mkdir(parents=True), "Is a directory"),
    (lambda out: (out.mkdir(), (out / "report.txt").symlink_to("/dev/full")),
     "No space left on device")])
def test_a_report_that_cannot_be_written_ends_with_one_line(checkout: Path, spoil, reason) -> None:
    spoil(checkout / "out")
    done = subprocess.run([checkout / "scripts/report.sh"], capture_output=True, text=True,
                          check=False, env={"PATH": os.environ["PATH"]})
    assert done.returncode == 1 and not done.stdout
    assert done.stderr == (f"report: out/report.txt cannot be written: {reason}. Free some disk "
                           "space, or make out/ a folder of yours\n")


def test_in_a_clone_only_files_in_git_are_named(checkout: Path) -> None:
    write_log(checkout / "src/lessons/ours.py", "")
    for command in ("init -q", "add src"):
        subprocess.run(["git", "-C", checkout, *command.split()], check=True)
    write_log(checkout / "out/course/a.log", "".join(
        f'  File "{checkout}/src/{name}.py", line 3, in <module>\n'
        for name in ("lessons/ours", "lessons/zhang", "sim/zhang/zhang")))
    # More files than the system takes as one word of a program's environment.
    subprocess.run(["git", "-C", checkout, "update-index", "--index-info"], check=True, text=True,
                   input="".join(f"100644 {'0' * 39}1 0\tsrc/{number:0200d}\n"
                                 for number in range(1000)))
    said, shown = report(checkout)
    assert said.endswith("  src/lessons/ours.py:3\n  src/lessons/:3\n  src/sim/:3\n"), shown
    assert "too long" not in shown


def test_a_report_has_the_versions_and_how_far_setup_came(checkout: Path) -> None:
    said, _ = report(ROOT, HOME=os.environ["HOME"], LANGUAGE="zh_CN", LANG="C.UTF-8")
    assert said.startswith(f"ros1-driving-courses {__version__}, commit ")
    assert "\nsetup: Debian's packages: all there\nsetup: Python environment: complete\n" in said
    for name in ("python3 3", "libgl1-mesa-dri ", "pybullet-3", "opencv_python_headless-4"):
        assert f"\nversion: {name}" in said, name
    said, _ = report(checkout)  # the space in its folder's name is nothing for catkin
    assert "\nsetup: not for this machine or folder; make setup says why\n" in said
    moved = checkout.rename(checkout.parents[1] / "ws")
    said, _ = report(moved)
    assert "\nsetup: Python environment: none that is sound\nsetup: build: none\n" in said


def test_the_templates_of_issues_ask_for_the_report() -> None:
    folder = ROOT / ".github/ISSUE_TEMPLATE"
    for path in folder.glob("*.md"):
        _, head, body = path.read_text("utf-8").split("---\n", 2)
        assert {"name", "about"} <= yaml.safe_load(head).keys() and body.strip()
    assert "`make report`" in (folder / "problem.md").read_text("utf-8")
