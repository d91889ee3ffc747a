"""What becomes of a workspace's packages, and what `make deps` and catkin_make say of it."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from workspace_needs.build_commands import catkin_make_isolated_words, catkin_make_words
from workspace_needs.places import hook
from workspace_needs.tables import Tables
from workspace_needs.verdicts import judge
from workspace_needs.workspace import OUR_ADDRESS, Package, WorkspaceError, source_folder
from workspaces import add_package, add_plain, turtlebot3_style

from workspace_needs import command, configuring
from workspace_needs import verdicts as verdicts_module


@pytest.fixture
def bare(monkeypatch):
    """A machine on which nothing is installed."""
    monkeypatch.setattr(verdicts_module, "installed_packages", lambda names: set())
    monkeypatch.setattr(verdicts_module.rospkg, "RosPack", lambda: type("R", (), {
        "list": lambda self: []})())


@pytest.fixture(scope="module", autouse=True)
def kept(tmp_path_factory):
    """A folder for what is kept of one test for the next; its workspaces are all at one place."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_HOME", str(tmp_path_factory.mktemp("ros_home")))
        yield tmp_path_factory.mktemp("ws")


@pytest.fixture
def tmp_path(kept):
    """So that CMake configures a package that several tests write alike only once."""
    yield kept
    shutil.rmtree(kept)
    kept.mkdir()


def of(source, name):
    return next(verdict for verdict in judge(source) if verdict.name == name)


def test_a_workspace_like_turtlebot3s_needs_what_debian_has(tmp_path, bare):
    source = turtlebot3_style(tmp_path)
    bringup, simulation = of(source, "burger_bringup"), of(source, "burger_gazebo")
    assert bringup.missing["libroscpp-dev"] == "roscpp"
    assert "libdynamicedt3d-dev" in bringup.missing  # only CMakeLists.txt asks for it
    assert "ros-image-view" in simulation.missing  # only a launch file does
    assert bringup.builds and simulation.builds and not simulation.left_out


def test_what_nobody_has_stops_its_package_and_those_built_on_it(tmp_path, bare):
    source = tmp_path / "src"
    add_package(source, "arm", "moveit_core", "moveit_core")
    add_package(source, "hand", "arm", "roscpp arm")
    add_package(source, "wheel", "roscpp rospyy stdmsgs", "roscpp")
    assert of(source, "arm").stops["moveit_core"].startswith("MoveIt is not in Debian")
    assert of(source, "hand").stops == {"arm": "it is left out itself"}
    wheel = of(source, "wheel")
    assert wheel.builds and "is rospy meant?" in wheel.lacks["rospyy"]
    assert "is std_msgs meant?" in wheel.lacks["stdmsgs"]


def test_what_another_release_has_is_said(tmp_path, bare):
    source = tmp_path / "src"
    add_plain(source, "eye", "compressed_image_transport")
    verdict, = judge(source, Tables(of_release="bookworm"))
    assert verdict.lacks["compressed_image_transport"].startswith(
        "Debian 13 has it, Debian 12 does not")


def test_a_plugin_of_gazebo_in_cpp_is_left_out_alone(tmp_path, bare):
    folder = add_package(tmp_path / "src", "plugin", "gazebo_ros", "gazebo_ros",
                         "find_package(gazebo REQUIRED)\nadd_library(p src/p.cpp)")
    (folder / "src" / "p.cpp").write_text("#include <gazebo/gazebo.hh>\n", encoding="utf-8")
    verdict = of(tmp_path / "src", "plugin")
    assert verdict.builds and "includes <gazebo/gazebo.hh>" in verdict.left_out["target p"]


def test_a_lesson_that_is_copied_is_the_learners(tmp_path, bare):
    repository, own = tmp_path / "repository" / "src", tmp_path / "own" / "src"
    for folder, name in [(repository, "workspace_needs"), (repository / "lessons", "lesson"),
                         (own, "lesson")]:
        file = add_plain(folder, name, "roscpp") / "package.xml"
        text = file.read_text(encoding="utf-8")
        file.write_text(text.replace("who@example.com", OUR_ADDRESS), encoding="utf-8")
    assert judge(repository) == []
    assert of(own, "lesson").missing["libroscpp-dev"] == "roscpp"


