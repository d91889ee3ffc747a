"""A learner's workspace on top of ours: it builds with each tool, runs, and wins over ours.

`workspaces/shapes` holds a package of each shape that learners bring, `workspaces/tutorial_a`
packages with the names, dependencies and kinds of targets of those that tutorial A clones. All are
built by catkin_make, and of the shapes those by `catkin build` to which the tool can make a
difference. It compiles on one processor: other tests run beside it.
"""

import os
import re
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes

ROOT = Path(__file__).resolve().parent.parent
WORKSPACES = ROOT / "test/workspaces"
LIMIT = 120.0  # s, wall, for anything that a running node must show
BUILD_LIMIT = 600.0  # s, wall, on a busy machine
BUILDS = {
    "catkin_make": "catkin_make -j1 --no-color -DCATKIN_ENABLE_TESTING=OFF",
    "catkin build": "catkin build -p1 -j1 --no-status --no-color --no-notify "
                    "--cmake-args -DCATKIN_ENABLE_TESTING=OFF",
}
PACKAGES = {"catkin_make": ["shapes/*", "tutorial_a/*"],
            "catkin build": ["shapes/shape_gazebo", "shapes/shape_msgs", "shapes/shape_python",
                             "shapes/turtlebot3_teleop"]}
LEFT_OUT = {
    "shape_plugin": ["include/shape_gazebo/plugin.h includes <gazebo/gazebo.hh>, and the C++ API "
                     "of Gazebo is not here", "rosrun bullet_sim_ros check shape_gazebo"],
    "uses_plugin": ["it links to shape_plugin, which is left out"],
}
LEFT_OUT_BY_CATKIN_MAKE = {
    "shape_controller": ["includes <controller_interface/controller.h>, and the C++ API of "
                         "ros_control is not here"],
    "shape_planner": ["includes <nav_core/base_global_planner.h>, and the C++ API of navigation "
                      "is not here"],
    "shape_old_plugin": ["includes <gazebo_plugins/gazebo_ros_utils.h>"],
}
PROGRAMS = [
    ("rosrun shape_python plain.py", "42.0 4."),
    ("rosrun shape_python plain3.py", "42.0 4."),
    ("rosrun shape_python installed.py", "42.0 4."),
    ("rosrun shape_gazebo beside", "beside the plugin 1.0"),
    ("rosrun turtlebot3_teleop whose", "the learner"),
    ("roslaunch --files turtlebot3_teleop whose.launch",
     "/src/turtlebot3_teleop/launch/whose.launch"),
    ("rospack find learning_topic", "/catkin_ws/src/learning_topic"),
    ("rospack find racecar_description", str(ROOT / "src/racecar_description")),
    ("python -c 'import turtlebot3_teleop as t; print(t.__file__)'", "/devel/lib/python3/"),
    ("rosmsg show shape_msgs/Reading", "float64 value"),
]
PROGRAMS_OF_CATKIN_MAKE = [
    ("rosrun shape_library_user count_links", "1"),
    ("xacro $(rospack find shape_description)/urdf/box.urdf.xacro", '<box size="0.2 0.2 0.2"'),
    ("rosrun shape_plugins load_shape", "4 sides"),
    ("rosrun shape_diagnostics diagnose", "0.500"),
    ("rospack find turtlebot3_gazebo", "/src/turtlebot3_simulations/turtlebot3_gazebo"),
    ("rosmsg show turtlebot3_msgs/VersionInfo", "string firmware"),
]
REFUSED = [
    ("rosrun shape_gazebo uses_plugin", "uses_plugin was left out when shape_gazebo was built"),
    ("rosrun shape_python old.py", "line 2: Missing parentheses"),
]


