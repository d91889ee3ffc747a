"""Python runs this file at its start: it amends a few modules when a script imports them.

cv2 gets its windows, cv_bridge a faster swap of colours, Tk a line for want of a screen, some
modules get the names that they had when a script was written, and rospy's subscribers say so when
their simulator has ended. A roslaunch that a program of ours refuses ends with one line; each
begins without setuptools, and a program of rospy without NumPy and catkin unless it asks for them.
Programs of ours print in the language of the locale, and end at Ctrl-C without a traceback.
"""

import collections
import os
import sys
import time
from _thread import get_ident
from importlib.machinery import PathFinder

LATER = "catkin.find_in_workspaces"
BRIDGE = "cv_bridge.boost.cv_bridge_boost"
AMENDED = {LATER, BRIDGE, "cv2", "genpy.message", "joint_state_publisher", "numpy",
           "roslaunch.loader", "rospy.topics", "tkinter", "yaml"}
LAUNCHERS = {"check", "roslaunch", "roscore", "rostest"}


class Watch:
    """A finder that lets every import pass; it amends each of those modules after its import."""

    waited_for = set(AMENDED)
    without_numpy = None  # the thread in which genpy.message begins

    @classmethod
    def find_spec(cls, name, _path=None, _target=None):
        if name == "numpy" and cls.without_numpy == get_ident():
            raise ModuleNotFoundError(name=name)
        if name == "rosclean" and os.path.basename(sys.argv[0]) in LAUNCHERS:
            take_own_distutils()
        if name not in cls.waited_for:
            return None
        from importlib.util import find_spec

        cls.waited_for.remove(name)  # it is looked for once more below, and cv2 imports itself
        spec = find_spec(name)
        if spec is not None and hasattr(spec.loader, "exec_module"):
            load, amend = spec.loader.exec_module, begin_later if name == LATER else cls.load
            spec.loader.exec_module = lambda module: amend(load, module)
        return spec

    @classmethod
    def load(cls, load, module):
        if module.__name__ == "genpy.message" and "numpy" not in sys.modules:
            cls.without_numpy = get_ident()
        try:
            load(module)
        finally:
            if module.__name__ == "genpy.message":
                cls.without_numpy = None
        for amend in (put_old_names_back, give_windows, hasten_cv_bridge, tell_of_the_end,
                      end_refused_launch, let_messages_hold_numbers_of_numpy):
            try:
                amend(module)
            except Exception as error:  # a script that needs none of it must not fail here
                print(f"headless_highgui: {module.__name__} is not amended: {error}",
                      file=sys.stderr)


def begin_later(load, module):
    """Run catkin.find_in_workspaces when its function, or anything else in it, is asked for.

    rospy imports it, and with it a parser of package.xml, but only who starts nodes calls it.
    """
    def find_in_workspaces(*words, **options):
        if module.find_in_workspaces is find_in_workspaces:
            load(module)
        return module.find_in_workspaces(*words, **options)

    def __getattr__(name):
        if name.startswith("__") or module.find_in_workspaces is not find_in_workspaces:
            raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")
        load(module)
        return getattr(module, name)

    module.find_in_workspaces, module.__getattr__ = find_in_workspaces, __getattr__


def take_own_distutils():
    """For rosclean, which roslaunch imports, Python's own distutils instead of setuptools' copy.

    To import all of setuptools takes as long as to import roslaunch. Somebody's own program that
    imports roslaunch may want setuptools' copy.
    """
    hack = sys.modules.get("_distutils_hack")
    if hack and sys.version_info < (3, 12):  # later Pythons have none of their own
        hack.remove_shim()


def put_old_names_back(module):
    from headless_highgui.old_names import AMENDED

    AMENDED.get(module.__name__, lambda _: None)(module)


def give_windows(module):
    if module.__name__ in ("cv2", "tkinter"):
        from headless_highgui.hook import amend_tkinter, install

        (install if module.__name__ == "cv2" else amend_tkinter)(module)


def hasten_cv_bridge(module):
    if module.__name__ == BRIDGE:
        from headless_highgui.hook import amend_cv_bridge

        amend_cv_bridge(module)


def tell_of_the_end(module):
    if module.__name__ == "rospy.topics":
        from headless_highgui.course_end import amend_topics

        amend_topics(module)


def end_refused_launch(module):
    if module.__name__ == "roslaunch.loader":
        from headless_highgui.launch_end import amend_loader

        amend_loader(module)


def let_messages_hold_numbers_of_numpy(module):
    """As genpy.message does at its own import, where NumPy takes a fifth of rospy's time."""
    messages, numpy = map(sys.modules.get, ("genpy.message", "numpy"))
    if module in (messages, numpy) and messages and numpy:
        kinds = [getattr(numpy, f"{kind}{bits}") for kind in ("int", "uint") for bits in
                 (8, 16, 32, 64)]
        known = messages._valid_float_types
        known += [kind for kind in (numpy.float32, numpy.float64, *kinds) if kind not in known]


def watch_standard():
    """collections and time are imported already: what amends them is, at the first old name."""
    def first_asked(module):
        def __getattr__(name):
            if name.startswith("__"):
                raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")
            from headless_highgui.old_names import amend_standard

            for each in (collections, time):
                del each.__getattr__
            amend_standard()
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
    """Let Ctrl-C while a program of ours imports end it without a traceback, as later on."""
    shown = sys.excepthook

    def show(kind, *rest):
        if kind is KeyboardInterrupt:
            try:
                from terminal_language.wanted import is_ours
            except ImportError:
                return shown(kind, *rest)
            if is_ours(sys.orig_argv):
                return None
        return shown(kind, *rest)

    sys.excepthook = show


choose_language()
end_quietly()
sys.meta_path.insert(0, Watch)
watch_standard()
if __name__ == "usercustomize":
    run_hidden()
