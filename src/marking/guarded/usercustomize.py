"""Python runs this at the start of each of a marked course's programs: it guards nodes and launch.
"""

import importlib.util
import sys

WATCHED = {"rospy": "guard_node", "roslaunch.server": "guard_launch"}  # module, function of guard


class Watch:
    """A finder that lets every import pass; once a watched module is there, it is guarded."""

    @classmethod
    def find_spec(cls, name, _path=None, _target=None):
        if name not in WATCHED:
            return None
        guarding = WATCHED.pop(name)
        spec = importlib.util.find_spec(name)
        if spec is not None:
            load = spec.loader.exec_module
            spec.loader.exec_module = lambda module: cls.load(load, module, guarding)
        return spec

    @staticmethod
    def load(load, module, guarding):
        load(module)
        from marking import guard

        getattr(guard, guarding)()


sys.meta_path.insert(0, Watch)
