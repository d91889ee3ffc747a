"""OpenCV's window functions under their own names, without a screen: windows are image topics."""

import logging
import re
import sys
import threading
import time

import numpy as np
from terminal_language import translated

ENCODINGS = {1: "mono8", 3: "bgr8", 4: "bgra8"}
# dtype: (factor, offset), as OpenCV's imshow documents and does it.
SCALES = {
    "uint8": (1, 0),
    "int8": (1, 128),
    "uint16": (1 / 256, 0),
    "int16": (1 / 256, 128),
    "float32": (255, 0),
    "float64": (255, 0),
}
NO_KEY = -1
log = logging.getLogger(__name__)


def why_not_shown(image):
    """Why imshow cannot show this object, in a few words; None when it can."""
    if image is None:
        return "there is no picture (None): was the file read, did the topic send one?"
    if not isinstance(image, np.ndarray):
        return f"a picture is a numpy array, not a {type(image).__name__}"
    if image.size == 0:
        return "the picture is empty"
    if image.ndim not in (2, 3) or (image.ndim == 3 and image.shape[2] not in ENCODINGS):
        return f"shape {image.shape} is neither (h, w) nor (h, w, 1), (h, w, 3), (h, w, 4)"
    if image.dtype.name not in SCALES:
        return f"pixels of type {image.dtype} cannot be shown; known: {', '.join(SCALES)}"
    return None


def to_8_bit(image):
    """The picture as uint8, same shape; a uint8 picture is handed through."""
    factor, offset = SCALES[image.dtype.name]
    if image.dtype == np.uint8:
        return image
    scaled = np.nan_to_num(image.astype(np.float32) * factor + offset, nan=0.0)
    return np.clip(np.rint(scaled), 0, 255).astype(np.uint8)


def to_msg(image, stamp):
    """The picture as sensor_msgs/Image."""
    from sensor_msgs.msg import Image  # here: plain OpenCV scripts run without ROS

    msg = Image(height=image.shape[0], width=image.shape[1])
    msg.header.stamp = stamp
    msg.encoding = ENCODINGS[image.shape[2] if image.ndim == 3 else 1]
    msg.data = np.ascontiguousarray(to_8_bit(image)).tobytes()
    msg.step = len(msg.data) // msg.height
    return msg


def running_rospy():
    """The rospy module once its node is initialised, else None; never imports it itself."""
    rospy = sys.modules.get("rospy")
    return rospy if rospy is not None and rospy.core.is_initialized() else None


class WindowTopic:
    """Publishes on ~windows/<label>; converts a picture only when somebody looks."""

    def __init__(self, label):
        self.label = label
        self.image = None  # the last one shown, not copied
        self.publisher = None
        # rospy serialises for all and for a new subscriber into one buffer, the latter unlocked.
        self._sending = threading.Lock()
        self._opening = threading.Lock()  # several threads may show the first picture

    def show(self, image):
        self.image = image
        rospy = running_rospy()
        if rospy is None or rospy.is_shutdown():
            return
        with self._opening:
            if self.publisher is None:
                self._open(rospy)
        if self.publisher is not None and self.publisher.get_num_connections() > 0:
            try:
                with self._sending:
                    self.publisher.publish(to_msg(image, rospy.Time.now()))
            except rospy.ROSException:
                log.debug("the node closed %s while it was published", self.label)

    def close(self):
        if self.publisher is not None:
            self.publisher.unregister()
            self.publisher = None

    def peer_subscribe(self, _topic_name, _publish, publish_to_new):
        """rospy calls this for each new subscriber: it sees the last picture at once."""
        if self.image is not None:
            with self._sending:
                publish_to_new(to_msg(self.image, running_rospy().Time.now()))

    def peer_unsubscribe(self, _topic_name, _remaining):
        """Part of what rospy asks of a listener; nothing to do."""

    def _open(self, rospy):
        # Ctrl-C runs rospy's shutdown in the main thread. It waits for ever for a call to the
        # master that it interrupted there; a call in another thread it lets end.
        opening = threading.Thread(target=self._advertise, args=(rospy,), daemon=True)
        opening.start()
        opening.join()

    def _advertise(self, rospy):
        from sensor_msgs.msg import Image

        try:
            self.publisher = rospy.Publisher(
                f"~windows/{self.label}", Image, subscriber_listener=self, queue_size=1
            )
        except rospy.ROSException:
            log.debug("the node ended while %s was opened", self.label)
            return
        if not rospy.is_shutdown():
            rospy.loginfo(translated(
                f"no screen: the window is the image topic {self.publisher.resolved_name}"))


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
