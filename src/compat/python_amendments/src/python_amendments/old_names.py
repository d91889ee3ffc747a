"""Names that older libraries had, put back where they mean the same: one warning each.

Melodic's and Noetic's scripts were written for NumPy 1.13 to 1.17, OpenCV 3 and 4.2, PyYAML 3 to
5.3 and Python up to 3.8. A library's own code is not helped: it asks which names there are.
"""

import collections
import collections.abc
import dis
import functools
import os
import site
import sys
import time

from terminal_language import translated

HERE = (__file__, f"{os.path.dirname(os.path.dirname(__file__))}/usercustomize.py")
LIBRARIES = tuple(f"{prefix}/lib/python3" for prefix in {  # the latter two: pip's, without a venv
    sys.prefix, sys.base_prefix, f"{sys.base_prefix}/local", site.getuserbase()})
NUMPY_BUILTINS = {"float": float, "int": int, "bool": bool, "object": object, "str": str,
                  "complex": complex, "long": int, "unicode": str}
NUMPY_NAMES = {  # old: new, where NumPy 1.24, 2.0 or a later one has dropped it
    "float_": "float64", "complex_": "complex128", "string_": "bytes_", "unicode_": "str_",
    "bool8": "bool_", "NaN": "nan", "NAN": "nan", "Inf": "inf", "Infinity": "inf", "infty": "inf",
    "PINF": "inf", "product": "prod", "cumproduct": "cumprod", "sometrue": "any", "alltrue": "all",
    "in1d": "isin", "row_stack": "vstack", "trapz": "trapezoid", "round_": "round",
    "mat": "asmatrix"}
CV2_NAMES = {"CV_AA": "LINE_AA", "CV_LOAD_IMAGE_COLOR": "IMREAD_COLOR",
             "CV_LOAD_IMAGE_GRAYSCALE": "IMREAD_GRAYSCALE"}
TRACKERS = "Boosting CSRT KCF MOSSE MedianFlow TLD".split()
_told = set()


def caller():
    """The frame of the script that asks: not of these files, nor of the import system."""
    frame = sys._getframe(1)
    while frame.f_back and (frame.f_code.co_filename in HERE
                            or frame.f_code.co_filename.startswith("<frozen importlib")):
        frame = frame.f_back
    return frame


def tell(old, new, frame):
    """Once for each old name: where it is, and what to write."""
    if old in _told:
        return
    _told.add(old)
    where = f"{frame.f_code.co_filename}:{frame.f_lineno}"
    print(translated(f"{where}: {old} is an old name: write {new}"), file=sys.stderr, flush=True)


def put_back(module, find):
    """Lets `find(name)` answer for names that a module lacks: (value, new name) or None."""
    asked = module.__dict__.get("__getattr__")

    def __getattr__(name):
        frame = caller()
        found = None if frame.f_code.co_filename.startswith(LIBRARIES) else find(name)
        if found is not None:
            tell(f"{module.__name__}.{name}", found[1], frame)
            return found[0]
        if asked is not None:
            return asked(name)
        raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")

    module.__getattr__ = __getattr__


def amend_standard():
    """collections.Iterable and its like, time.clock; both modules are there before any script."""
    put_back(collections, lambda name: (getattr(collections.abc, name), f"collections.abc.{name}")
             if name in collections.abc.__all__ else None)
    put_back(time, lambda name: (time.perf_counter, "time.perf_counter") if name == "clock"
             else None)


def amend_numpy(numpy):
    def find(name):
        if name in NUMPY_BUILTINS:
            return NUMPY_BUILTINS[name], NUMPY_BUILTINS[name].__name__
        if name == "asscalar":
            return (lambda array: array.item()), "array.item()"
        if name == "NINF":
            return -numpy.inf, "-numpy.inf"
        new = NUMPY_NAMES.get(name)
        there = new is not None and new in numpy.__dict__
        return (getattr(numpy, new), f"numpy.{new}") if there else None

    put_back(numpy, find)


def amend_yaml(yaml):
    """yaml.load(text) without a Loader, as before PyYAML 6; the safe half of what it did."""
    for name in ("load", "load_all"):
        def load(stream, Loader=None, call=getattr(yaml, name), name=name):
            if Loader is None:
                tell(f"yaml.{name}(text) without a Loader", f"yaml.safe_{name}(text)", caller())
                Loader = yaml.FullLoader
            return call(stream, Loader)

        setattr(yaml, name, load)


