"""breakpoint() in a node: pdb in the terminal, in whichever thread a callback runs.

Python's own asks for a line in several threads at once, takes Ctrl-C from rospy, and lets a node
whose terminal was closed by Ctrl-D run on, with a traceback for each message.
"""

import os
import sys

from terminal_language import translated

PASSED = []  # said once


def amend_core(core):
    """Let breakpoint() ask in the terminal; the module rospy.core. A debugger's own hook stays."""
    if sys.breakpointhook is sys.__breakpointhook__ and not os.environ.get("PYTHONBREAKPOINT"):
        sys.breakpointhook = lambda *_words, **_options: stop(sys._getframe(1), core)


def stop(frame, core):
    """Ask at the next line of this frame, or say once that there is no terminal to ask in."""
    if core.is_shutdown():
        return
    if not (sys.stdin and sys.stdin.isatty() and sys.stdout.isatty()):
        if not PASSED:
            PASSED.append(True)
            where = f"{os.path.basename(frame.f_code.co_filename)}:{frame.f_lineno}"
            print(translated(
                f"{where}: breakpoint() is passed over, since this program has no terminal to ask "
                "in: start it by rosrun in a terminal of its own, or attach a debugger"),
                file=sys.stderr, flush=True)
        return
    from python_amendments.asking import Asking  # pdb takes as long to load as much of a node

    Asking(core).set_trace(frame)
