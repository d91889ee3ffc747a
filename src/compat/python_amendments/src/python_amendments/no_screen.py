"""Puts our window functions into cv2 where its own cannot work; says what is there for Tk's."""

import os
import re
import sys

from terminal_language import translated

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


def amend_cv2(cv2):
    """Replace cv2's window functions, unless it has a screen; say whether we did."""
    if has_screen(cv2):
        return False
    from python_amendments.windows import Windows  # and NumPy, which a Tk script may not need

    windows = Windows(cv2)
    for name in FUNCTIONS:
        setattr(cv2, name, getattr(windows, name))
    return True


def amend_tkinter(tkinter):
    """Let a script that ends as its window has no screen say in one line what drives without one.

    Tutorials' keyboard scripts open `Tk()`; programs of ours give it a name and have own words.
    """
    opens, shown = tkinter.Tk.__init__, sys.excepthook

    class NoScreen(tkinter.TclError):
        """A script may catch it as Tk's."""

    def __init__(self, *words, **options):
        try:
            opens(self, *words, **options)
        except tkinter.TclError as error:
            if words or options or "display" not in str(error):
                raise
            raise NoScreen(f"{error}; {WITHOUT_TK}") from None

    def show(kind, error, trace):
        if kind is not NoScreen:
            return shown(kind, error, trace)
        print(translated(f"{os.path.basename(sys.argv[0])}: {error}"), file=sys.stderr)

    tkinter.Tk.__init__, sys.excepthook = __init__, show
