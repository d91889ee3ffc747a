"""The hooked cv2 functions without a ROS node: pixels, names, trackbars, when to step aside."""

import os
import pathlib
import subprocess
import sys
import threading
import time
import types

import numpy as np
import pytest
from python_amendments import cv_bridge_colours, no_screen, windows
from python_amendments.windows import Windows, ros_label

SOURCE = pathlib.Path(__file__).resolve().parents[1] / "src"
LANGUAGE = SOURCE.parents[2] / "interfaces/terminal_language/src"
BASICS = SOURCE.parents[2] / "interfaces/node_basics/src"


def fake_cv2(gui="NONE"):
    """Just enough of a cv2: what the hook asks of it, and functions that must not be called."""
    module = types.ModuleType("cv2")
    module.getBuildInformation = lambda: f"General:\n  GUI:                           {gui}\n"
    module.error = type("error", (Exception,), {})
    module.WND_PROP_VISIBLE = 4
    for name in no_screen.FUNCTIONS:
        setattr(module, name, None)
    return module


def run_python(code, env=None, path=(SOURCE, LANGUAGE, BASICS)):
    """Run code in a fresh Python that has only these folders on PYTHONPATH."""
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, path)), **(env or {})}
    return subprocess.run(
        [sys.executable, "-c", code], env=env, capture_output=True, text=True, timeout=60
    )


@pytest.mark.parametrize(
    ("gui", "display", "steps_aside"),
    [("GTK3", ":0", True), ("QT5", ":0", True), ("GTK3", "", False), ("NONE", ":0", False)],
)
def test_steps_aside_only_with_gui_and_display(monkeypatch, gui, display, steps_aside):
    monkeypatch.setenv("DISPLAY", display)
    cv2 = fake_cv2(gui)
    assert no_screen.amend_cv2(cv2) is not steps_aside
    assert (cv2.imshow is None) is steps_aside


def test_every_hooked_function_is_there():
    cv2 = fake_cv2()
    os.environ.pop("DISPLAY", None)
    no_screen.amend_cv2(cv2)
    assert all(callable(getattr(cv2, name)) for name in no_screen.FUNCTIONS)


@pytest.mark.parametrize(
    ("value", "dtype", "shown"),
    [
        (200, np.uint8, 200),
        (-128, np.int8, 0),
        (0x8000, np.uint16, 128),
        (0xFFFF, np.uint16, 255),
        (0, np.int16, 128),
        (0.5, np.float32, 128),
        (1.5, np.float64, 255),
        (-1.0, np.float32, 0),
        (np.nan, np.float32, 0),
        (np.inf, np.float32, 255),
    ],
)
def test_pixels_become_what_imshow_would_show(value, dtype, shown):
    image = np.full((2, 3), value, dtype)
    assert windows.to_8_bit(image).dtype == np.uint8
    assert (windows.to_8_bit(image) == shown).all()


def test_8_bit_pixels_are_not_copied():
    image = np.zeros((2, 3, 3), np.uint8)
    assert windows.to_8_bit(image) is image


@pytest.mark.parametrize(
    ("shape", "encoding"),
    [((2, 5), "mono8"), ((2, 5, 1), "mono8"), ((2, 5, 3), "bgr8"), ((2, 5, 4), "bgra8")],
)
def test_message_says_size_step_and_encoding(shape, encoding):
    image = np.arange(np.prod(shape), dtype=np.uint8).reshape(shape)
    msg = windows.to_msg(image, stamp=None)
    assert (msg.height, msg.width, msg.encoding) == (2, 5, encoding)
    assert msg.step * msg.height == len(msg.data)
    assert msg.data == image.tobytes()


def test_a_slice_is_sent_in_rows():
    image = np.arange(60, dtype=np.uint8).reshape(4, 5, 3)[:, ::2]
    assert windows.to_msg(image, stamp=None).data == image.tobytes()


@pytest.mark.parametrize(
    ("image", "says"),
    [
        (None, "None"),
        ([[1]], "numpy array"),
        (np.zeros((0, 4), np.uint8), "empty"),
        (np.zeros((4, 4, 2), np.uint8), "(4, 4, 2)"),
        (np.zeros((4, 4), np.int64), "int64"),
        (np.zeros((4, 4), bool), "bool"),
    ],
)
def test_what_imshow_refuses_raises_cv2_error_with_the_window(image, says):
    cv2 = fake_cv2()
    with pytest.raises(cv2.error) as raised:
        Windows(cv2).imshow("mask", image)
    assert says in str(raised.value) and "'mask'" in str(raised.value)


