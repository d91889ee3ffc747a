"""Makes meshes, textures, worlds and models anew: the same input, the same bytes.

    python3 tools/makers                       lists the makers
    python3 tools/makers NAME... [--out DIR]   writes what differs of theirs (DIR: this repository)

A maker is a module beside this one with a function `files`, and `stale` if it removes folders that
it made once. What they make is committed, except that of name_packages and turtlebot3_worlds, which
each build makes. The pictures of pages have programs of their own
here: lesson_pictures.py, theory_pictures.py and loop_picture.py.
"""

import argparse
import importlib
import shutil
import signal
import sys
from pathlib import Path

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
    from bullet_sim.props import replace_file  # of the path above
    from run_session.failure import RunError
    for name in options.names or MAKERS:
        maker = importlib.import_module(name)
        if not options.names:
            print(f"{name:18} {maker.__doc__.splitlines()[0]}")
            continue
        try:
            for path, data in maker.files().items():
                target = options.out / path
                if replace_file(target, data):
                    print(f"{target}: {len(data)} bytes")
            for target in getattr(maker, "stale", list)() if options.out == ROOT else ():
                shutil.rmtree(target)
        except OSError as error:
            print(f"makers: {error.filename or name}: {error.strerror}", file=sys.stderr)
            return 1
        except RunError as error:
            print(f"makers: {error}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