def amend_joint_state_publisher(module):
    """~zeros may be one dictionary, for joints of any name, as in later releases.

    A robot that is not there is a line instead of a traceback.
    """
    get_param = module.get_param

    @functools.wraps(get_param)
    def from_dictionary(name, value=None):
        if name.startswith("zeros/"):
            return (get_param("zeros") or {}).get(name.removeprefix("zeros/"), value)
        found = get_param(name, value)
        if found is None and name == "robot_description":
            sys.exit(translated("joint_state_publisher: there is no robot_description; start the "
                                "simulator, or the launch file that loads the robot, first"))
        return found

    module.get_param = from_dictionary


def amend_cv2(cv2):
    """Contours as OpenCV 3 returned them, ArUco as before 4.7, trackers of the contrib package."""
    find_contours, unpacks = cv2.findContours, functools.lru_cache(unpacked_into)

    @functools.wraps(find_contours)
    def findContours(image, *args, **kwargs):
        found, frame = find_contours(image, *args, **kwargs), sys._getframe(1)
        if unpacks(frame.f_code, frame.f_lasti) != 3:
            return found
        tell("image, contours, hierarchy = cv2.findContours(...)",
             "contours, hierarchy = cv2.findContours(...)", frame)
        return (image, *found)

    cv2.findContours = findContours

    def find(name):
        if name == "xfeatures2d":
            return cv2, "cv2.SIFT_create()"
        if name == "legacy":
            return cv2, "cv2.TrackerMIL_create()"
        if name == "Tracker_create":
            return (lambda _kind: cv2.TrackerMIL_create()), "cv2.TrackerMIL_create()"
        if name in [f"Tracker{kind}_create" for kind in TRACKERS]:
            return cv2.TrackerMIL_create, (
                "cv2.TrackerMIL_create(), which tracks in its place and is slower: the other one "
                "is in opencv-contrib-python, which is not installed here")
        new = CV2_NAMES.get(name)
        return (getattr(cv2, new), f"cv2.{new}") if new else None

    put_back(cv2, find)
    if hasattr(cv2, "aruco"):
        put_back(cv2.aruco, lambda name: aruco_names(cv2).get(name))


def unpacked_into(code, offset):
    """Into how many names the call at this offset of the code is unpacked; 0 if it is not."""
    after = [each for each in dis.get_instructions(code) if each.offset > offset][:1]
    return after[0].arg if after and after[0].opname == "UNPACK_SEQUENCE" else 0


def aruco_names(cv2):
    """Old name -> (function, what to write)."""
    aruco = cv2.aruco

    def detect(image, dictionary, corners=None, ids=None, parameters=None, **_unused):
        return aruco.ArucoDetector(dictionary, parameters or aruco.DetectorParameters()
                                   ).detectMarkers(image)

    def draw_axis(image, matrix, distortion, rotation, translation, length):
        return cv2.drawFrameAxes(image, matrix, distortion, rotation, translation, length)

    def estimate(corners, side, matrix, distortion):
        """Rotation and translation (n, 1, 3) of each marker, in the camera's frame; its points."""
        import numpy as np

        half = side / 2
        points = np.array([(-half, half, 0), (half, half, 0), (half, -half, 0), (-half, -half, 0)],
                          np.float64).reshape(4, 1, 3)
        poses = [cv2.solvePnP(points, each, matrix, distortion)[1:] for each in corners]
        return (*(np.array([pose[which].reshape(1, 3) for pose in poses]) for which in (0, 1)),
                points)

    def grid(columns, rows, side, gap, dictionary, *_first):
        return aruco.GridBoard((columns, rows), side, gap, dictionary)

    def charuco(columns, rows, square, side, dictionary):
        return aruco.CharucoBoard((columns, rows), square, side, dictionary)

    return {
        "Dictionary_get": (aruco.getPredefinedDictionary, "cv2.aruco.getPredefinedDictionary"),
        "DetectorParameters_create": (aruco.DetectorParameters, "cv2.aruco.DetectorParameters()"),
        "detectMarkers": (detect, "cv2.aruco.ArucoDetector(dictionary, parameters)"
                                  ".detectMarkers(image)"),
        "drawMarker": (aruco.generateImageMarker, "cv2.aruco.generateImageMarker"),
        "drawAxis": (draw_axis, "cv2.drawFrameAxes"),
        "estimatePoseSingleMarkers": (estimate, "cv2.solvePnP for each marker"),
        "GridBoard_create": (grid, "cv2.aruco.GridBoard((columns, rows), ...)"),
        "CharucoBoard_create": (charuco, "cv2.aruco.CharucoBoard((columns, rows), ...)"),
    }
