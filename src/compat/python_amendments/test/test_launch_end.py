"""roslaunch ends by a refusal of our programs alone, by Ctrl-C, or by SIGHUP unless with nohup.

It and other programs of ROS begin without what they seldom need.
"""

import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
from catkin_pkg import packages
from node_basics.refusing import REFUSED
from python_amendments.launch_end import amend_loader, amend_packages

pytestmark = pytest.mark.processes

LIMIT = 60.0  # s
AMENDMENTS = Path(__file__).parents[1] / "src"
GUARD = "/share/bullet_sim_ros/scripts/unless_running true"


@pytest.mark.parametrize(("fault", "ends"), [
    (f"returned with code [{REFUSED}]", SystemExit), ("returned with code [1]", ValueError),
    ("returned with code [2]", ValueError), ("no such command", ValueError)])
def test_only_a_refusal_ends_it(fault, ends):
    class Loader:
        def param_value(self, _verbose, name, *_):
            raise ValueError(f"Cannot load command parameter [{name}]: {fault}")

    amend_loader(SimpleNamespace(Loader=Loader))
    with pytest.raises(ends) as ended:
        Loader().param_value(False, "/use_sim_time", "auto", None, None, None, GUARD)
    assert ends is ValueError or ended.value.code == 1


def test_a_value_is_passed_on():
    class Loader:
        def param_value(self, *words):
            return words

    amend_loader(SimpleNamespace(Loader=Loader))
    assert Loader().param_value(False, "/use_sim_time", GUARD) == (False, "/use_sim_time", GUARD)


def test_ctrl_c_while_a_param_is_computed_is_no_traceback(tmp_path):
    begun, launch = tmp_path / "begun", tmp_path / "slow.launch"
    launch.write_text(f'<launch><param name="a" command="sh -c \'touch {begun}; exec sleep 60\'"/>'
                      '</launch>', encoding="utf-8")
    started = subprocess.Popen(["roslaunch", launch], text=True, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, start_new_session=True, preexec_fn=by_hand)
    try:
        end = time.monotonic() + LIMIT
        while not begun.exists() and time.monotonic() < end:
            time.sleep(0.05)
        os.killpg(started.pid, signal.SIGINT)
        assert "Traceback" not in started.communicate(timeout=LIMIT)[1]
        assert started.returncode == -signal.SIGINT
    finally:
        started.kill()
        started.wait()


@pytest.mark.parametrize(("handler", "code"), [
    (signal.default_int_handler, -signal.SIGINT), (signal.SIG_IGN, 0)])  # in a shell 130
def test_ctrl_c_while_python_starts_is_no_traceback(tmp_path, handler, code):
    (tmp_path / "terminal_language").mkdir()
    (tmp_path / "terminal_language/__init__.py").touch()
    (tmp_path / "terminal_language/wanted.py").write_text(
        "import os, signal\ndef start():\n    os.kill(os.getpid(), signal.SIGINT)\n"
        "def is_ours(_words):\n    return True\n")
    done = subprocess.run(
        [sys.executable, "-c", ""], text=True, capture_output=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, handler),
        env=os.environ | {"LANG": "zh_CN.UTF-8", "PYTHONPATH": f"{tmp_path}:{AMENDMENTS}"})
    assert (done.returncode, done.stderr) == (code, "")


def test_a_program_gets_pythons_own_ctrl_c():
    done = subprocess.run(
        [sys.executable, "-c", "import signal; print(signal.getsignal(signal.SIGINT).__name__)"],
        text=True, capture_output=True, preexec_fn=by_hand, check=True)
    assert done.stdout == "default_int_handler\n"