def test_window_names_become_legal_ros_names():
    taken = []
    for name in ("showImage", "my window!", "图像", "掩膜", "2nd", "_x"):
        taken.append(ros_label(name, taken))
    assert taken == ["showImage", "my_window", "window", "window_2", "window_2nd", "x"]


def test_nothing_is_converted_without_a_node(monkeypatch):
    monkeypatch.setattr(windows, "to_msg", lambda *_: pytest.fail("converted"))
    monkeypatch.setattr(windows, "running_rospy", lambda: None)
    Windows(fake_cv2()).imshow("w", np.zeros((4, 4), np.uint8))


class FakePublisher:
    """Counts what is published, with as many subscribers as a test says."""

    def __init__(self, name, _msg_class, subscriber_listener, queue_size):
        self.resolved_name, self.listener = name.replace("~", "/node/"), subscriber_listener
        self.subscribers, self.sent = 0, []
        self.thread = threading.current_thread()
        self.publish = self.sent.append

    def get_num_connections(self):
        return self.subscribers


def test_pictures_are_converted_for_subscribers_only(monkeypatch):
    said = []
    rospy = types.SimpleNamespace(
        Publisher=FakePublisher,
        Time=types.SimpleNamespace(now=lambda: None),
        is_shutdown=lambda: False,
        loginfo=lambda text, *args: said.append(text % args),
        ROSException=RuntimeError,
    )
    converted = []
    monkeypatch.setattr(windows, "running_rospy", lambda: rospy)
    monkeypatch.setattr(windows, "to_msg", lambda image, _stamp: converted.append(image))
    window = windows.WindowTopic("w")
    window.show("picture 1")
    window.show("picture 2")
    assert converted == [] and window.publisher.sent == []
    assert len(said) == 1 and "/node/windows/w" in said[0]
    # There Ctrl-C would wait for ever for the call to the master that it interrupts.
    assert window.publisher.thread is not threading.main_thread()
    window.peer_subscribe("w", None, lambda _msg: None)
    assert converted == ["picture 2"]
    window.publisher.subscribers = 1
    window.show("picture 3")
    assert converted == ["picture 2", "picture 3"]