def test_a_debian_name_is_its_own_key(tmp_path, bare):
    source = tmp_path / "src"
    add_plain(source, "a", "libxdo-dev no-such-library-dev")
    found = of(source, "a")
    assert "no-such-library-dev" in found.lacks
    assert "libxdo-dev" in found.missing or "libxdo-dev" in found.lacks  # apt may have no lists


def test_what_was_kept_is_not_read_by_a_package_that_has_changed(tmp_path, monkeypatch):
    folder = tmp_path / "workspace_needs"
    (folder / "cmake").mkdir(parents=True)
    monkeypatch.setattr(configuring, "package_folder", lambda: folder)
    package = Package("a", folder)
    digests = []
    for text in ("one", "two", "one"):
        (folder / "cmake/what_is_asked.cmake").write_text(text, encoding="utf-8")
        digests.append(configuring._digests({"a": package}, {"a": set()}, ["a"], [])["a"])
    assert digests[0] == digests[2] != digests[1]


def test_what_stops_every_build_tool_is_said_at_once(tmp_path, bare):
    source = tmp_path / "src"
    broken = add_package(source, "b") / "package.xml"
    right = broken.read_text("utf-8")
    broken.write_text("<package>", encoding="utf-8")
    with pytest.raises(WorkspaceError, match=r"b/package\.xml: The manifest contains invalid XML"):
        judge(source)
    broken.write_text(right, encoding="utf-8")
    add_package(source, "c")
    (source / "c/package.xml").write_text(right, encoding="utf-8")
    with pytest.raises(WorkspaceError, match=r"two packages are called b: .*/b and .*/c"):
        judge(source)


def test_packages_that_start_one_another_are_built(tmp_path, bare):
    source = tmp_path / "src"
    body = add_plain(source, "body")
    add_plain(source, "world", "body")
    (body / "launch").mkdir()
    (body / "launch/a.launch").write_text(
        '<launch><include file="$(find world)/launch/b.launch"/></launch>', encoding="utf-8")
    assert of(source, "body").builds and of(source, "world").builds
    manifest = body / "package.xml"
    text = manifest.read_text("utf-8")
    manifest.write_text(text.replace("</package>", "<exec_depend>arm</exec_depend></package>"),
                        encoding="utf-8")
    only = add_plain(source, "arm") / "package.xml"
    only.write_text(only.read_text("utf-8").replace(
        "</package>", "<exec_depend>body</exec_depend></package>"), encoding="utf-8")
    assert of(source, "body").builds and of(source, "arm").builds
    manifest.write_text(text.replace("</package>", "<depend>world</depend></package>"),
                        encoding="utf-8")
    with pytest.raises(WorkspaceError, match="circle: body -> world -> body; remove one"):
        judge(source)


def test_what_is_configured_later_stops_a_package(tmp_path, bare):
    source = tmp_path / "src"
    for name in ("arm", "wheel"):
        add_plain(source, name, "", "find_package(tool REQUIRED)")
    add_package(source, "tool")
    assert of(source, "arm").stops["tool"].endswith("add <depend>tool</depend> there")
    wheel = of(source, "wheel")
    assert wheel.builds  # by luck of its name, which is said
    assert wheel.lacks["tool"].endswith("add <depend>tool</depend> there")
    add_plain(source, "arm_2", "tool", "find_package(tool REQUIRED)")
    assert of(source, "arm_2").builds and not of(source, "arm_2").lacks


def test_what_catkin_config_saved_counts(tmp_path, bare):
    source = tmp_path / "src"
    add_plain(source, "one", cmake="if(NOT WITH_ARM)\nmessage(FATAL_ERROR \"no arm\")\nendif()")
    assert not of(source, "one").builds
    profile = tmp_path / ".catkin_tools/profiles/mine"
    profile.mkdir(parents=True)
    (profile.parent / "profiles.yaml").write_text("active: mine\n", encoding="utf-8")
    (profile / "config.yaml").write_text("cmake_args:\n- -DWITH_ARM=ON\n", encoding="utf-8")
    assert of(source, "one").builds
    (profile / "config.yaml").write_text("cmake_args: [\n", encoding="utf-8")
    assert not of(source, "one").builds