def environment(port: int | None = None) -> dict[str, str]:
    """What a new terminal has, and a master of the test's own."""
    kept = {"PATH": "/usr/local/bin:/usr/bin:/bin", "TERM": "dumb", "ROS_HOSTNAME": "localhost"}
    # By the last the test's processes are known to the runner of all tests.
    for name in ("HOME", "LANG", "ROS_HOME", "ROS_LOG_DIR", "RUN_TESTS_MARK"):
        if name in os.environ:
            kept[name] = os.environ[name]
    return kept | ({"ROS_MASTER_URI": f"http://localhost:{port}"} if port else {})


def in_terminal(command: str, setup: Path, port: int | None = None,
                limit: float = LIMIT) -> subprocess.CompletedProcess:
    """Runs a line in a terminal that has sourced a setup.bash; both streams in stdout."""
    return subprocess.run(["bash", "-c", f". {setup}\n{command}"], env=environment(port),
                          text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          stdin=subprocess.DEVNULL, timeout=limit)


@pytest.fixture(scope="module", params=BUILDS)
def built(request, tmp_path_factory) -> tuple[Path, str]:
    """A workspace with all packages, built by one tool; its folder and what the tool printed.

    Both are at the same place: what CMake says of each package is kept of the first.
    """
    folder = tmp_path_factory.mktemp("catkin_ws", numbered=False)
    request.addfinalizer(lambda: shutil.rmtree(folder))
    for path in [found for each in PACKAGES[request.param] for found in WORKSPACES.glob(each)]:
        shutil.copytree(path, folder / "src" / path.name)
    ours = ROOT / "devel/setup.bash"
    made = in_terminal(f"cd {folder}/src && catkin_create_pkg learning_topic rospy std_msgs "
                       "sensor_msgs cv_bridge", ours)
    assert made.returncode == 0, made.stdout
    scripts = folder / "src/learning_topic/scripts"
    scripts.mkdir()
    shutil.copy(ROOT / "src/learning_topic/scripts/05follower_proporation.py", scripts)
    done = in_terminal(f"cd {folder} && {BUILDS[request.param]}", ours, limit=BUILD_LIMIT)
    assert done.returncode == 0, done.stdout[-4000:]
    return folder, done.stdout


@pytest.mark.timeout(BUILD_LIMIT + 60)  # the first one, which the build comes before
def test_one_line_for_each_target_that_cannot_be_built(built):
    catkin_make = (built[0] / "src/turtlebot3").exists()
    expected = LEFT_OUT | (LEFT_OUT_BY_CATKIN_MAKE if catkin_make else {})
    for target, words in expected.items():
        said, = re.findall(rf".*: target {target} is left out: .*", built[1])
        assert all(each in said for each in words), said
    assert built[1].count(" is left out: ") == len(expected)


@pytest.mark.parametrize(("command", "said"), PROGRAMS)
def test_a_program_runs(built, command, said):
    done = in_terminal(command, built[0] / "devel/setup.bash")
    assert done.returncode == 0 and said in done.stdout, done.stdout


@pytest.mark.parametrize("built", ["catkin_make"], indirect=True)
@pytest.mark.parametrize(("command", "said"), PROGRAMS_OF_CATKIN_MAKE)
def test_a_program_of_catkin_makes_workspace_runs(built, command, said):
    test_a_program_runs(built, command, said)


@pytest.mark.parametrize(("command", "said"), REFUSED)
def test_what_cannot_run_says_why_in_one_line(built, command, said):
    done = in_terminal(command, built[0] / "devel/setup.bash")
    assert done.returncode != 0 and said in done.stdout, done.stdout
    assert done.stdout.count("\n") == 1


def test_the_learners_folders_come_first_and_once(built):
    twice = f". {built[0]}/devel/setup.bash; echo $CMAKE_PREFIX_PATH; echo $PATH"
    done = in_terminal(twice, built[0] / "devel/setup.bash")
    prefixes, path = done.stdout.splitlines()
    assert prefixes == f"{built[0]}/devel:{ROOT}/devel"
    assert path.split(":").count(f"{ROOT}/.venv/bin") == 1