def test_threads_that_show_one_window_open_one_topic(monkeypatch):
    made = []

    def publisher(*args, **named):
        time.sleep(0.05)
        made.append(FakePublisher(*args, **named))
        return made[-1]

    rospy = types.SimpleNamespace(Publisher=publisher, is_shutdown=lambda: False,
                                  loginfo=lambda *_: None, ROSException=RuntimeError)
    monkeypatch.setattr(windows, "running_rospy", lambda: rospy)
    window = windows.WindowTopic("w")
    threads = [threading.Thread(target=window.show, args=("picture",)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(made) == 1


def test_wait_key_waits_as_long_as_asked():
    start = time.monotonic()
    assert Windows(fake_cv2()).waitKey(50) == -1
    assert 0.05 <= time.monotonic() - start < 20.0


def test_wait_key_0_returns_when_the_node_is_shut_down(monkeypatch):
    answers = iter([False, False, True])
    said = []
    rospy = types.SimpleNamespace(is_shutdown=lambda: next(answers), logwarn=said.append)
    monkeypatch.setattr("python_amendments.windows.running_rospy", lambda: rospy)
    assert Windows(fake_cv2()).waitKey(0) == -1
    assert len(said) == 1 and "Ctrl-C" in said[0]


def test_windows_are_visible_until_destroyed():
    cv2 = fake_cv2()
    windows = Windows(cv2)
    windows.namedWindow("w", 0)
    assert windows.getWindowProperty("w", cv2.WND_PROP_VISIBLE) == 1
    windows.imshow("w", np.zeros((4, 6), np.uint8))
    assert windows.getWindowImageRect("w") == (0, 0, 6, 4)
    windows.destroyAllWindows()
    assert windows.getWindowProperty("w", cv2.WND_PROP_VISIBLE) == -1


def test_trackbars_keep_their_value_and_limits():
    windows, heard = Windows(fake_cv2()), []
    windows.createTrackbar("low", "w", 20, 180, heard.append)
    assert windows.getTrackbarPos("low", "w") == 20 and heard == []
    windows.setTrackbarPos("low", "w", 999)
    windows.setTrackbarPos("low", "w", 999)
    assert windows.getTrackbarPos("low", "w") == 180 and heard == [180]
    windows.setTrackbarMax("low", "w", 100)
    assert windows.getTrackbarPos("low", "w") == 100
    assert windows.getTrackbarPos("high", "w") == -1


def test_accepted_calls_do_nothing():
    windows = Windows(fake_cv2())
    windows.setMouseCallback("w", print, None)
    windows.resizeWindow("w", 640, 480)
    windows.moveWindow("w", 0, 0)
    windows.setWindowTitle("w", "title")


@pytest.mark.parametrize("line", ["import cv2", "from cv2 import imshow; import cv2"])
def test_an_unchanged_script_runs_with_the_real_cv2(line):
    code = (
        f"{line}; import numpy as np\n"
        "cv2.namedWindow('w', cv2.WINDOW_NORMAL); cv2.imshow('w', np.zeros((4, 4), np.uint8))\n"
        "print(cv2.waitKey(3)); cv2.destroyAllWindows()\n"
        "print(cv2.imshow.__module__, cv2.cvtColor(np.zeros((1, 1, 3), np.uint8), 6).shape)"
    )
    done = run_python(code, {"DISPLAY": ""})
    assert done.returncode == 0, done.stderr
    assert done.stdout.split("\n")[:2] == ["-1", "python_amendments.windows (1, 1)"]
    assert done.stderr.count("\n") == 1 and "no screen" in done.stderr


def test_python_without_cv2_loads_nothing_more():
    code = (
        "import sys, json\n"
        "print([m for m in sys.modules "
        "if m.startswith(('python_amendments', 'cv2', 'numpy', 'rospy'))])"
    )
    done = run_python(code)
    assert done.stdout.strip() == "[]" and done.stderr == ""


def test_a_module_is_watched_for_once():
    code = ("import usercustomize as u; import cv2; "
            "print({*u.AMENDMENTS, *u.QUICK} - u.Watch.waited_for)")
    assert run_python(code, {"DISPLAY": ""}).stdout.strip() in (
        "{'cv2', 'numpy'}", "{'numpy', 'cv2'}")


def test_a_missing_cv2_is_still_an_import_error(tmp_path):
    code = "import sys; sys.path = [sys.path[1]]\ntry: import cv2\nexcept ImportError: print('no')"
    done = run_python(code)
    assert done.stdout.strip() == "no", done.stderr


def test_a_broken_hook_does_not_break_cv2(tmp_path):
    (tmp_path / "python_amendments").mkdir()
    (tmp_path / "python_amendments" / "no_screen.py").write_text("raise RuntimeError('broken')")
    (tmp_path / "usercustomize.py").write_text((SOURCE / "usercustomize.py").read_text())
    done = run_python("import cv2; print(cv2.__name__)", path=[tmp_path])
    assert done.stdout.strip() == "cv2" and "broken" in done.stderr


def test_a_persons_own_usercustomize_still_runs(tmp_path):
    (tmp_path / "usercustomize.py").write_text("import sys; sys.hello = 'still here'")
    done = run_python("import sys; print(sys.hello)", path=[SOURCE, LANGUAGE, tmp_path])
    assert done.stdout.strip() == "still here", done.stderr


ENGLISH, CHINESE = ({"LC_ALL": "", "LANG": "C.UTF-8", "LANGUAGE": each} for each in ("en", "zh_CN"))


@pytest.mark.parametrize(("display", "language", "why", "drives"), [
    (None, ENGLISH, "no display name and no $DISPLAY environment variable; ", "type make drive"),
    (":7654", ENGLISH, """couldn't connect to display ":7654"; keys""", "type make drive"),
    (None, CHINESE, "没有设置环境变量 DISPLAY; 没有屏幕", "输入 make drive"),
    (":7654", CHINESE, '连接不上显示器 ":7654"; 没有屏幕', "输入 make drive")])
def test_a_keyboard_script_without_a_screen_ends_with_what_drives(
        tmp_path, monkeypatch, display, language, why, drives):
    monkeypatch.delenv("DISPLAY", raising=False)
    script = tmp_path / "keys.py"
    script.write_text("from tkinter import *\nimport tkinter as tk\ntk.Tk()")
    done = run_python(f"import runpy, sys; sys.argv = ['{script}']; runpy.run_path('{script}')",
                      language | ({"DISPLAY": display} if display else {}))
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"keys.py: {why}") and drives in line
    assert line.endswith("roslaunch sim_viewer viewer.launch control:=true")
    assert done.returncode == 1


def test_the_error_of_a_window_can_be_caught():
    done = run_python("import tkinter\ntry: tkinter.Tk()\nexcept tkinter.TclError: print('no')",
                      {"DISPLAY": ""})
    assert (done.stdout, done.stderr) == ("no\n", "")


def test_windows_with_words_of_their_own_keep_them():
    done = run_python("import tkinter\ntkinter.Tk(className='turtlesim')", {"DISPLAY": ""})
    assert done.stderr.splitlines()[-1].endswith('display ""')


BRIDGE = """
import numpy as np
from cv_bridge import CvBridge
from cv_bridge.boost import cv_bridge_boost as boost
from sensor_msgs.msg import Image
print("theirs", type(boost.cvtColor2).__module__ != "builtins")
random = np.random.default_rng(1)
for encoding, channels, kind in (("rgb8", 3, "u1"), ("bgr8", 3, "u1"), ("mono8", 1, "u1"),
                                 ("rgba8", 4, "u1"), ("rgb16", 3, "u2"), ("bgr16", 3, "u2")):
    pixels = random.integers(0, 256, (5, 7, channels)).astype(kind)
    msg = Image(height=5, width=7, encoding=encoding, step=pixels.nbytes // 5,
                data=pixels.tobytes())
    for wanted in ("bgr8", "rgb8", "mono8", "passthrough"):
        found = CvBridge().imgmsg_to_cv2(msg, wanted)
        print(encoding, wanted, found.dtype, found.shape, found.flags.writeable, found.tobytes())
try:
    CvBridge().imgmsg_to_cv2(msg, "no such encoding")
except Exception as error:
    print(type(error).__name__, error)
"""


def test_cv_bridge_converts_as_without_us():
    """To the last bit, whatever the encodings; and where it swaps red and blue, OpenCV does it."""
    path = os.environ["PYTHONPATH"].split(os.pathsep)
    ours = run_python(BRIDGE, path=(SOURCE, LANGUAGE, *path))
    plain = run_python(BRIDGE, env={"PYTHONNOUSERSITE": "1"},
                       path=[each for each in path if not (pathlib.Path(each)
                                                           / "usercustomize.py").exists()])
    for done in (ours, plain):
        assert done.returncode == 0, done.stderr
    assert ours.stdout.startswith("theirs False") and plain.stdout.startswith("theirs True")
    assert ours.stdout.splitlines()[1:] == plain.stdout.splitlines()[1:]


def test_only_red_and_blue_of_eight_bits_are_swapped_by_opencv(monkeypatch):
    asked = []
    boost = types.SimpleNamespace(cvtColor2=lambda *given: asked.append(given[1:]))
    monkeypatch.setitem(sys.modules, "cv2", types.SimpleNamespace(
        COLOR_RGB2BGR=4, cvtColor=lambda image, _code: image[..., ::-1]))
    cv_bridge_colours.amend(boost)
    image = np.arange(24, dtype=np.uint8).reshape(2, 4, 3)
    for pair in (("rgb8", "bgr8"), ("bgr8", "rgb8")):
        assert np.array_equal(boost.cvtColor2(image, *pair), image[..., ::-1])
    assert not asked
    for other, *pair in ((image, "rgb8", "mono8"), (image, "rgb8", "rgb8"),
                         (image.astype(np.uint16), "rgb8", "bgr8"), (image[..., 0], "rgb8", "bgr8"),
                         (image[:0], "rgb8", "bgr8"), (image[..., :2], "rgb8", "bgr8")):
        boost.cvtColor2(other, *pair)
    assert len(asked) == 6