def test_the_compiler_is_tried_for_the_first_package_alone(tmp_path, bare, monkeypatch):
    tried = tmp_path / "tried"
    compiler = tmp_path / "bin/c++"
    compiler.parent.mkdir()
    compiler.write_text(f'#!/bin/sh\necho >> {tried}\nexec /usr/bin/c++ "$@"\n')
    compiler.chmod(0o755)
    monkeypatch.setenv("PATH", f"{compiler.parent}:{os.environ['PATH']}")
    counts, choice = [], f"set(CMAKE_CXX_COMPILER {compiler})"
    for name, before in (("one", ""), ("two", ""), ("three", choice)):
        file = add_plain(tmp_path / "src", name) / "CMakeLists.txt"
        file.write_text(before + "\n" + file.read_text())
        assert of(tmp_path / "src", name).builds
        counts.append(len(tried.read_text()))
    assert 0 < counts[0] == counts[1] < counts[2]


def test_what_cmake_started_ends_with_it_at_the_limit(tmp_path, bare, monkeypatch):
    monkeypatch.setattr(configuring, "LIMIT", 3.0)
    pid = tmp_path / "pid"
    (add_package(tmp_path / "src", "slow") / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.0.2)\nproject(slow NONE)\n"
        f"execute_process(COMMAND sh -c \"echo $$ > {pid}; exec sleep 600\")", encoding="utf-8")
    assert "no end within 3 s" in str(of(tmp_path / "src", "slow").stops)
    until = time.monotonic() + 60.0
    while runs(int(pid.read_text())) and time.monotonic() < until:
        time.sleep(0.05)
    assert not runs(int(pid.read_text()))


def runs(pid: int) -> bool:
    """Whether a process has not ended; one that nobody has waited for yet has no command line."""
    try:
        return bool(Path(f"/proc/{pid}/cmdline").read_bytes())
    except (FileNotFoundError, ProcessLookupError):
        return False


def test_a_package_may_use_the_libraries_of_others(tmp_path, bare):
    source = tmp_path / "src"
    for name, kind in (("arm", "SHARED"), ("leg", "STATIC")):
        folder = add_package(source, name, "", "", f"catkin_package(LIBRARIES {name})\n"
                             f"add_library({name} {kind} src/{name}.cpp)\nreturn()")
        (folder / f"src/{name}.cpp").write_text("int links() { return 1; }", encoding="utf-8")
    add_package(source, "hand", "arm leg", "arm leg")
    assert of(source, "hand").builds


def test_what_no_catkin_can_build_is_left_out(tmp_path, bare):
    source = tmp_path / "src"
    (add_package(source, "empty") / "CMakeLists.txt").unlink()
    manifest = add_package(source, "newer", "rclcpp") / "package.xml"
    manifest.write_text(manifest.read_text("utf-8").replace(
        "</package>", "<export><build_type>ament_cmake</build_type></export></package>"),
        encoding="utf-8")
    assert list(of(source, "empty").stops) == ["CMakeLists.txt"]
    assert "git clone -b noetic" in of(source, "newer").stops["ament_cmake"]


def test_what_cmake_finds_although_no_list_has_it_is_there(tmp_path, bare):
    folder = add_plain(tmp_path / "src", "a", "", "set(CMAKE_MODULE_PATH "
                       "${CMAKE_CURRENT_SOURCE_DIR})\nfind_package(Own REQUIRED)")
    (folder / "FindOwn.cmake").write_text("set(Own_FOUND TRUE)", encoding="utf-8")
    add_plain(tmp_path / "src", "b", "", "find_package(Wibble REQUIRED)")
    assert of(tmp_path / "src", "a").builds
    assert list(of(tmp_path / "src", "b").stops) == ["Wibble"]


@pytest.mark.parametrize("made, words", [
    ("", "there is no such folder"), ("ws", "it has no src/ with packages"),
    ("ws/src", "there is no package in it")])
def test_a_workspace_that_is_none(tmp_path, capsys, made, words):
    if made:
        (tmp_path / made).mkdir(parents=True)
    with pytest.raises(WorkspaceError, match=words):
        source_folder(tmp_path / "ws")
    assert command.main([str(tmp_path / "ws")]) == 2
    said = capsys.readouterr().err
    assert said.startswith("deps: ") and words in said and said.count("\n") == 1


