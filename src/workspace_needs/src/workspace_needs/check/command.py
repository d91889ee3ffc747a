"""The command-line interface of check."""

import argparse
import re
import sys
from pathlib import Path

import rospkg

from bullet_sim import __version__
from bullet_sim.errors import did_you_mean
from bullet_sim_ros.unsourced import unsourced
from workspace_needs.check.findings import ACCEPTED, UNCHECKED, Finding, is_serious, table
from workspace_needs.check.workspaces import (
    file_findings,
    package_findings,
    workspace_findings,
)
from workspace_needs.tables import UNKNOWN, is_slip, tables, why_absent
from workspace_needs.workspace import WorkspaceError

PACKAGE = re.compile(r"[A-Za-z][\w-]*")
EPILOG = """examples of commands:
  rosrun bullet_sim_ros check robot.urdf.xacro model:=big    a robot
  rosrun bullet_sim_ros check my_world.world                 a world
  rosrun bullet_sim_ros check talker.py                      a script
  rosrun bullet_sim_ros check learning_topic                 all robots, worlds, launch files of it
  rosrun bullet_sim_ros check learning_topic 0course.launch  what this launch file starts
  rosrun bullet_sim_ros check ~/catkin_ws                    what of a workspace builds and works
exit code: 0 if all of it will work, if need be approximated; 1 if something will be missing"""


def main(argv: list[str] | None = None) -> int:
    """Print the table; 0, 1 if something will be missing, 2 if there is no such file or package."""
    parser = argparse.ArgumentParser(
        prog="check",
        description="Says what of a robot, world, package or workspace will work here.",
        epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", metavar="FILE|PACKAGE|WORKSPACE",
                        help="file (.urdf .xacro .sdf .world .launch .py), model "
                                     "folder, package or workspace")
    parser.add_argument("launch", nargs="?", help="launch file of the package")
    parser.add_argument("arguments", nargs="*", default=[], metavar="name:=value",
                        help="for xacro or launch")
    parser.add_argument("--all", action="store_true", help="also list accepted tags without effect")
    parser.add_argument("--run-commands", action="store_true",
                        help="run the commands of a launch file's parameters; without it xacro "
                             "and cat are done here, and others are named")
    parser.add_argument("--version", action="version", version=f"%(prog)s {__version__}")
    args = parser.parse_args(argv)
    if args.launch and ":=" in args.launch:
        args.arguments.insert(0, args.launch)
        args.launch = None
    try:
        findings = _findings(args)
    except WorkspaceError as error:
        print(f"check: {error}", file=sys.stderr)
        return 2
    if not findings:
        what = (_what_is_not_there(args.what) if findings is None else
                "there is nothing to check: no script, robot, world or launch file, and no "
                "workspace with packages of your own")
        print(f"check: {args.what}: {what}", file=sys.stderr)
        return 2 if findings is None else 0
    shown = findings if args.all else [f for f in findings if f.status != ACCEPTED]
    print(table(shown))
    left_out = len(set(findings)) - len(set(shown))
    if left_out:
        print(f"\n{left_out} ignored tags and elements are not listed: --all")
    serious = is_serious(findings)
    all_of_it = ("all that was checked" if any(found.status == UNCHECKED for found in findings)
                 else "all of it")
    print("\nsomething will be missing, see above" if serious else f"\n{all_of_it} will work")
    return 1 if serious else 0


def _what_is_not_there(name: str) -> str:
    near = unsourced(name) or ("" if tables().known(name) else did_you_mean(
        name, (each for each in rospkg.RosPack().list() if is_slip(name, each)), 0.75))
    if near or not PACKAGE.fullmatch(name):
        return f"no such file or package{near}; try `rospack list`, or give a path"
    why = why_absent(name)
    if tables().answer(name).kind != UNKNOWN:
        return f"no such file or package: {why}"
    return (f"no such file or package: {why}; once it is cloned, type: rosrun bullet_sim_ros check "
            f"~/catkin_ws/src/{name}")


def _findings(args: argparse.Namespace) -> list[Finding] | None:
    """The findings; None if `what` does not exist; WorkspaceError if it has no packages."""
    path = Path(args.what).expanduser()
    model = path / "model.sdf"
    file = next((each.resolve() for each in (path, model) if each.is_file()), None)
    if file is None:
        try:
            folder = Path(rospkg.RosPack().get_path(args.what))
        except rospkg.ResourceNotFound:
            if not (args.what and path.is_dir()):
                return None
            folder = path.resolve()
            if not (folder / "package.xml").is_file():
                return workspace_findings(folder, args.arguments, args.run_commands)
    if file is None and not args.launch:
        return package_findings(folder, args.arguments, args.run_commands)
    return file_findings(*((folder, args.launch) if file is None else (file.parent, file)),
                         args.arguments, args.run_commands)
