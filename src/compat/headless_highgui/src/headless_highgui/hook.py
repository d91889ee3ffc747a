"""Puts our window functions into cv2 where its own cannot work."""

import os
import re

from headless_highgui.windows import Windows

FUNCTIONS = (
    "namedWindow imshow waitKey waitKeyEx pollKey startWindowThread destroyWindow "
    "destroyAllWindows resizeWindow moveWindow setWindowTitle setWindowProperty "
    "getWindowProperty getWindowImageRect setMouseCallback createTrackbar getTrackbarPos "
    "setTrackbarPos setTrackbarMin setTrackbarMax"
).split()


def has_screen(cv2):
    """Whether this OpenCV was built with windows and there is a display to put them on."""
    toolkit = re.search(r"^\s*GUI:\s*(\S+)", cv2.getBuildInformation(), re.MULTILINE)
    built_in = toolkit is not None and toolkit.group(1) != "NONE"
    return built_in and bool(os.environ.get("DISPLAY"))


def install(cv2):
    """Replace cv2's window functions, unless it has a screen; say whether we did."""
    if has_screen(cv2):
        return False
    windows = Windows(cv2)
    for name in FUNCTIONS:
        setattr(cv2, name, getattr(windows, name))
    return True
