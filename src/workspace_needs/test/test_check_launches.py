"""check of launch files: what it reads of them, and what it does not run."""

import mmap
import os
import time
from pathlib import Path

import pytest
import rospkg
from robot_texts import LAUNCH, ROBOT, WORLD
from workspace_needs.check import launch_files
from workspace_needs.check.command import main

# A file is checked in a fork of this process, which must not hold engines or OpenGL of other tests.
pytestmark = pytest.mark.processes


def test_a_launch_file_with_its_robot_and_its_nodes(check, tmp_path):
    (tmp_path / "robot.urdf").write_text(ROBOT.format(""))
    code, said = check("a.launch", LAUNCH.format("robot_description", "gazebo_ros", "spawn_model"))
    assert code == 0, said
    assert "parameter /robot_description\n  works         model r" in said
    code, said = check("a.launch", LAUNCH.format("robot_description", "no_such_pkg", "x"))
    assert code == 1 and "NOT THERE     node no_such_pkg/x: package no_such_pkg is not here" in said
    code, said = check("a.launch", LAUNCH.format("robot_description", "slam_karto", "x"))
    assert code == 1 and "package slam_karto is not here: not in Debian; gmapping makes" in said
    code, said = check("a.launch", LAUNCH.format("robot_descr", "gazebo_ros", "no_such"))
    assert code == 1
    assert "node gazebo_ros/no_such: package gazebo_ros has no executable no_such" in said
    assert "PROBLEM       spawn_model -param robot_descr: no parameter /robot_descr" in said
    assert "PROBLEM       launch file:" in check("a.launch", "<launch>")[1]


@pytest.mark.parametrize(("package", "name", "near"), [
    ("gazebo_ros", "spawn_modle", "spawn_model"),
    ("learning_topic", "06folower_pid.py", "06follower_pid.py"), ("learning_topic", "zzz", "")])
def test_a_mistyped_node_is_answered_with_the_nearest(check, tmp_path, package, name, near):
    (tmp_path / "robot.urdf").write_text(ROBOT.format(""))
    said = check("a.launch", LAUNCH.format("robot_description", package, name))[1]
    assert f"did you mean {near}?" in said if near else "did you mean" not in said


def test_controllers_of_a_launch_file(check, tmp_path):
    (tmp_path / "robot.urdf").write_text(ROBOT.format(""))
    (tmp_path / "c.yaml").write_text("""
state: {type: joint_state_controller/JointStateController}
arm: {type: my_things/Controller}
other: {type: their_things/Planner}
wheel: {type: velocity_controllers/JointVelocityControler, joint: j}""")
    code, said = check("a.launch", """<launch><rosparam file="$(dirname)/c.yaml" ns="r"/>
      <node name="s" pkg="controller_manager" type="spawner" ns="r" args="state arm"/></launch>""")
    assert code == 1
    assert "works         controller /r/state (joint_state_controller/JointStateController" in said
    assert ("NOT THERE     controller /r/wheel (velocity_controllers/JointVelocityControler): "
            "there is no such type of controller here (did you mean velocity_controllers/JointVeloc"
            "ityController?)") in said
    assert "NOT THERE     controller /r/arm (my_things/Controller)" in said
    assert "their_things" not in said


