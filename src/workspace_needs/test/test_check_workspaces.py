"""check of workspaces and packages before they are built."""

import re

import pytest
from robot_texts import LAUNCH, ROBOT
from workspace_needs.check import workspaces
from workspace_needs.check.command import main
from workspace_needs.check.findings import PROBLEM, Finding, table
from workspace_needs.command import not_to_be_had
from workspace_needs.verdicts import judge
from workspaces import add_files, add_package, add_plain

# A file is checked in a fork of this process, which must not hold engines or OpenGL of other tests.
pytestmark = pytest.mark.processes


def test_a_workspace_before_it_is_built(tmp_path, capsys):
    for name, component in (("arm", "moveit_core"), ("wheel", "roscpp")):
        folder = tmp_path / "src" / name
        folder.mkdir(parents=True)
        (folder / "package.xml").write_text(
            f"<package format='2'><name>{name}</name><version>1.0.0</version><license>BSD</license>"
            "<description>d</description><maintainer email='a@example.com'>a</maintainer>"
            "</package>")
        (folder / "CMakeLists.txt").write_text(
            f"cmake_minimum_required(VERSION 3.0.2)\nproject({name})\n"
            f"find_package(catkin REQUIRED COMPONENTS {component})")
    code = main([str(tmp_path)])
    said = capsys.readouterr().out
    assert code == 1
    assert "PROBLEM       build: it is left out: moveit_core: MoveIt is not in Debian" in said
    wheel = said[said.index("package wheel"):]
    assert "works         build" in wheel or "roscpp needs it: make deps WS=" in wheel


@pytest.fixture
def workspace(tmp_path, capsys):
    """Checks a workspace that is not built, of one package `arm`: exit code and what is printed."""
    folder = tmp_path / "src/arm"
    (folder / "scripts").mkdir(parents=True)
    (folder / "package.xml").write_text(
        "<package format='2'><name>arm</name><version>1.0.0</version><license>BSD</license>"
        "<description>d</description><maintainer email='a@example.com'>a</maintainer>"
        "<buildtool_depend>catkin</buildtool_depend></package>")
    (folder / "main.cpp").write_text("int main() {}\n")
    (folder / "scripts/talk.py").write_text("#!/usr/bin/env python3\n")
    (folder / "scripts/talk.py").chmod(0o755)

    def run(cmake: str = "", **files: str) -> tuple[int, str]:
        catkin = "find_package(catkin REQUIRED)\ncatkin_package()\n" * ("catkin" in cmake)
        (folder / "CMakeLists.txt").write_text(
            f"cmake_minimum_required(VERSION 3.0)\nproject(arm)\n{catkin}{cmake}")
        for name, text in files.items():
            (folder / name.replace("__", ".")).write_text(text)
        code = main([str(tmp_path)])
        return code, capsys.readouterr().out
    return run


def test_what_is_in_a_workspace_is_looked_at_before_it_is_built(workspace):
    launch = LAUNCH.replace("$(dirname)", "$(find arm)").format("robot_description", "arm", "n")
    cmake = ("add_executable(n main.cpp)\ncatkin_install_python(PROGRAMS scripts/talk.py\n"
             "  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})\n")
    code, said = workspace(cmake, robot__urdf=ROBOT.format(""), a__launch=launch, b__yaml="a: 1\n",
                           c__launch=launch.replace('type="n"', 'type="talk.py"'))
    assert code == 0 and said.endswith("all of it will work\n")
    assert "works         launch files, worlds, robots and YAML (4)" in said
    assert "a.launch" not in said
    code, said = workspace(cmake, a__launch=launch.replace('type="n"', 'type="nn"'))
    assert code == 1 and "node arm/nn: package arm has no executable nn here" in said
    assert "robots and YAML" not in said


@pytest.mark.parametrize("cmake, code, words", [
    ("", 0, "works         build"),
    ("add_executable(see EXCLUDE_FROM_ALL see.cpp)", 0, "works         build"),
    ("add_library(see STATIC EXCLUDE_FROM_ALL see.cpp)\nadd_executable(n main.cpp)\n"
     "target_link_libraries(n see)", 1, "PROBLEM       build: see.cpp will not compile"),
    ("add_executable(see see.cpp)", 1, "PROBLEM       build: see.cpp will not compile: the header "
                                       "<strange_msgs/Thing.h> is not here: neither")])
def test_a_header_that_nobody_has_matters_where_a_target_includes_it(workspace, cmake, code, words):
    got, said = workspace(cmake, see__cpp="#include <strange_msgs/Thing.h>\nint main() {}\n")
    assert got == code and words in said and "will be without" not in said
    assert ("works         build" in said) is (code == 0)


@pytest.mark.parametrize("name, text, why", [
    ("arm.urdf", "<robot", "PROBLEM       robot: "),
    ("arm.world", "<sdf", "PROBLEM       world: "),
    ("arm.yaml", "a:\n\tb: 1\n", "PROBLEM       YAML: "),
    ("arm.launch", "<launch><node/></launch>", "PROBLEM       launch file: "),
    ("arm.launch", "<launch><rosparam>\na: 1\nb: [1, 2\nc: 3\n</rosparam></launch>",
     "PROBLEM       launch file: YAML in <rosparam>: expected ',' or ']', but got ':'; line 4 of "
     "it: c: 3\n"),
])
def test_a_fault_in_a_workspaces_file_is_found(workspace, name, text, why):
    code, said = workspace(**{name.replace(".", "__"): text})
    assert code == 1 and f"/arm/{name}\n  {why}" in said
    assert "works         build" in said and said.endswith("something will be missing, see above\n")