def test_deps_names_the_folder_without_packages_and_the_usual_one(tmp_path, capsys, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "catkin_ws/src").mkdir(parents=True)
    for source, advice in ((tmp_path, "for those"), (tmp_path / "catkin_ws/src", "setup sees")):
        command._install([], 0, False, source)
        assert f"{source}: no package of your own is in it; {advice}" in capsys.readouterr().out


def test_deps_says_what_it_would_install_and_what_nobody_has(tmp_path, capsys, bare):
    source = turtlebot3_style(tmp_path)
    add_package(source, "arm", "moveit_core", "moveit_core")
    assert command.main(["--simulate", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert said.startswith("4 packages: to be installed: ") and "libtf-dev" in said
    assert said.count("MoveIt is not in Debian") == 1


def test_catkin_make_leaves_out_what_waits_for_a_package_of_debian(tmp_path, capsys, bare):
    add_plain(tmp_path / "src", "filter", "bfl", "find_package(bfl REQUIRED)")
    add_plain(tmp_path / "src", "user", "filter", "find_package(filter REQUIRED)")
    add_package(tmp_path / "src", "wheel", "", "")
    assert all(verdict.builds for verdict in judge(tmp_path / "src"))  # once it is installed
    option = catkin_make_words(["-C", str(tmp_path)])[0][len(hook())]
    assert option == "-DCATKIN_BLACKLIST_PACKAGES=filter;user"
    assert capsys.readouterr().out == (
        "filter is left out: liborocos-bfl-dev: it is not installed; type: rosrun workspace_needs "
        f"deps {tmp_path}\nuser is left out: filter: it is left out itself\n")


MESSAGES = """add_message_files(FILES {})
generate_messages(DEPENDENCIES std_msgs)"""


@pytest.mark.parametrize("components, name, text, why", [
    ("std_msgs message_generation", "Num.msg", "int46 num\n", "5: Cannot locate message [int46]"),
    ("std_msgs message_generation", "Numm.msg", "int64 num\n", "4: Assertion failed: file '"),
    ("std_msgs", "Num.msg", "int64 num\n", '4: Unknown CMake command "add_message_files". Add '
     "message_generation to find_package(catkin REQUIRED COMPONENTS ...)")])
def test_a_slip_in_a_package_of_messages(tmp_path, components, name, text, why):
    folder = add_package(tmp_path / "src", "talk", components, components, MESSAGES.format(name))
    (folder / "msg").mkdir()
    (folder / "msg/Num.msg").write_text(text)
    said, = of(tmp_path / "src", "talk").stops.items()
    assert ": ".join(said).startswith(f"CMakeLists.txt:{why}")


def test_an_error_behind_what_a_program_printed_without_a_line_end(tmp_path):
    add_plain(tmp_path / "src", "talk", cmake="execute_process(COMMAND printf 1.2)\nno_such()")
    assert of(tmp_path / "src", "talk").stops == {
        "CMakeLists.txt:4": 'Unknown CMake command "no_such".'}


def test_a_folder_without_a_package_xml(tmp_path, capsys, bare):
    source = tmp_path / "src"
    (add_package(source, "arm") / "package.xml").unlink()
    (add_package(source, "wheel") / "template").mkdir()
    (source / "wheel/template/CMakeLists.txt").write_text("catkin_package()\n")
    (source / "CMakeLists.txt").write_text("catkin_package()\n")
    assert "-DCATKIN_BLACKLIST_PACKAGES=" in catkin_make_words(["-C", str(tmp_path)])[0]
    assert capsys.readouterr().out == (
        "arm is left out: package.xml: there is none; catkin_create_pkg makes packages with one\n")
    (source / "wheel/package.xml").unlink()
    assert catkin_make_words(["-C", str(tmp_path)])[1].are_all
    assert [verdict.name for verdict in judge(source_folder(tmp_path))] == ["arm", "wheel"]


def test_a_package_xml_that_is_not_utf8(tmp_path):
    manifest = add_package(tmp_path / "src", "arm") / "package.xml"
    manifest.write_bytes(manifest.read_bytes().replace(b">d<", ">中文<".encode("gbk")))
    with pytest.raises(WorkspaceError, match="it is not UTF-8; save it as UTF-8; mend"):
        judge(tmp_path / "src")


def test_a_header_of_messages_that_nobody_has_is_told(tmp_path, bare):
    folder = add_plain(tmp_path / "src", "a", "", "add_executable(a src/a.cpp)")
    (folder / "include/a").mkdir(parents=True)
    for name in ("src/a.cpp", "src/unused.cpp", "include/a/seen.h", "include/a/unused.h"):
        (folder / name).write_text("#include <nothing_msgs/X.h>\n", encoding="utf-8")
    with (folder / "src/a.cpp").open("a", encoding="utf-8") as file:
        file.write("#include \"a/seen.h\"\n")
    found = of(tmp_path / "src", "a")
    assert found.uncompiled == dict.fromkeys(
        ("include/a/seen.h", "src/a.cpp"), "the header <nothing_msgs/X.h> is not here: neither "
        "Debian nor this repository has it; clone its source into src/, or mend the name")
    assert not found.lacks
    assert "a: src/a.cpp will not compile: the header" in "\n".join(command.not_to_be_had([found]))


def test_a_package_is_not_told_to_name_what_it_names(tmp_path, bare):
    add_plain(tmp_path / "src", "b", "", 'message(FATAL_ERROR "worn out")')
    add_plain(tmp_path / "src", "c", "b", "find_package(b REQUIRED)")
    assert of(tmp_path / "src", "c").stops == {"b": "it is left out itself"}
    assert not of(tmp_path / "src", "c").lacks


def test_catkin_make_leaves_out_what_cannot_be_built(tmp_path, capsys, monkeypatch, bare):
    add_package(tmp_path / "src", "arm", "moveit_core", "moveit_core")
    add_package(tmp_path / "src", "wheel", "", "")
    option = "-DCATKIN_BLACKLIST_PACKAGES=arm"
    assert catkin_make_words(["-C", str(tmp_path)])[0] == [
        *hook(), option, "-C", str(tmp_path)]
    assert capsys.readouterr().out.startswith("arm is left out: moveit_core: MoveIt is not")
    monkeypatch.chdir(tmp_path)
    assert catkin_make_words(["--make-args", "-j2"])[0] == [*hook(), option, "--make-args", "-j2"]
    chosen = ["-DCATKIN_BLACKLIST_PACKAGES=wheel"]
    assert catkin_make_words(chosen)[0] == [*hook(), *chosen]
    for words, are_all in ((["-DCATKIN_WHITELIST_PACKAGES=arm"], True),
                           (["-DCATKIN_WHITELIST_PACKAGES=arm;wheel"], False),
                           (["-DCATKIN_WHITELIST_PACKAGES="], False),
                           (["--only-pkg-with-deps=arm"], True),
                           (["--only-pkg-with-deps", "arm", "wheel"], False)):
        given, left = catkin_make_words(words)
        assert given == [*hook(), option, *words] and left.are_all is are_all
    monkeypatch.chdir(tmp_path / "src")
    assert "arm" not in catkin_make_words([])[0][1]  # catkin_make says that this is no workspace


def test_catkin_make_isolated_does_too(tmp_path, monkeypatch, bare):
    add_package(tmp_path / "src", "arm", "moveit_core", "moveit_core")
    monkeypatch.chdir(tmp_path)
    for typed, given in (("--cmake-args -DX=1", "--ignore-pkg arm --cmake-args -DX=1"),
                         ("--ignore-pkg hand", "--ignore-pkg arm hand"),
                         ("--pkg arm", "--pkg arm"),
                         ("--from-pkg=arm", "--from-pkg=arm")):
        assert catkin_make_isolated_words(typed.split())[0] == [*hook(), *given.split()]


def test_an_interrupt_of_this_program_alone_ends_the_tool(tmp_path):
    tool = tmp_path / "catkin_make"
    tool.write_text("#!/bin/sh\necho begun\nexec sleep 60\n")
    tool.chmod(0o755)
    program = (f"from workspace_needs import build_commands as commands; "
               f"commands.FOLDER = {str(tmp_path)!r}; "
               f"commands._run('catkin_make', [], commands.LeftOut(lines=['arm is left out']))")
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE,
                          text=True) as process:
        assert process.stdout.readline() == "begun\n"
        process.send_signal(signal.SIGINT)
        assert process.wait(20) == 130
        assert process.stdout.read() == "arm is left out\n"
