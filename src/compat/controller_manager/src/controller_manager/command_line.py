"""The command `controller_manager`: its words and what they call."""

import sys
from collections.abc import Callable

import rospy

from controller_manager import controller_manager_interface as interface

USAGE = """Commands:
    load NAME...                  load controllers
    unload NAME...                unload controllers
    start NAME...                 start controllers
    stop NAME...                  stop controllers
    spawn NAME...                 load and start controllers (sp)
    kill NAME...                  stop and unload controllers (kl)
    list                          the loaded controllers (lc)
    list-types                    the types that can be loaded (lt)
    reload-libraries [--restore]  look for types again; restore the controllers after it
The manager is looked for in ROS_NAMESPACE."""
SHORT = {"lc": "list", "lt": "list-types", "sp": "spawn", "kl": "kill"}
PER_NAME: dict[str, tuple[Callable[[str], bool], ...]] = {
    "load": (interface.load_controller,),
    "unload": (interface.unload_controller,),
    "start": (interface.start_controller,),
    "stop": (interface.stop_controller,),
    "spawn": (interface.load_controller, interface.start_controller),
    "kill": (interface.stop_controller, interface.unload_controller),
}
ALONE: dict[str, Callable[[list[str]], object]] = {
    "list": lambda _: interface.list_controllers(),
    "list-types": lambda _: interface.list_controller_types(),
    "reload-libraries":
        lambda words: interface.reload_libraries(True, restore="--restore" in words),
}


def run(command: str, words: list[str]) -> None:
    """As upstream, a refusal by the manager is printed and is no failure of the command."""
    if command in ALONE:
        ALONE[command](words)
    for call in PER_NAME.get(command, ()):
        for name in words:
            call(name)


def main() -> int:
    """1: bad words or no answer; 130: interrupted."""
    words = rospy.myargv()[1:]
    if not words or words[0] in ("-h", "--help"):
        print(USAGE)
        return 0
    command = SHORT.get(words[0], words[0])
    if command not in PER_NAME and command not in ALONE:
        print(f"controller_manager: there is no command {command}\n{USAGE}", file=sys.stderr)
        return 1
    if command in PER_NAME and not words[1:]:
        print(f"controller_manager: {command} needs the name of a controller", file=sys.stderr)
        return 1
    try:
        rospy.init_node("controller_manager", anonymous=True, disable_signals=True)
        run(command, words[1:])
    except rospy.ServiceException as error:
        print(f"controller_manager: {error}", file=sys.stderr)
        return 1
    except (KeyboardInterrupt, rospy.ROSInterruptException):
        return 130
    return 0
