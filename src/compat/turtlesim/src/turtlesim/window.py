"""The pond's picture: in the window TurtleSim, 500 by 500 pixels (Tk), or as the topic ~image.

The topic is for machines without a screen.
"""

from __future__ import annotations

import numpy as np
import rospy
from sensor_msgs.msg import Image

from turtlesim.pond.canvas import SIDE_PX


class ImageTopic:
    """Make it after rospy.init_node."""

    closed = False

    def __init__(self) -> None:
        self._publisher = rospy.Publisher("~image", Image, queue_size=1)
        self.name = self._publisher.resolved_name

    @property
    def wanted(self) -> bool:
        return self._publisher.get_num_connections() > 0

    def show(self, picture: np.ndarray) -> None:
        """(height, width, 3) uint8 RGB."""
        message = picture_to_msg(picture)
        message.header.stamp = rospy.Time.now()
        self._publisher.publish(message)


def picture_to_msg(picture: np.ndarray) -> Image:
    """(height, width, 3) uint8 RGB to an rgb8 image without a stamp."""
    height, width = picture.shape[:2]
    return Image(height=height, width=width, encoding="rgb8", step=3 * width,
                 data=picture.tobytes())


class NoScreen(Exception):
    """There is no screen to open a window on; the message says why."""


class Window:
    """Opens the window; NoScreen if that is not possible. Its thread is the one that made it."""

    wanted = True

    def __init__(self) -> None:
        try:
            import tkinter  # here: machines without a screen may lack it
        except ImportError as error:
            raise NoScreen(f"{error}; type: sudo apt-get install python3-tk") from error
        try:
            self._root = tkinter.Tk(className="turtlesim")
        except tkinter.TclError as error:
            raise NoScreen(str(error)) from error
        self.closed = False
        self._root.title("TurtleSim")
        self._root.resizable(False, False)
        self._root.protocol("WM_DELETE_WINDOW", self._close)
        self._root.bind("<Destroy>", lambda _event: self._close())
        self._image = tkinter.PhotoImage(master=self._root, width=SIDE_PX, height=SIDE_PX)
        tkinter.Label(self._root, image=self._image, borderwidth=0, highlightthickness=0).pack()
        self._shown = np.zeros((SIDE_PX, SIDE_PX, 3), np.uint8)

    def show(self, picture: np.ndarray) -> None:
        """(500, 500, 3) uint8 RGB. Also does what the window has to do, so show it often."""
        if picture is not self._shown:
            self._show_changes(picture)
            self._shown = picture
        self._root.update()

    def _show_changes(self, picture: np.ndarray) -> None:
        """Only what has changed: Tk takes long for a whole picture."""
        rows = _extent((picture != self._shown).reshape(SIDE_PX, -1).any(axis=1))
        columns = _extent((picture[rows] != self._shown[rows]).any(axis=(0, 2)))
        self._image.put(_ppm(picture[rows, columns]), to=(columns.start, rows.start))

    def _close(self) -> None:
        self.closed = True


def _extent(changed: np.ndarray) -> slice:
    """From the first to the last that is true; the first alone if none is."""
    places = np.flatnonzero(changed)
    return slice(int(places[0]), int(places[-1]) + 1) if places.size else slice(0, 1)


def _ppm(picture: np.ndarray) -> bytes:
    height, width = picture.shape[:2]
    return b"P6 %d %d 255\n" % (width, height) + picture.tobytes()