def test_a_fault_in_a_launch_file_hides_no_other(check, tmp_path):
    (tmp_path / "part.launch").write_text("""<launch><rosparam file="$(dirname)/none.yaml"/>
      <node name="p" pkg="no_such_pkg" type="x"/><include file="$(find nobodys)/b.launch"/>
      <node pkg="rospy"/></launch>""")
    code, said = check("a.launch", """<launch>
      <include file="$(dirname)/pard.launch"/><include file="$(find no_such_pkg)/a.launch"/>
      <include file="$(dirname)/part.launch"/>
      <param name="a" textfile="$(dirname)/none.txt"/><param name="b" type="int" value="x"/>
      <node name="n" pkg="learning_topic" type="06folower_pid.py"/>
      <node name="s" pkg="gazebo_ros" type="spawn_model" args="-param robot_description -urdf"/>
      <node name="m" pkg="learning_topic"/><include file="$(arg nobody)"/></launch>""")
    lines = said.splitlines()
    assert code == 1
    for words in (f"<include>: there is no file {tmp_path}/pard.launch (did you mean part.launch?)",
                  "no package no_such_pkg is found", "while processing "
                  f"{tmp_path}/part.launch: error loading <rosparam> tag: file does not exist",
                  "part.launch: no package nobodys is", "part.launch: <node> tag is missing",
                  "none.txt", "Invalid <param> tag: invalid literal for int", "attribute: 'type'",
                  'no <arg name="nobody"> stands before $(arg nobody)'):
        assert [line for line in lines if "  PROBLEM       launch file: " in line
                and words in line], (words, said)
    assert "node no_such_pkg/x: package no_such_pkg is not here" in said
    assert "has no executable 06folower_pid.py here (did you mean 06follower_pid.py?)" in said
    assert "spawn_model -param" not in said  # a file that is not there may be to set it


def test_launch_files_that_need_arguments(package, capsys):
    folder = package(part__launch="""<launch><arg name="model"/><arg name="x" default="0"/>
      <arg name="world"/></launch>""")
    assert main([folder]) == 0
    said = capsys.readouterr().out
    assert "not checked   launch file: it needs model:=… world:=…; rosrun bullet_sim_ros" in said
    assert said.endswith("all that was checked will work\n")
    assert main([f"{folder}/part.launch", "world:=w"]) == 1
    assert "PROBLEM       launch file: it needs model:=…; " in capsys.readouterr().out
    assert main([f"{folder}/part.launch", "world:=w", "model:=m"]) == 0


def test_an_argument_without_a_name_is_roslaunchs_to_complain_of(check):
    code, said = check("a.launch", "<launch><arg/></launch>")
    assert code == 1 and "PROBLEM       launch file: Invalid <arg> tag: 'name'" in said


@pytest.mark.parametrize("name", ["/b.launch", "sub/a.launch", "*.launch"])
def test_a_launch_file_that_a_package_does_not_have(package, capsys, name):
    assert main([package(a__launch="<launch/>"), name]) == 1
    assert "there are: a.launch" in capsys.readouterr().out


def test_arguments_in_quotation_marks(check, tmp_path):
    (tmp_path / "my robot.urdf").write_text(ROBOT)
    node = ('<launch><node pkg="gazebo_ros" type="spawn_model" name="s" '
            'args="-urdf -file \'{}/my robot.urdf\' -model r{}"/></launch>')
    code, said = check("a.launch", node.format(tmp_path, ""))
    assert code == 0 and "my robot.urdf\n  works         model" in said
    assert "works         node gazebo_ros/spawn_model" in check("a.launch", node.format("", "'"))[1]


def test_commands_run_once_and_files_are_read_once(check, tmp_path):
    runs = tmp_path / "runs"
    again = f'<param name="{{}}" command="bash -c \'echo x >> {runs}; echo made\'"/>'
    text = f"<launch>{again.format('a')}{again.format('b')}</launch>"
    code, said = check("a.launch", text, "--run-commands")
    assert code == 0, said
    assert runs.read_text() == "x\n"


@pytest.mark.parametrize("command", [
    "touch {}", "bash -c 'touch {}'", "cat {} --help", "xacro -o {} {}", "rosrun xacro other {}",
    "python3 -c 'open(&quot;{}&quot;, &quot;w&quot;)'",
])
def test_what_is_looked_at_is_not_run(check, tmp_path, command):
    made = tmp_path / "made"
    command = command.replace("{}", str(made))
    node = '<node pkg="gazebo_ros" type="spawn_model" name="s" args="-urdf -param r -model m"/>'
    code, said = check("a.launch", f'<launch><param name="r" command="{command}"/>{node}</launch>')
    assert not made.exists()
    assert code == 0 and "not checked   parameter /r: its command is not run: " in said
    assert "--run-commands runs it" in said


