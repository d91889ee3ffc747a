"""OpenCV's window functions under their own names, without a screen."""

import logging
import re
import threading
import time

from terminal_language import translated

from headless_highgui.pixels import why_not_shown
from headless_highgui.window_topic import WindowTopic, running_rospy

NO_KEY = -1
log = logging.getLogger(__name__)


def ros_label(name, taken):
    """A legal ROS name for a window's name (it may be Chinese or have spaces), not yet taken."""
    label = re.sub(r"[^A-Za-z0-9_]+", "_", name).strip("_")
    if not re.match(r"[A-Za-z]", label):
        label = f"window_{label}".strip("_")
    unique, count = label, 1
    while unique in taken:
        count += 1
        unique = f"{label}_{count}"
    return unique


class Windows:
    """All windows of one process. Any thread may call; arguments are those of OpenCV."""

    def __init__(self, cv2):
        self._cv2 = cv2
        self._labels = {}  # window name: label; kept, so a window that comes back keeps its topic
        self._open = {}  # window name: WindowTopic
        self._trackbars = {}  # (window name, trackbar name): [value, least, greatest, on_change]
        self._logged = set()
        self._lock = threading.RLock()

    def namedWindow(self, winname, flags=None):
        self._window(winname)

    def imshow(self, winname, mat):
        problem = why_not_shown(mat)
        if problem:
            raise self._cv2.error(f"imshow('{winname}'): {problem}")
        if running_rospy() is None:
            self._tell("no screen and no ROS node: windows are not shown")
        self._window(winname).show(mat)

    def waitKey(self, delay=0):
        if delay > 0:
            time.sleep(delay / 1000)
            return NO_KEY
        self._tell("no screen, so no key: waitKey(0) waits until this script is stopped (Ctrl-C)")
        rospy = running_rospy()
        while rospy is None or not rospy.is_shutdown():
            time.sleep(0.1)
        return NO_KEY

    waitKeyEx = waitKey

    def pollKey(self):
        return NO_KEY

    def destroyWindow(self, winname):
        with self._lock:
            window = self._open.pop(winname, None)
            self._trackbars = {k: bar for k, bar in self._trackbars.items() if k[0] != winname}
        if window is not None:
            window.close()

    def destroyAllWindows(self):
        for winname in list(self._open):
            self.destroyWindow(winname)

    def getWindowProperty(self, winname, prop_id):
        if winname not in self._open:
            return -1.0
        return 1.0 if prop_id == self._cv2.WND_PROP_VISIBLE else 0.0

    def getWindowImageRect(self, winname):
        window = self._open.get(winname)
        if window is None or window.image is None:
            return (-1, -1, -1, -1)
        height, width = window.image.shape[:2]
        return (0, 0, width, height)

    def createTrackbar(self, trackbarName, windowName, value, count, onChange):
        self.namedWindow(windowName)
        self._trackbars[windowName, trackbarName] = [value, 0, count, onChange]

    def getTrackbarPos(self, trackbarname, winname):
        bar = self._trackbars.get((winname, trackbarname))
        return -1 if bar is None else bar[0]

    def setTrackbarPos(self, trackbarname, winname, pos):
        bar = self._trackbars.get((winname, trackbarname))
        if bar is None:
            return
        value = max(bar[1], min(bar[2], pos))
        changed, bar[0] = value != bar[0], value
        if changed and bar[3] is not None:
            bar[3](value)

    def setTrackbarMin(self, trackbarname, winname, minval):
        self._set_limit(trackbarname, winname, 1, minval)

    def setTrackbarMax(self, trackbarname, winname, maxval):
        self._set_limit(trackbarname, winname, 2, maxval)

    def _accept(self, *_args, **_kwargs):
        """There is no mouse, no title bar, nowhere to move to: taken, without effect."""

    setMouseCallback = resizeWindow = moveWindow = setWindowTitle = _accept
    setWindowProperty = startWindowThread = _accept

    def _window(self, winname):
        with self._lock:
            if winname not in self._open:
                if winname not in self._labels:
                    self._labels[winname] = ros_label(winname, self._labels.values())
                self._open[winname] = WindowTopic(self._labels[winname])
            return self._open[winname]

    def _set_limit(self, trackbarname, winname, which, limit):
        bar = self._trackbars.get((winname, trackbarname))
        if bar is not None:
            bar[which] = limit
            self.setTrackbarPos(trackbarname, winname, bar[0])

    def _tell(self, line):
        if line not in self._logged:
            self._logged.add(line)
            rospy = running_rospy()
            (log.warning if rospy is None else rospy.logwarn)(translated(line))
