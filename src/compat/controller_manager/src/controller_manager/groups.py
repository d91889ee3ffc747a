"""The command `controller_group`: sets of controllers, from parameter `controller_groups`."""

import argparse
import sys

import rospy

from controller_manager import controller_manager_interface as interface
from controller_manager.client import ManagerClient

PARAMETER = "controller_groups"


def read_groups() -> dict[str, list[str]]:
    """Controllers by group, each once; ValueError with one line for anything else."""
    groups = rospy.get_param(PARAMETER, {})
    if not isinstance(groups, dict) or not all(isinstance(g, list) for g in groups.values()):
        raise ValueError(f"parameter {rospy.resolve_name(PARAMETER)} must have lists of "
                         "controllers by group")
    return {group: list(dict.fromkeys(names)) for group, names in sorted(groups.items())}


def members(groups: dict[str, list[str]], group: str) -> list[str]:
    """ValueError for a group without controllers."""
    if not groups.get(group):
        there = ", ".join(groups) or f"none (parameter {rospy.resolve_name(PARAMETER)})"
        raise ValueError(f"There is no controller defined in group {group}; groups: {there}")
    return groups[group]


def show(groups: dict[str, list[str]]) -> None:
    print(f"Number of groups: {len(groups)}")
    for group, names in groups.items():
        print(f"  {group}")
        for name in names:
            print(f"      {name}")


def spawn(wanted: list[str]) -> None:
    for call in (interface.load_controller, interface.start_controller):
        for name in wanted:
            call(name)


def switch(groups: dict[str, list[str]], wanted: list[str]) -> None:
    """Loads what is missing, then starts these and stops all other groups' controllers at once."""
    client = ManagerClient()
    client.wait("list_controllers", None, lambda line: print(line, file=sys.stderr, flush=True))
    states = {state.name: state.state for state in client.controllers()}
    for name in wanted:
        if name not in states and not interface.load_controller(name):
            print("Cancel group switching")
            return
    others = dict.fromkeys(n for names in groups.values() for n in names if n not in wanted)
    interface.start_stop_controllers(
        start_controllers=[name for name in wanted if states.get(name) != "running"],
        stop_controllers=[name for name in others if states.get(name) == "running"])


def arguments() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="controller_group", description="Groups of controllers.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    commands.add_parser("list", help="the groups and their controllers")
    for command, effect in (("spawn", "load and start a group's controllers"),
                            ("switch", "start a group's controllers, stop the other groups'")):
        commands.add_parser(command, help=effect).add_argument("group")
    return parser


def run(options: argparse.Namespace) -> None:
    """ValueError with one line where the parameter or the group does not suit."""
    groups = read_groups()
    if options.command == "list":
        show(groups)
    elif options.command == "spawn":
        spawn(members(groups, options.group))
    else:
        switch(groups, members(groups, options.group))


def main() -> int:
    """0 also where the manager or the group refuses, as upstream."""
    options = arguments().parse_args(rospy.myargv()[1:])
    try:
        rospy.init_node("controller_group", anonymous=True, disable_signals=True)
        run(options)
    except ValueError as error:
        print(error, file=sys.stderr)
    except rospy.ServiceException as error:
        print(f"controller_group: {error}", file=sys.stderr)
        return 1
    except (KeyboardInterrupt, rospy.ROSInterruptException):
        return 130
    return 0