def test_eval_writes_no_file(check, tmp_path):
    made = tmp_path / "made"
    code, said = check("a.launch",
                       f"<launch><arg name='a' default=\"$(eval open('{made}', 'w'))\"/></launch>")
    assert code == 1 and "'open' is not defined" in said
    assert not made.exists()


@pytest.mark.parametrize("command, works", [
    ("xacro {} name:=car", True), ("$(find xacro)/xacro --inorder {}", True),
    ("rosrun xacro xacro.py {}", True), ("cat {}", True), ("xacro {}.not_there", False),
])
def test_xacro_and_cat_are_done_without_running_them(check, tmp_path, command, works):
    (tmp_path / "car.urdf").write_text(ROBOT)
    node = '<node pkg="gazebo_ros" type="spawn_model" name="s" args="-urdf -param r -model m"/>'
    command = command.replace("{}", str(tmp_path / "car.urdf"))
    code, said = check("a.launch", f'<launch><param name="r" command="{command}"/>{node}</launch>')
    assert ("parameter /r\n  works         model" in said) is works, said
    assert (code == 0) is works


@pytest.mark.parametrize("inside, words", [
    ('<param name="a" textfile="{}/pipe"/>', "/pipe cannot be read: it is a pipe or device"),
    ('<param name="a" textfile="/dev/zero"/>', "/dev/zero cannot be read: it is a pipe or device"),
    ('<param name="a" value="$(eval 2**2**40)"/>', "takes more than 3 s or 1 GiB; look at its $("),
    ('<arg name="a" default="$(eval list(range(10**9)))"/>',
     "Invalid <arg> tag: to read it takes more than 3 s or 1 GiB; look at its $("),
    ('<include file="{}/a.launch"/>', "a.launch includes itself without end; remove the <include>"),
    ('<include file="{}/b.launch"/>', "a.launch includes itself by way of "),
    ("<group>" * 1500 + "</group>" * 1500, "elements are nested too deep"),
])
def test_launch_files_that_do_not_end(check, tmp_path, inside, words):
    if "pipe" in inside:
        os.mkfifo(tmp_path / "pipe")
    (tmp_path / "b.launch").write_text(f'<launch><include file="{tmp_path}/a.launch"/></launch>')
    code, said = check("a.launch", f"<launch>{inside.replace('{}', str(tmp_path))}</launch>")
    (line,) = [line for line in said.splitlines() if "PROBLEM" in line]
    assert code == 1 and words in line, said


def test_packages_that_are_not_there_are_looked_for_once(check, monkeypatch, tmp_path):
    crawled, crawl = tmp_path / "crawled", rospkg.rospack.list_by_path

    def counting(*what):  # in the process that reads the file
        with crawled.open("a") as file:
            file.write("x")
        return crawl(*what)

    monkeypatch.setattr(rospkg.rospack, "list_by_path", counting)

    def folders_crawled(count):
        crawled.write_text("")
        nodes = "".join(f'<node pkg="no_such_{i}" type="t" name="n{i}"/>' for i in range(count))
        assert check("a.launch", f"<launch>{nodes}</launch>")[1].count("clone it") == count
        return len(crawled.read_text())

    folders_crawled(1)  # with what is kept for all files
    assert folders_crawled(5) == folders_crawled(1) > 0


