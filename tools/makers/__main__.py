"""Makes meshes, textures, worlds and models anew: the same input, the same bytes.

    python3 tools/makers                       lists the makers
    python3 tools/makers NAME... [--out DIR]   writes what differs of theirs (DIR: this repository)

A maker is a module beside this one with a function `files`; with `stale` if it removes folders that
it made once; with `sources` (files and folders that it reads) if it is left out while nothing has
changed. What they make is committed, except that of name_packages and turtlebot3_worlds, which each
build makes. The pictures of pages have programs of their own here: lesson_pictures.py,
theory_pictures.py, loop_picture.py and breakpoint_picture.py.
"""

import argparse
import importlib
import shutil
import signal
import sys
from pathlib import Path

import kept

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C during setup ends it without a traceback
ROOT = Path(__file__).resolve().parents[2]
sys.path += map(str, [*ROOT.glob("src/*/src"), *ROOT.glob("src/*/*/src")])  # as before a build
MAKERS = ("course", "gazebo_worlds", "lane_world", "name_packages", "racecar_meshes", "racetrack",
          "turtlebot3_meshes", "turtlebot3_worlds", "urdf_lesson_mesh")


def main() -> int:
    """The exit status: 0, or 1 with one line that says which file cannot be written or read."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", choices=[[], *MAKERS],
                        help=", ".join(MAKERS))
    parser.add_argument("--out", type=Path, metavar="DIR", default=ROOT,
                        help="write below it (default: this repository)")
    options = parser.parse_args()
    here = options.out == ROOT
    if options.names and here:
        options.names = [name for name in options.names if not kept.is_made(name)]
        if not options.names:
            return 0
    from bullet_sim.props import replace_file  # of the path above
    from run_session.failure import RunError
    for name in options.names or MAKERS:
        maker = importlib.import_module(name)
        if not options.names:
            print(f"{name:18} {maker.__doc__.splitlines()[0]}")
            continue
        try:
            made = {options.out / path: data for path, data in maker.files().items()}
            for target, data in made.items():
                if replace_file(target, data):
                    print(f"{target}: {len(data)} bytes")
            for target in getattr(maker, "stale", list)() if here else ():
                shutil.rmtree(target)
            if here and hasattr(maker, "sources"):
                kept.keep(name, (*made, *maker.sources()))
        except OSError as error:
            print(f"makers: {error.filename or name}: {error.strerror}", file=sys.stderr)
            return 1
        except RunError as error:
            print(f"makers: {error}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
