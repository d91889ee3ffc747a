"""The version, which stands in one file, and `make report`, which a bug report wants."""

import os
import re
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import yaml

from bullet_sim import __version__

ROOT = Path(__file__).resolve().parent.parent
# Of nobody; the log has them as programs write them.
HOME, USER, HOST, OTHER = "/data/lin/lin.yue", "lin.yue", "Kontor-7.example.org", "otherone"
LOG = f"""Traceback: File "{HOME}/ws/talker.py"; /media/{USER}/stick; C:\\Users\\Lin Yue\\ws
started roslaunch server http://kontor-7:39041/ and http://{HOST}:39042/ for {USER}_bot
fetching https://lin:Geheim1@pypi.example.org/simple; page: http://192.0.2.17:8080/?token=Geheim1
http://[2001:db8::17:5]:8080/ mail to Lin.Yue@example.org, /home/{OTHER}/x; /Users/{OTHER}
[10:20:30] opencv-4.11.0.86 at 127.0.0.1
"""
LEFT = """Traceback: File "~/ws/talker.py"; /media/user/stick; C:~user\\ws
started roslaunch server http://host:39041/ and http://host:39042/ for user_bot
fetching https://pypi.example.org/simple; page: http://address:8080/?token=...
http://[address]:8080/ mail to address, ~user/x; ~user
[10:20:30] opencv-4.11.0.86 at 127.0.0.1
"""


def test_all_that_name_the_version_name_this_one() -> None:
    manifest = ElementTree.parse(ROOT / "src/sim/bullet_sim/package.xml")
    assert manifest.findtext("version") == __version__  # catkin compares it with setup.py's
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert citation["version"] == __version__
    headings = re.findall(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.MULTILINE)
    assert headings[0] == __version__
    assert headings == sorted(headings, key=lambda each: list(map(int, each.split("."))),
                              reverse=True)


def test_make_alone_begins_with_the_version() -> None:
    done = subprocess.run(["make"], cwd=ROOT, capture_output=True, text=True, check=True,
                          env={**os.environ, "LC_ALL": "C"})
    assert done.stdout.splitlines()[0] == f"ROS 1 driving courses, version {__version__}"


def report(root: Path, **environment: str) -> str:
    """out/report.txt of that checkout."""
    subprocess.run([root / "scripts/report.sh"], check=True, capture_output=True, text=True,
                   env={"PATH": os.environ["PATH"], **environment})
    return (root / "out/report.txt").read_text("utf-8")


def test_a_report_names_nobody(tmp_path: Path) -> None:
    home = Path(f"{tmp_path}{HOME}")
    root = home / "ws"
    for name in ("scripts", "dependencies"):
        shutil.copytree(ROOT / name, root / name)
    version = "src/sim/bullet_sim/src/bullet_sim/__init__.py"
    (root / version).parent.mkdir(parents=True)
    shutil.copy(ROOT / version, root / version)
    (root / "out/course/log").mkdir(parents=True)
    (root / "out/course/log/roslaunch.log").write_text(LOG.replace(HOME, str(home)))
    said = report(root, HOME=str(home), USER=USER, HOSTNAME=HOST)
    assert said.startswith(f"ros1-driving-courses {__version__}, commit ")
    assert "\nsetup: Python environment: none that is sound\nsetup: build: none\n" in said
    assert said.endswith(f"\n== ~/ws/out/course/log/roslaunch.log\n{LEFT}")
    secrets = (str(tmp_path), USER, "Lin Yue", "Kontor", "Geheim", "192.0.2", "2001:", OTHER)
    assert not [each for each in secrets if each.lower() in said.lower()]


def test_a_report_has_the_versions_and_the_last_logs_where_all_is_set_up() -> None:
    said = report(ROOT, HOME=os.environ["HOME"], LANGUAGE="zh_CN", LANG="C.UTF-8")
    assert "\nsetup: Debian's packages: all there\nsetup: Python environment: complete\n" in said
    for name in ("python3 3", "libgl1-mesa-dri ", "pybullet-3", "opencv_python_headless-4"):
        assert f"\nversion: {name}" in said, name
    assert 1 <= said.count("\n== ") <= 8


def test_the_templates_of_issues_ask_for_the_report() -> None:
    folder = ROOT / ".github/ISSUE_TEMPLATE"
    for path in folder.glob("*.md"):
        _, head, body = path.read_text("utf-8").split("---\n", 2)
        assert {"name", "about"} <= yaml.safe_load(head).keys() and body.strip()
    assert "`make report`" in (folder / "problem.md").read_text("utf-8")