def test_the_memory_of_whoever_asks_does_not_count(check):
    large = mmap.mmap(-1, 3 << 29, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
    text = f'<param name="a" value="{"x" * 1000}"/>' * 2000
    try:
        code, said = check("a.launch", f"<launch>{text}</launch>")
        assert code == 0, said
    finally:
        large.close()


def test_a_part_that_many_robots_include_is_no_circle(check, tmp_path):
    (tmp_path / "one.launch").write_text("<launch/>")
    inside = f'<include file="{tmp_path}/one.launch"/>' * 30
    assert check("a.launch", f"<launch>{inside}</launch>")[0] == 0


def test_a_command_that_waits_is_ended(check, tmp_path, monkeypatch):
    monkeypatch.setattr(launch_files, "LONGEST_WAIT", 15)  # roslaunch runs one of its own first
    pid = tmp_path / "pid"
    code, said = check("a.launch", '<launch><param name="a" command="bash -c \'echo $$ > '
                       f'{pid}; exec sleep 100\'"/></launch>', "--run-commands")
    assert code == 1 and "its command has not ended after 15 s: bash -c 'echo $$" in said
    stat = Path(f"/proc/{int(pid.read_text())}/stat")
    for _ in range(600):
        try:
            if ") Z " in stat.read_text():  # dead; nobody may be there to collect it
                return
        except OSError:
            return
        time.sleep(0.1)
    pytest.fail("its command still runs")


def test_memory_that_runs_out_is_said_as_such():
    assert "1 GiB; look at its $(eval" in launch_files._error_line(MemoryError())


def test_files_that_are_not_utf8(check, tmp_path):
    (tmp_path / "a.urdf").write_bytes(b"<robot name='r'>\n<!-- \xd6\xd0 --></robot>")
    assert main([str(tmp_path / "a.urdf")]) == 1
    model = "<sdf version='1.6'><model name='m'><link name='l'/></model></sdf>"
    (tmp_path / "a.sdf").write_bytes(model.encode("utf-16"))
    launch = ('<launch><node name="s" pkg="gazebo_ros" type="spawn_model" '
              f'args="-sdf -file {tmp_path}/a.sdf -model m"/></launch>')
    code, said = check("a.launch", launch)
    assert "a.urdf, line 2: this is not UTF-8, which roslaunch needs; save the file" in said
    assert code == 0 and "works         model m" in said


@pytest.mark.parametrize("name, content", [
    ("a", b"a: \xe9"), ("b", b"a: \xe9 b"), ("c", "a: 1".encode("utf-16"))])
def test_a_parameter_file_that_is_not_utf8(check, tmp_path, name, content):
    (tmp_path / f"{name}.yaml").write_bytes(content)
    inside = f'<rosparam file="{tmp_path}/{name}.yaml"/>'
    code, said = check("a.launch", f"<launch>{inside}</launch>")
    assert code == 1 and "tag: it is not UTF-8; save it as UTF-8 XML is <rosparam file=" in said


def test_search_paths_that_a_launch_file_sets(package, tmp_path, capsys):
    (tmp_path / "crate").mkdir()
    (tmp_path / "crate/model.sdf").write_text(
        '<sdf version="1.6"><model name="crate"><static>1</static><link name="l"/></model></sdf>')
    world = WORLD.format("<include><uri>model://crate</uri></include>")
    launch = """<launch>{}<node pkg="gazebo_ros" type="gzserver" name="g" args="here.world"/>
      </launch>"""
    paths = "".join(f'<env name="GAZEBO_{kind}_PATH" value="{tmp_path}"/>'
                    for kind in ("RESOURCE", "MODEL"))
    folder = package(here__world=world)
    for env, code in (("", 1), (paths, 0)):
        package(a__launch=launch.format(env))
        assert main([f"{folder}/a.launch"]) == code, capsys.readouterr().out
    said = capsys.readouterr().out
    assert "here.world\n  works         world w (2 models)" in said


def test_xacro_that_a_package_runs_by_itself_is_said_to_be_unread(tmp_path, capsys, monkeypatch):
    folder = tmp_path / "own_spawner"
    (folder / "scripts").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>own_spawner</name></package>")
    script = folder / "scripts/spawn.sh"
    script.write_text("#!/bin/sh\nrosparam set robot_description \"$(xacro $1.xacro)\"\n")
    script.chmod(0o755)
    (folder / "a.launch").write_text(
        '<launch><node pkg="own_spawner" type="spawn.sh" name="s"/></launch>')
    monkeypatch.setenv("ROS_PACKAGE_PATH", f"{folder}:{os.environ['ROS_PACKAGE_PATH']}")
    assert main([f"{folder}/a.launch"]) == 0
    said = capsys.readouterr().out
    assert f"not checked   node own_spawner/spawn.sh: {script} runs xacro; the robot that" in said
    assert said.endswith("all that was checked will work\n")
