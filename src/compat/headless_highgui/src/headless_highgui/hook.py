"""Puts our window functions into cv2 where its own cannot work; says what is there for Tk's.

And lets cv_bridge swap red and blue by OpenCV: its own way takes twice as long.
"""

import os
import re
import sys

FUNCTIONS = (
    "namedWindow imshow waitKey waitKeyEx pollKey startWindowThread destroyWindow "
    "destroyAllWindows resizeWindow moveWindow setWindowTitle setWindowProperty "
    "getWindowProperty getWindowImageRect setMouseCallback createTrackbar getTrackbarPos "
    "setTrackbarPos setTrackbarMin setTrackbarMax"
).split()
WITHOUT_TK = ("keys drive without a screen, too: type make drive, or use the page's tab Drive: "
              "roslaunch sim_viewer viewer.launch control:=true")


def has_screen(cv2):
    """Whether this OpenCV was built with windows and there is a display to put them on."""
    toolkit = re.search(r"^\s*GUI:\s*(\S+)", cv2.getBuildInformation(), re.MULTILINE)
    built_in = toolkit is not None and toolkit.group(1) != "NONE"
    return built_in and bool(os.environ.get("DISPLAY"))


def install(cv2):
    """Replace cv2's window functions, unless it has a screen; say whether we did."""
    if has_screen(cv2):
        return False
    from headless_highgui.windows import Windows  # and NumPy, which a Tk script may not need

    windows = Windows(cv2)
    for name in FUNCTIONS:
        setattr(cv2, name, getattr(windows, name))
    return True


def amend_tkinter(tkinter):
    """Let the error of a window that has no screen end with what drives without one.

    Tutorials' keyboard scripts open `Tk()`; programs of ours give it a name and have own words.
    """
    opens = tkinter.Tk.__init__

    def __init__(self, *words, **options):
        try:
            opens(self, *words, **options)
        except tkinter.TclError as error:
            if words or options or "display" not in str(error):
                raise
            raise tkinter.TclError(f"{error}; {WITHOUT_TK}") from None

    tkinter.Tk.__init__ = __init__


def amend_cv_bridge(boost):
    """Replace `cvtColor2` of cv_bridge.boost.cv_bridge_boost for rgb8 to bgr8 and back.

    That is the larger part of what a follower adds to an image before it answers. Other encodings
    and whatever is not (h, w, 3) uint8 are left to the function that was there.
    """
    convert = boost.cvtColor2

    def cvtColor2(image, encoding, wanted):
        colours = {encoding, wanted} == {"rgb8", "bgr8"} and image.ndim == 3
        if not colours or image.shape[2] != 3 or image.dtype != "uint8" or not image.size:
            return convert(image, encoding, wanted)
        cv2 = sys.modules["cv2"]  # cv_bridge has imported it
        return cv2.cvtColor(image, cv2.COLOR_RGB2BGR)

    boost.cvtColor2 = cvtColor2
