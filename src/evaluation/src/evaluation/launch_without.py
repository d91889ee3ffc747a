"""roslaunch without one node: `python3 -m evaluation.launch_without PROGRAM PACKAGE FILE ARG:=...`.

It leaves out the nodes that run this program, and says how to start them.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import roslaunch
from roslaunch import rlutil
from roslaunch.parent import ROSLaunchParent

LEFT_OUT = "left out: rosrun "  # then package and program
OWN_FILES = ("/gazebo/state_log", "/gazebo/recording")  # would replace those of the run


class LaunchWithout(ROSLaunchParent):
    """Also without the parameters by which the simulator would write over the run's files."""

    def __init__(self, program: str, words: Sequence[str]):
        package, file, *arguments = words
        found = rlutil.resolve_launch_arguments([package, file])
        super().__init__(rlutil.get_or_generate_uuid(None, False), [(found[0], arguments)])
        self._program = program

    def _load_config(self) -> None:
        super()._load_config()
        for node in [each for each in self.config.nodes if each.type == self._program]:
            self.config.nodes.remove(node)
            print(f"{LEFT_OUT}{node.package} {node.type}", flush=True)
        for name in OWN_FILES:
            self.config.params.pop(name, None)


def main() -> None:
    """Run until Ctrl-C, or until a required node ends."""
    try:
        launch = LaunchWithout(sys.argv[1], sys.argv[2:])
        launch.start()
        launch.spin()
    except roslaunch.RLException as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
