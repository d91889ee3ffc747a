"""Python runs this file at its start: it waits for `import cv2` and then gives cv2 its windows."""

import sys
from importlib.machinery import PathFinder


class Cv2Watch:
    """A finder that lets every import pass; after cv2's it hooks the windows and is gone."""

    @classmethod
    def find_spec(cls, name, _path=None, _target=None):
        if name != "cv2":
            return None
        from importlib.util import find_spec

        sys.meta_path.remove(cls)  # cv2 imports itself once more while it loads
        spec = find_spec(name)
        if spec is not None and hasattr(spec.loader, "exec_module"):
            load = spec.loader.exec_module
            spec.loader.exec_module = lambda module: cls.load(load, module)
        return spec

    @staticmethod
    def load(load, module):
        load(module)
        try:
            from headless_highgui.hook import install

            install(module)
        except Exception as error:  # a script that never shows a window must not fail here
            print(f"headless_highgui: no windows without a screen: {error}", file=sys.stderr)


def run_hidden():
    """Run a person's own usercustomize.py, which this one hides further down sys.path."""
    specs = [PathFinder.find_spec("usercustomize", [entry]) for entry in sys.path]
    for spec in [spec for spec in specs if spec is not None][1:]:
        from importlib.util import module_from_spec, spec_from_file_location

        hidden = spec_from_file_location("hidden_usercustomize", spec.origin)
        hidden.loader.exec_module(module_from_spec(hidden))


sys.meta_path.insert(0, Cv2Watch)
if __name__ == "usercustomize":
    run_hidden()
