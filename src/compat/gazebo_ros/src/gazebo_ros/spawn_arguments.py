"""The command line of spawn_model: upstream's flags, long names behind a single dash."""

import argparse

import rospy

EPILOG = "Example: spawn_model -urdf -param robot_description -model robot -z 0.1"
SOURCES = (
    ("-file", "FILE_NAME", "file"), ("-param", "PARAM_NAME", "ROS parameter"),
    ("-database", "MODEL_NAME", "model of the model path"))
SWITCHES = (
    ("-unpause", "unpause the simulation afterwards"),
    ("-package_to_model", "in mesh file names, write model:// for package://"),
    ("-b", "stay, and delete the model when this node is shut down"))


def parser() -> argparse.ArgumentParser:
    result = argparse.ArgumentParser(
        prog="spawn_model", description="Spawn a model in the simulator.", epilog=EPILOG)
    language = result.add_mutually_exclusive_group(required=True)
    language.add_argument("-urdf", action="store_true", help="the XML is URDF")
    language.add_argument("-sdf", action="store_true", help="the XML is SDF")
    source = result.add_mutually_exclusive_group(required=True)
    for flag, metavar, where in SOURCES:
        source.add_argument(flag, metavar=metavar, help=f"take the XML from this {where}")
    source.add_argument("-stdin", action="store_true", help="take the XML from standard input")
    result.add_argument("-model", required=True, metavar="MODEL_NAME", help="the new name")
    result.add_argument("-reference_frame", default="", metavar="NAME",
                        help="model or model::link that the pose is seen from; default: world")
    result.add_argument("-gazebo_namespace", default="/gazebo", metavar="NS",
                        help="where the services are; default: /gazebo")
    result.add_argument("-robot_namespace", default=rospy.get_namespace(), metavar="NS",
                        help="of the model's plugins; default: this node's")
    result.add_argument("-wait", metavar="MODEL_NAME", help="first wait until this model is there")
    for flag, effect in SWITCHES:
        result.add_argument(flag, action="store_true", help=effect)
    for name in ("x", "y", "z"):
        result.add_argument(f"-{name}", type=float, default=0.0, help=f"position {name}, m")
    for name, angle in (("R", "roll"), ("P", "pitch"), ("Y", "yaw")):
        result.add_argument(f"-{name}", type=float, default=0.0, help=f"{angle}, rad")
    result.add_argument("-J", dest="joints", action="append", default=[], nargs=2,
                        metavar=("JOINT_NAME", "POSITION"), help="initial position, rad or m")
    return result


def joint_positions(joints: list[list[str]]) -> list[float]:
    """The numbers of all -J; ValueError with one clear line for a word that is none."""
    positions = []
    for name, word in joints:
        try:
            positions.append(float(word))
        except ValueError:
            raise ValueError(f"Error: -J {name} {word}: {word} is not a number") from None
    return positions