def by_hand():
    """As in a terminal; a job in the background ignores SIGINT."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


def test_many_packages_are_read_in_one_process(tmp_path, monkeypatch):
    monkeypatch.setattr(packages, "multiprocessing", None)  # and back afterwards
    amend_packages(packages)
    for number in range(101):
        (tmp_path / f"p{number}").mkdir()
        (tmp_path / f"p{number}/package.xml").write_text(
            f"<package><name>p{number}</name><version>1.0.0</version><description>-</description>"
            '<maintainer email="a@b.org">-</maintainer><license>-</license></package>')
    assert len(packages.find_packages(tmp_path)) == 101


def printed(code):
    """By a Python of its own."""
    return subprocess.check_output([sys.executable, "-c", code], text=True)


def test_every_program_reads_them_so():
    assert printed("import catkin_pkg.packages as p; print(type(p.multiprocessing).__name__)"
                   ) == "SimpleNamespace\n"


@pytest.mark.skipif(sys.version_info >= (3, 12), reason="Python has no distutils of its own")
def test_roslaunch_begins_without_setuptools():
    assert printed("import sys; sys.argv[0] = '/usr/bin/roslaunch'; import rosclean; "
                   "print('setuptools' in sys.modules, 'distutils' in sys.modules)"
                   ) == "False True\n"


def test_a_program_that_imports_roslaunch_keeps_its_setuptools():
    assert printed("import sys; sys.argv[0] = 'mine.py'; hack = sys.modules.get('_distutils_hack');"
                   " import rosclean; print(hack is None or hack.DISTUTILS_FINDER in sys.meta_path)"
                   ) == "True\n"


def test_rospy_begins_without_numpy_and_catkin_pkg_and_finds_them_later():
    before, package, fails, after = printed("""
import sys, rospy
from std_msgs.msg import Float64
print({'numpy', 'catkin_pkg.packages'} & {*sys.modules})
from catkin.find_in_workspaces import find_in_workspaces
print(find_in_workspaces(['share'], 'python_amendments'))
try:
    Float64('one')._check_types()
except Exception as error:
    print(type(error).__name__)
import numpy
Float64(numpy.float32(1))._check_types()
print(numpy.float32 in rospy.msg.genpy.message._valid_float_types)""").splitlines()
    assert (before, fails, after) == ("set()", "SerializationError", "True")
    assert package.count("/src/compat/python_amendments'") == 1


def test_packages_are_read_without_pyparsing_unless_one_has_a_condition():
    assert printed("""
import sys
from catkin_pkg.package import Dependency
from catkin.find_in_workspaces import find_in_workspaces
find_in_workspaces(['share'], 'python_amendments')
print('pyparsing' in sys.modules)
for condition in (None, '$A == 1', '$A == 2'):
    print(Dependency('b', condition=condition).evaluate_condition({'A': '1'}))""").split() == [
        "False", "True", "True", "False"]


def test_numpy_that_is_there_already_is_found_at_once():
    assert printed("import numpy, genpy.message as message; "
                   "print(message._valid_float_types.count(numpy.float64))") == "1\n"


GOES_ON = 3.0  # s


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return str(probe.getsockname()[1])


@pytest.fixture(params=[(), ("nohup",)], ids=["by_hand", "nohup"])
def nohup(request):
    return request.param


@pytest.fixture
def launched(nohup, tmp_path):
    """A roslaunch whose node has started."""
    begun, launch = tmp_path / "begun", tmp_path / "one.launch"
    prefix = f"sh -c 'touch {begun}; exec sleep 300'"
    launch.write_text(f'<launch><node name="a" pkg="rosout" type="rosout" '
                      f'launch-prefix="{prefix}"/></launch>', encoding="utf-8")
    process = subprocess.Popen(
        [*nohup, "roslaunch", "-p", free_port(), launch], stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
        env=os.environ | {"ROS_HOSTNAME": "localhost"})
    try:
        end = time.monotonic() + LIMIT
        while not begun.exists() and time.monotonic() < end:
            time.sleep(0.05)
        yield process
    finally:
        process.terminate()
        process.wait(LIMIT)


def test_only_with_nohup_it_outlives_its_terminal(launched, nohup):
    launched.send_signal(signal.SIGHUP)
    if nohup:
        with pytest.raises(subprocess.TimeoutExpired):
            launched.wait(GOES_ON)
    else:
        launched.wait(LIMIT)


def test_a_genpy_that_needs_numpy_gets_it():
    assert printed("""import sys, types
from python_amendments import quick_start
module = types.ModuleType("genpy.message")
def load(into):
    import numpy
    into.number = numpy.float64
quick_start.load_without(load, module)
print(module.number.__name__, "numpy" in sys.modules)""") == "float64 True\n"