def test_programs_of_a_package_that_does_not_configure_are_not_said_to_be_absent(workspace):
    launch = LAUNCH.format("robot_description", "arm", "n")
    code, said = workspace("message(FATAL_ERROR no)", robot__urdf=ROBOT.format(""),
                           a__launch=launch)
    assert code == 1 and "not checked   node arm/n: what the build makes of package arm" in said


def test_a_workspace_is_looked_at_for_a_bounded_time(workspace, monkeypatch):
    monkeypatch.setattr(workspaces, "LONGEST", -1.0)
    code, said = workspace(arm__urdf="<robot", b__yaml="a: 1\n")
    assert code == 0 and "not checked   2 of its 2 files: the -1 s for the workspace are" in said
    assert said.endswith("all that was checked will work\n")


def test_a_finding_is_translated_without_its_status(monkeypatch):
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    monkeypatch.setenv("LANGUAGE", "zh_CN")
    found = Finding("a", "build", PROBLEM, "it is left out: x: MoveIt is not in Debian")
    assert re.search(r"有问题 +build: 略去它：x：", table([found]))


def test_a_folder_that_is_no_workspace_and_one_that_is_named_by_its_src(tmp_path, capsys):
    assert main([str(tmp_path)]) == 2
    assert "this is not a workspace, it has no src/ with packages" in capsys.readouterr().err
    for place in ("a", "b"):
        (tmp_path / "src" / place).mkdir(parents=True)
        (tmp_path / "src" / place / "package.xml").write_text(
            "<package format='2'><name>arm</name><version>1.0.0</version><license>BSD</license>"
            "<description>d</description><maintainer email='a@example.com'>a</maintainer>"
            "</package>")
    assert main([str(tmp_path / "src")]) == 1
    assert "build: two packages are called arm: " in capsys.readouterr().out


def test_a_package_without_anything_to_check_is_not_said_to_work(capsys):
    assert main(["visualization_msgs"]) == 0
    said = capsys.readouterr()
    assert said.out == "" and "there is nothing to check: no script, robot" in said.err


def test_a_package_that_is_left_out_of_the_build(tmp_path, capsys):
    """The same lines as of its workspace."""
    arm = add_package(tmp_path / "src", "arm", "moveit_core", "moveit_core")
    hand = add_package(tmp_path / "src", "hand", "arm", "arm")
    add_package(tmp_path / "src", "wheel", "rospyy")
    assert main([str(tmp_path)]) == 1
    whole = capsys.readouterr().out
    for folder, why in ((arm, "moveit_core: MoveIt is not in"), (hand, "arm: it is left out it")):
        assert main([str(folder)]) == 1
        said = capsys.readouterr().out
        assert f"PROBLEM       build: it is left out: {why}" in said
        assert said.partition("\n\n")[0] in whole
    assert main([str(tmp_path / "src/wheel")]) == 1
    assert "rospyy: it will be without" in capsys.readouterr().out
    (arm / "package.xml").write_text("<package/>")
    assert main([str(hand)]) == 1
    assert f"workspace {tmp_path}\n  PROBLEM       build: {arm}/pa" in capsys.readouterr().out


def test_a_package_whose_scripts_are_all_fine(package, tmp_path, capsys):
    folder = package(talk__py="import rospy\n", see__cpp="int main() {}\n")
    assert main([folder]) == 0
    said = capsys.readouterr().out
    assert "works         scripts and C++ files (2)" in said
    assert said.endswith("all of it will work\n")
    package(talk__py="#!/usr/bin/env python3\nimport nobodys\n")
    (tmp_path / "talk.py").chmod(0o755)
    assert main([folder]) == 1 and "C++ files" not in capsys.readouterr().out


@pytest.fixture
def wheel(tmp_path):
    """A launch file of a package whose workspace is not sourced; its package has a script."""
    folder = add_plain(tmp_path / "src", "my_wheel", cmake="add_executable(n main.cpp)")
    add_files(folder, {"package.xml": (folder / "package.xml").read_text(),
                       "main.cpp": "int main() {}\n",
                       "scripts/talk.py": "#!/usr/bin/env python3\n",
                       "a.launch": '<launch><node pkg="my_wheel" type="talk.py" name="a"/>\n'
                       '<node pkg="my_wheel" type="n" name="n"/></launch>',
                       "r.xacro": '<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro">'
                       '<link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0"'
                       ' ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link><xacro:property '
                       'name="p" value="$(find my_wheel)"/></robot>'})
    return folder


@pytest.mark.parametrize("words", [["a.launch"], ["", "a.launch"], ["r.xacro"]])
def test_a_file_of_a_workspace_that_is_not_sourced(wheel, capsys, words):
    assert main([str(wheel / words[0]), *words[1:]]) == 0
    said = capsys.readouterr().out
    assert "is not here" not in said and said.endswith("all of it will work\n")
    assert ("node my_wheel/n: once the workspace is built" in said) is ("launch" in words[-1])
    add_package(wheel.parent / "again", "my_wheel")
    assert main([str(wheel / words[0]), *words[1:]]) == 1
    assert "build: two packages are called my_wheel: " in capsys.readouterr().out


def test_a_mistyped_package_of_the_same_workspace(wheel, capsys):
    path, meant = wheel / "a.launch", "nobody has that name; is my_wheel meant?"
    path.write_text(path.read_text().replace("my_wheel", "my_whel"))
    for what in (wheel.parents[1], wheel, path):
        assert main([str(what)]) == 1
        assert f"package my_whel is not here: {meant}" in capsys.readouterr().out
    assert not_to_be_had(judge(wheel.parent)) == [
        f"my_wheel will be without my_whel: {meant} (a.launch asks for it)"]
