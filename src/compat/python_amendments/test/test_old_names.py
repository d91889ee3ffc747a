"""Names that older libraries had: each works, and one line says what to write."""

import site
import subprocess
import sys
import types
from pathlib import Path

import pytest
from python_amendments import old_names

SOURCE = Path(__file__).resolve().parents[1] / "src"
LANGUAGE = SOURCE.parents[2] / "interfaces/terminal_language/src"
IMAGE = "import cv2, numpy as np; image = np.zeros((9, 9), np.uint8); image[2:5, 2:5] = 255\n"
CONTOURS = "cv2.findContours(image, cv2.RETR_TREE, cv2.CHAIN_APPROX_SIMPLE)"
MARKER = (IMAGE + "d = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)\n"
          "image = np.full((400, 400), 255, np.uint8)\n"
          "image[100:300, 100:300] = cv2.aruco.generateImageMarker(d, 7, 200)\n")
ESTIMATE = ("found = cv2.aruco.ArucoDetector(d).detectMarkers(image)[0]\n"
            "r, t, _ = cv2.aruco.estimatePoseSingleMarkers(\n"
            "    found, 0.1, np.array([[400, 0, 200], [0, 400, 200], [0, 0, 1.0]]), np.zeros(5))\n"
            "print(r.shape, t.round(2).ravel().tolist())")
SCRIPTS = {  # code: what it prints, the new form
    "import numpy as np; print(np.float(3))": ("3.0", "numpy.float is an old name: write float"),
    "import numpy as np; print(np.zeros(1, dtype=np.int))": ("[0]", "write int"),
    "from numpy import object as o; print(o)": ("<class 'object'>", "write object"),
    "import numpy as np; print(np.asscalar(np.array([4])))": ("4", "write array.item()"),
    "from collections import Iterable; print(isinstance([], Iterable))": (
        "True", "write collections.abc.Iterable"),
    "import collections; print(collections.Mapping.__name__)": ("Mapping", "collections.abc"),
    "import time; print(time.clock() > 0)": ("True", "write time.perf_counter"),
    "import yaml; print(yaml.load('a: 1'))": ("{'a': 1}", "write yaml.safe_load(text)"),
    "import yaml; print(list(yaml.load_all('a')))": ("['a']", "write yaml.safe_load_all(text)"),
    IMAGE + f"_, contours, _ = {CONTOURS}; print(len(contours))": (
        "1", "write contours, hierarchy = cv2.findContours(...)"),
    IMAGE + "print(cv2.CV_AA == cv2.LINE_AA)": ("True", "write cv2.LINE_AA"),
    IMAGE + "print(cv2.xfeatures2d.SIFT_create() is not None)": ("True", "cv2.SIFT_create()"),
    IMAGE + "print('MIL' in str(cv2.TrackerKCF_create()))": ("True", "cv2.TrackerMIL_create()"),
    IMAGE + "print('MIL' in str(cv2.legacy.TrackerCSRT_create()))": ("True", "TrackerMIL"),
    IMAGE + "print('MIL' in str(cv2.Tracker_create('KCF')))": ("True", "TrackerMIL"),
    MARKER + "d = cv2.aruco.Dictionary_get(0); print(d.markerSize)": (
        "4", "write cv2.aruco.getPredefinedDictionary"),
    MARKER + "print(cv2.aruco.DetectorParameters_create() is not None)": (
        "True", "write cv2.aruco.DetectorParameters()"),
    MARKER + "print(cv2.aruco.detectMarkers(image, d)[1].ravel())": (
        "[7]", "write cv2.aruco.ArucoDetector(dictionary, parameters).detectMarkers(image)"),
    MARKER + "print(cv2.aruco.drawMarker(d, 7, 50).shape)": ("(50, 50)", "generateImageMarker"),
    MARKER + ESTIMATE: ("(1, 1, 3) [-0.0, -0.0, 0.2]", "cv2.solvePnP"),
    MARKER + "print(cv2.aruco.GridBoard_create(2, 3, 1, 0.1, d).getGridSize())": (
        "(2, 3)", "GridBoard((columns, rows), ...)"),
    MARKER + "print(cv2.aruco.CharucoBoard_create(3, 4, 1, 0.5, d).getChessboardSize())": (
        "(3, 4)", "CharucoBoard((columns, rows), ...)"),
}


def run(tmp_path, code, name="old.py"):
    script = tmp_path / name
    script.write_text(code)
    environment = {"PYTHONPATH": f"{SOURCE}:{LANGUAGE}", "HOME": str(Path.home())}
    return subprocess.run([sys.executable, script], env=environment, text=True,
                          capture_output=True, timeout=100)


