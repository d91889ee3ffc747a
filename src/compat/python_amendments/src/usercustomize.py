"""Python runs this file at its start: it amends a few modules when a script imports them.

cv2 gets its windows, cv_bridge a faster swap of colours, Tk a line for want of a screen, some
modules get the names that they had when a script was written, and rospy says what a node waits for,
ends at Ctrl-C wherever that comes, and loads without what a node seldom needs.
A roslaunch that a program of ours refuses ends with one line; each begins without setuptools.
Programs of ours print in the language of the locale, and end without a traceback at Ctrl-C, or when
the reader of their output has ended. No traceback shows the lines of these amendments.
"""

import _signal  # built in; signal takes as long as all these
import atexit
import collections
import os
import sys
import time
from importlib import import_module
from importlib.machinery import PathFinder

INTERRUPTED = _signal.getsignal(_signal.SIGINT)
if INTERRUPTED is _signal.default_int_handler:  # not ignored, as by a job in the background
    # While this file is loaded, of which Python's own would show a traceback.
    _signal.signal(_signal.SIGINT, _signal.SIG_DFL)

# A module, and what amends it after its import: files and functions of python_amendments.
AMENDMENTS = {
    "actionlib.action_client": ["waiting.amend_actions"],
    "catkin_pkg.packages": ["launch_end.amend_packages"],
    "cv2": ["old_names.amend_cv2", "no_screen.amend_cv2"],
    "cv_bridge.boost.cv_bridge_boost": ["cv_bridge_colours.amend"],
    "dynamic_reconfigure.client": ["reconfigured.amend_client"],
    "joint_state_publisher": ["old_names.amend_joint_state_publisher"],
    "numpy": ["old_names.amend_numpy", "quick_start.amend_numpy"],
    "roslaunch.loader": ["launch_end.amend_loader"],
    "roslaunch.pmon": ["launch_end.amend_signals"],
    "rospy.client": ["waiting.amend_client"],
    "rospy.core": ["node_end.amend_core", "breakpoints.amend_core"],
    "rospy.impl.registration": ["node_end.amend_registration"],
    "rospy.impl.tcpros_pubsub": ["node_end.amend_publishing"],
    "rospy.impl.tcpros_service": ["waiting.amend_services"],
    "rospy.topics": ["waiting.amend_topics", "unheard.amend_publishers"],
    "tf2_ros.buffer": ["waiting.amend_frames", "node_end.amend_lookups"],
    "tkinter": ["no_screen.amend_tkinter"],
    "yaml": ["old_names.amend_yaml"],
}
# Loaded by quick_start.load_without.
QUICK = {"catkin.find_in_workspaces", "catkin_pkg.condition", "genpy.message"}

OURS = {"node_basics", "python_amendments", "terminal_language"}


class Watch:
    """A finder that lets every import pass; it amends each of those modules after its import."""

    waited_for = QUICK.union(AMENDMENTS)

    @classmethod
    def find_spec(cls, name, _path=None, _target=None):
        if name == "rosclean" and is_launcher():
            take_own_distutils()
        if name not in cls.waited_for:
            return None
        from importlib.util import find_spec

        cls.waited_for.remove(name)  # it is looked for once more below, and cv2 imports itself
        spec = find_spec(name)
        if spec is not None and hasattr(spec.loader, "exec_module"):
            load = spec.loader.exec_module
            spec.loader.exec_module = lambda module: cls.load(load, module)
        return spec

    @staticmethod
    def load(load, module):
        if module.__name__ in QUICK:
            try:
                from python_amendments.quick_start import load_without
            except ImportError:  # it is being built
                load(module)
            else:
                load_without(load, module)
            return
        load(module)
        for amendment in AMENDMENTS[module.__name__]:
            file, amend = amendment.split(".")
            try:
                getattr(import_module(f"python_amendments.{file}"), amend)(module)
            except Exception as error:  # a script that needs none of it must not fail here
                if isinstance(error, ImportError) and (error.name or "").split(".")[0] in OURS:
                    continue  # they are being built
                print(f"python_amendments: {module.__name__} is not amended: {error}",
                      file=sys.stderr)


def is_launcher():
    return os.path.basename(sys.argv[0]) in ("roslaunch", "roscore", "rostest")


def take_own_distutils():
    """For rosclean, which roslaunch imports, Python's own distutils instead of setuptools' copy.

    To import all of setuptools takes as long as to import roslaunch. Somebody's own program that
    imports roslaunch may want setuptools' copy.
    """
    hack = sys.modules.get("_distutils_hack")
    if hack and sys.version_info < (3, 12):  # later Pythons have none of their own
        hack.remove_shim()


def watch_standard():
    """collections and time are imported already: what amends them is, at the first old name."""
    def first_asked(module):
        def __getattr__(name):
            if name.startswith("__"):
                raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")
            from python_amendments import old_names

            old_names.HERE += (first_asked.__code__.co_filename,)  # by the link in the devel space
            for each in (collections, time):
                del each.__getattr__
            old_names.amend_standard()
            return getattr(module, name)

        return __getattr__

    for module in (collections, time):
        module.__getattr__ = first_asked(module)


def run_hidden():
    """Run a person's own usercustomize.py, which this one hides further down sys.path."""
    specs = [PathFinder.find_spec("usercustomize", [entry]) for entry in sys.path]
    for spec in [spec for spec in specs if spec is not None][1:]:
        from importlib.util import module_from_spec, spec_from_file_location

        hidden = spec_from_file_location("hidden_usercustomize", spec.origin)
        hidden.loader.exec_module(module_from_spec(hidden))


def choose_language():
    """Let our programs print in the language of the locale, if terminal_language is there."""
    names = ("LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG")
    if not any(os.environ.get(name, "").startswith("zh") for name in names):
        return  # every Python starts with this; the package's import would take half of its time
    try:
        from terminal_language.wanted import start
    except ImportError:  # it is off, by a CATKIN_IGNORE
        return
    start()


def end_quietly():
    """Let Ctrl-C end our programs and roslaunch without a traceback from their start, as later on.

    roslaunch may be at its imports, or waiting for a program that a <param> names. The same where
    the reader of the output has ended, also if the last lines are still to be written.
    """
    shown = sys.excepthook

    def show(kind, error, trace):
        if not (kind in (KeyboardInterrupt, BrokenPipeError)
                and (is_launcher() or is_program_of_ours())
                and (kind is KeyboardInterrupt or is_unread())):
            if trace is not None:  # of a syntax error there is none
                from python_amendments.own_frames import drop_own_frames

                drop_own_frames(error, __file__)
                trace = error.__traceback__
            shown(kind, error, trace)

    def write_last_lines():
        try:
            sys.stdout.flush()
        except BrokenPipeError:
            if is_launcher() or is_program_of_ours():
                is_unread()
        except (AttributeError, OSError, ValueError):  # closed, or none: Python says so
            pass

    sys.excepthook = show
    atexit.register(write_last_lines)


def is_program_of_ours():
    try:
        from terminal_language.wanted import is_ours
    except ImportError:
        return False
    return is_ours(sys.orig_argv)


def is_unread():
    """Whether the reader of the output has ended; what is still written then goes nowhere."""
    try:
        from node_basics.ending import drop_unread_output
    except ImportError:
        return False
    return drop_unread_output()


try:
    choose_language()
    end_quietly()
    sys.meta_path.insert(0, Watch)
    watch_standard()
finally:
    if INTERRUPTED is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, INTERRUPTED)
if __name__ == "usercustomize":
    run_hidden()