@pytest.mark.parametrize("built", ["catkin_make"], indirect=True)
@pytest.mark.parametrize("shell", ["sh", "bash"])
def test_each_shell_can_source_it(built, shell):
    line = (f"cd {built[0]}/devel && . ./setup.{shell} && rospack find learning_topic && "
            "rosrun shape_gazebo beside")
    done = subprocess.run([shell, "-c", line], env=environment(), text=True, timeout=LIMIT,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert "beside the plugin" in done.stdout, done.stdout


@pytest.mark.parametrize("built", ["catkin_make"], indirect=True)
def test_the_workspace_installs(built):
    """Left-out targets have install rules, too."""
    done = in_terminal(f"cd {built[0]} && {BUILDS['catkin_make']} install",
                       ROOT / "devel/setup.bash", limit=400)
    assert done.returncode == 0, done.stdout[-3000:]
    done = in_terminal("rosrun shape_gazebo beside; roslaunch --files shape_gazebo world.launch",
                       built[0] / "install/setup.bash")
    assert "beside the plugin" in done.stdout
    assert "/install/share/shape_gazebo/launch/world.launch" in done.stdout


def free_port() -> int:
    with socket.socket() as found:
        found.bind(("localhost", 0))
        return found.getsockname()[1]


@pytest.fixture(scope="module")
def running(built, tmp_path_factory):
    """Everything of workspaces/running.launch, with a master of its own."""
    port = free_port()
    log = (tmp_path_factory.mktemp("running") / "roslaunch.log").open("w+")
    process = subprocess.Popen(
        ["bash", "-c", f". {built[0]}/devel/setup.bash\n"
         f"exec roslaunch -p {port} {WORKSPACES}/running.launch"],
        env=environment(port), stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
        start_new_session=True)

    def ask(command: str, wanted: str) -> None:
        """Types a line until its output has what is wanted."""
        until = time.monotonic() + LIMIT
        while True:
            done = in_terminal(f"timeout 60 {command}", built[0] / "devel/setup.bash", port)
            if wanted in done.stdout:
                return
            log.seek(0)
            assert time.monotonic() < until, f"{command}: {done.stdout}\n{log.read()[-3000:]}"
            assert process.poll() is None, log.read()[-3000:]

    yield ask
    process.send_signal(signal.SIGINT)
    process.wait(LIMIT)
    log.close()


@pytest.mark.parametrize("built", ["catkin_make"], indirect=True)
@pytest.mark.parametrize(("command", "wanted"), [
    ("rostopic echo -n1 /heard_cpp", "data: 42.0"),
    ("rostopic echo -n1 /heard_nodelet", "data: 42.0"),
    ("rosservice call /scale 4", "scaled: 8.0"),
    ("rosrun dynamic_reconfigure dynparam get /shape_speed", "'speed': 0.5"),
    ("rosrun dynamic_reconfigure dynparam get /shape_speed_cpp", "'speed': 0.5"),
    ("rostopic echo -n1 /tf", "child_frame_id:"),
    ("rosnode list", "/turtlebot3_marker_server"),
    ("rosservice call /gazebo/get_world_properties", "shape_course"),
    ("rostopic echo -n1 /camera/rgb/image_raw/width", "64"),
])
def test_nodes_of_the_workspace_work_together(built, running, command, wanted):
    running(command, wanted)


@pytest.mark.parametrize("built", ["catkin_make"], indirect=True)
def test_the_tutorials_robot_drives_and_its_script_runs(built, running):
    running("rostopic echo -n1 /odom/pose/pose/position/x", "---")
    running("bash -c 'roslaunch turtlebot3_gazebo turtlebot3_simulation.launch & "
            "until rosservice call /gazebo/get_model_state turtlebot3_waffle world"
            " | grep -A1 position | grep -E \"x: (0[.][1-9]|[1-9])\"; do sleep 1; done; "
            "echo driven; kill $!; wait'", "driven")
    running("bash -c 'rosrun learning_topic 05follower_proporation.py & "
            "rostopic echo -n1 /cmd_vel; kill $!; wait'", "angular")