@pytest.mark.parametrize("code", SCRIPTS, ids=lambda code: code.splitlines()[-1][:40])
def test_an_old_name(tmp_path, code):
    shown, new = SCRIPTS[code]
    done = run(tmp_path, code)
    assert (done.stdout.strip(), done.returncode) == (shown, 0), done.stderr
    lines = [line for line in done.stderr.splitlines() if "is an old name: write" in line]
    assert lines and all(line.startswith(f"{tmp_path}/old.py:") for line in lines)
    assert new in lines[-1]


def test_the_scripts_line_is_named_where_python_starts_with_a_link(tmp_path):
    (tmp_path / "devel").mkdir()
    (tmp_path / "devel/usercustomize.py").symlink_to(SOURCE / "usercustomize.py")
    script = tmp_path / "old.py"
    script.write_text("import collections\ncollections.Iterable\n")
    done = subprocess.run([sys.executable, script], text=True, capture_output=True, timeout=100,
                          env={"PYTHONPATH": f"{tmp_path}/devel:{SOURCE}:{LANGUAGE}"})
    assert done.stderr.startswith(f"{script}:2: ")


def test_it_is_said_once(tmp_path):
    done = run(tmp_path, "import numpy as np\nfor _ in range(3):\n    np.float(1)\n")
    assert done.stderr.count("is an old name") == 1


def test_it_is_said_in_the_language_of_the_locale(monkeypatch, capsys):
    monkeypatch.delenv("LC_ALL", raising=False)
    monkeypatch.setenv("LANG", "C.UTF-8")
    monkeypatch.setenv("LANGUAGE", "zh_CN")
    old_names.tell("numpy.spam", "numpy.eggs", sys._getframe())
    assert capsys.readouterr().err.endswith("numpy.spam 是旧名字：请写 numpy.eggs\n")


@pytest.mark.parametrize(("words", "typed"), [(["-c"], "<string>:1"), (["-"], "<stdin>:1")])
def test_it_is_said_so_without_a_file_too(words, typed):
    code = "import collections; collections.Iterable"
    done = subprocess.run(
        [sys.executable, *words, *([code] if "-c" in words else [])], input=code, text=True,
        capture_output=True, timeout=100, check=True,
        env={"PYTHONPATH": f"{SOURCE}:{LANGUAGE}", "LANG": "C.UTF-8", "LANGUAGE": "zh_CN"})
    assert done.stderr == (
        f"{typed}：collections.Iterable 是旧名字：请写 collections.abc.Iterable\n")


@pytest.mark.parametrize("code", [
    IMAGE + f"contours, hierarchy = {CONTOURS}; print(len(contours))",
    IMAGE + f"contours = {CONTOURS}[-2]; print(len(contours))",
    "import yaml; print(len(yaml.load('a: 1', yaml.SafeLoader)))"])
def test_the_new_form_stays_quiet(tmp_path, code):
    done = run(tmp_path, code)
    assert (done.stdout, done.stderr) == ("1\n", "")


@pytest.mark.parametrize("asked", ["collections.nonsense", "time.nonsense", "numpy.nonsense",
                                   "cv2.nonsense", "cv2.aruco.nonsense"])
def test_what_there_never_was_is_an_error_as_before(tmp_path, asked):
    module, _, name = asked.rpartition(".")
    done = run(tmp_path, f"import {module.partition('.')[0]}; {asked}")
    assert f"AttributeError: module {module!r} has no attribute {name!r}" in done.stderr


@pytest.mark.parametrize("prefix", [sys.prefix, "/usr", "/usr/local", site.getuserbase()])
def test_a_library_sees_the_names_that_there_are(tmp_path, prefix):
    library = f"{prefix}/lib/python3/dist-packages/library.py"
    code = (f"exec(compile('import collections, numpy; "
            f"print(hasattr(numpy, \"float\"), hasattr(collections, \"Iterable\"))', "
            f"{library!r}, 'exec'))")
    done = run(tmp_path, code)
    assert (done.stdout, done.stderr) == ("False False\n", "")


def test_zeros_of_the_joint_state_publisher():
    """As one dictionary, also for names that are no names of parameters."""
    parameters = {"zeros": {"wrist/left": 0.3, "elbow": 0.5}, "rate": 10}
    module = types.ModuleType("joint_state_publisher")
    module.get_param = lambda name, value=None: parameters.get(name, value)
    old_names.amend_joint_state_publisher(module)
    asked = ["zeros/wrist/left", "zeros/elbow", "zeros/other", "rate"]
    assert [module.get_param(name) for name in asked] == [0.3, 0.5, None, 10]
    parameters.clear()
    assert module.get_param("zeros/elbow") is None
    with pytest.raises(SystemExit, match="there is no robot_description; start the simulator"):
        module.get_param("robot_description")
