"""What check says of the modules that scripts import."""

import importlib
import sys
import zipfile

import pytest
from workspace_needs.check import modules
from workspace_needs.check.workspaces import package_findings, workspace_findings
from workspaces import NODE, add_files, add_package, program_findings, script_findings


def test_modules_of_the_workspace_are_there(tmp_path):
    source = tmp_path / "src"
    path = source / "arm/scripts/talk.py"
    add_files(source / "arm_msgs", {})
    add_files(source / "hand", dict.fromkeys((
        "src/grip/part.py", "lib/fast.so", "launch/nobodys.launch", "my_ns/sub/mod.py", "src/c.pyx",
        "src/s.i", "msg/m.proto", "src/math.cpp", "nobodys2.yaml"), ""))
    (source / "hand/CMakeLists.txt").write_text("pybind11_add_module(quick src/bindings.cu)\n")
    add_files(source / "arm", {
        "package.xml": "<package><name>arm_of_mine</name></package>",
        "scripts/talk.py": "import arm_msgs.msg, arm_of_mine.cfg, grip, fast, c, s, math, quick\n"
                           "import m_pb2, my_ns.sub.mod, sub\nimport nobodys\nimport nobodys2\n"})
    assert [found.part for found in script_findings(path)] == ["line 3", "line 4"]


@pytest.mark.parametrize("beside", ["", "devel"])
def test_modules_of_another_repository_of_the_workspace_are_there(tmp_path, beside):
    source = tmp_path / "src"
    arm = add_package(source / "repository/src", "arm")
    add_files(add_package(source, "hand"), {"src/grip/__init__.py": ""})
    for folder, name in ((arm, "arm"), (source / "hand", "hand")):
        add_files(folder, {"scripts/talk.py": NODE + "import grip, nobodys\n"})
        add_package(folder.parent, name)
    (tmp_path / beside).mkdir(exist_ok=True)
    checked = package_findings(arm, [], False) if beside else workspace_findings(
        tmp_path, [], False)
    said = [found.how for found in checked if found.where.endswith("arm/scripts/talk.py")]
    assert len(said) == 1 and "module nobodys" in said[0]


def test_what_only_modules_import_is_not_named(tmp_path):
    for name in ("src/arm/a.py", "scripts/train.py", "test/unit/t.py"):
        add_files(tmp_path, {name: "import nobodys\n"})
    add_files(tmp_path, {"scripts/node.py": NODE + "import arm.a\ndef f():\n    import nobodys\n"})
    assert program_findings(tmp_path) == []
    add_files(tmp_path, {"scripts/node.py": NODE + "import nobodys\n"})
    assert [found.part for found in program_findings(tmp_path)] == ["line 4"]


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """A folder and a zip file on PYTHONPATH, with a package and a namespace in each."""
    for name in ("otherx/__init__.py", "otherx/utils/geometry.py", "namespacex/a.py"):
        (tmp_path / "lib" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "lib" / name).touch()
    (tmp_path / "lib/madex").mkdir()
    (tmp_path / "lib/madex/__init__.py").write_text("from madex import finder")
    (tmp_path / "lib/madex/finder.py").write_text("import sys\nsys.meta_path.append(finder)")
    with zipfile.ZipFile(tmp_path / "x.egg", "w") as file:
        for name in ("carlax/__init__.py", "carlax/libc.py"):
            file.writestr(name, "")
    monkeypatch.setattr(sys, "path", [*sys.path, str(tmp_path / "lib"), str(tmp_path / "x.egg")])
    importlib.invalidate_caches()
    modules._places.cache_clear()
    modules._why_not_here.cache_clear()


@pytest.mark.parametrize("line, named", [
    ("from otherx.utils.geometry import area", ""), ("import otherx.utils.nothere", ""),
    ("import namespacex.a, carlax.libc, carlax", ""),
    ("import madex.anything, madex.__init__, yaml.__init__", ""),
    ("import otherx.nothere", "otherx has no module nothere")])
def test_namespaces_and_zip_files_are_not_looked_into(elsewhere, tmp_path, line, named):
    add_files(tmp_path / "p", {"scripts/n.py": NODE + line + "\n"})
    assert [named in each.how for each in program_findings(tmp_path / "p")] == [True] * bool(named)


@pytest.mark.parametrize("name", ["keyboard", "cupy", "dlib", "Jetson", "imutils", "control",
                                  "cantools", "pickle5", "PyQt4", "fast"])
def test_somebody_elses_module_is_no_slip(tmp_path, name):
    path = add_files(tmp_path, {"n.py": f"import {name}\n"}) / "n.py"
    assert ["meant?" in found.how for found in script_findings(path)] in ([], [False])


@pytest.mark.parametrize("typed, name, is_slip", [
    ("cv2S", "cv2", True), ("Rospy", "rospy", True), ("geometry_msg", "geometry_msgs", True),
    ("nupmy", "numpy", True), ("numpi", "numpy", True), ("umpy", "numpy", False),
    ("cupy", "copy", False), ("rospy", "rospkg", False)])
def test_slips(typed, name, is_slip):
    assert modules.is_slip(typed, name) is is_slip


@pytest.mark.parametrize("line, why", [
    ("import rospy.nothere", "module rospy.nothere is not here: rospy has no module nothere"),
    ("import rospy.coer", "rospy has no module coer (did you mean core?)"),
    ("from geometry_msgs.msg import Pose, Twistt",
     "geometry_msgs.msg has no message or service Twistt (did you mean Twist?)"),
    ("from std_srvs.srv import Emptyy",
     "std_srvs.srv has no message or service Emptyy (did you mean Empty?)"),
    ("import bullet_sim.nothere", "bullet_sim has no module nothere"),
    ("import cv2S", "is cv2 meant?"), ("import numppy", "is numpy meant?"),
    ("import Rospy", "is rospy meant?")])
def test_a_part_of_a_module_that_is_not_there_and_the_near_name(tmp_path, line, why):
    path = add_files(tmp_path, {"talk.py": line + "\n"}) / "talk.py"
    assert [why in found.how for found in script_findings(path)] == [True]


@pytest.mark.parametrize("line", [
    "import os.path, rospy.core, xml.etree.ElementTree, bullet_sim.formats.loading",
    "from std_srvs.srv import Empty, EmptyRequest, EmptyResponse", "from rospy.msg import AnyMsg",
    "from geometry_msgs.msg import *",
    "from gazebo_msgs.msg import ModelState, _ModelState"])
def test_parts_of_modules_that_are_there(tmp_path, line):
    path = add_files(tmp_path, {"talk.py": line + "\n"}) / "talk.py"
    assert script_findings(path) == []
