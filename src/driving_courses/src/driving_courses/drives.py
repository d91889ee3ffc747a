"""How a robot's wheels are driven: what the simulator's plugins and controllers do, without ROS."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import replace
from pathlib import Path
from typing import Protocol
from xml.etree.ElementTree import Element

import yaml
from car_control.motor import DriveCommand, MotorSettings, controller_commands
from node_basics.settings import load_settings

from bullet_sim.control.controllers.diff_drive_controller import DiffDriveLaw
from bullet_sim.control.controllers.servo import TYPES as SERVOS
from bullet_sim.control.controllers.servo import Servo
from bullet_sim.control.hardware import open_hardware
from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.control.pid import Pid, PidGains
from bullet_sim.drives.diff_drive import (
    DiffDrive,
    DiffDriveParameters,
    driven_wheels,
    wheels_from_tags,
)
from bullet_sim.formats.urdf.facts import RobotFacts
from bullet_sim.formats.urdf.transmission import read_transmissions
from bullet_sim.model import Model
from bullet_sim.plugin_tags import PluginParameters
from bullet_sim.tick_rate import TickRate
from bullet_sim.world import World
from driving_courses.packages import find_file


class Drivetrain(Protocol):
    """A robot's wheels."""

    steers: bool  # whether it takes a steering angle (rad) instead of a rate of yaw (rad/s)

    def command(self, speed: float, turn: float) -> None:
        """m/s, and what it turns by; held until the next command."""

    def run(self, until: int) -> None:
        """Step the world up to that tick."""


class GazeboDiffDrive:
    """As bullet_sim_ros has libgazebo_ros_diff_drive.so, from the tags in the robot's file."""

    steers = False

    def __init__(self, world: World, robot: Model, _urdf: Element, _settings: Path | None):
        tags = next(PluginParameters(robot.name, plugin) for plugin in robot.description.plugins
                    if plugin.filename == "libgazebo_ros_diff_drive.so")
        parameters = DiffDriveParameters.from_tags(tags)
        wheels = driven_wheels(robot, wheels_from_tags(robot, tags), parameters, tags, robot.name)
        self._drive = DiffDrive(*wheels, parameters)
        self._world, self._updated = world, world.time
        self._rate = TickRate(tags.number("updateRate", 100.0), world.timestep, world.tick)
        self.command = self._drive.command

    def run(self, until: int) -> None:
        """The wheels take the command at the plugin's own rate."""
        world = self._world
        while world.tick < until:
            due = self._rate.next_tick(world.tick)
            world.step(min(due, until) - world.tick)
            if world.tick == due:
                self._drive.update(world.time - self._updated)
                self._updated = world.time


class ControlledDrive(ABC):
    """What ros_control does at each step: read, let controllers command, write.

    `parameters` are the controllers' in a YAML file, and may have limits and gains of joints.
    """

    steers = False

    def __init__(self, world: World, robot: Model, urdf: Element,
                 parameters: ControllerParameters):
        self._world, self._facts = world, RobotFacts(urdf)
        self._hardware = open_hardware(robot, self._facts, read_transmissions(urdf), parameters)
        world.each_step.append(self._step)

    def run(self, until: int) -> None:
        """Controllers work at every step."""
        self._world.step(until - self._world.tick)

    def _step(self) -> None:
        period = self._world.timestep
        self._hardware.read()
        self._update(self._world.time, period)
        self._hardware.write(period)

    @abstractmethod
    def _update(self, time: float, period: float) -> None:
        """The controllers' turn, between reading and writing."""


class DiffDriveController(ControlledDrive):
    """The file's diff_drive_controller."""

    def __init__(self, world: World, robot: Model, urdf: Element, settings: Path):
        parameters = _read(settings)
        super().__init__(world, robot, urdf, parameters)
        found = next(each for each in parameters.groups().values()
                     if each.text("type", "") == "diff_drive_controller/DiffDriveController")
        self._base = DiffDriveLaw.from_parameters(
            found, self._facts, self._hardware.command_handle)
        self._base.start(world.time)

    def command(self, speed: float, turn: float) -> None:
        """m/s and rad/s."""
        self._base.command(self._world.time, speed, turn)

    def _update(self, time: float, period: float) -> None:
        self._base.update(time, period)


class RacecarDrive(ControlledDrive):
    """The racecar's six joint controllers, told what car_control's motor_control tells them."""

    steers = True

    def __init__(self, world: World, robot: Model, urdf: Element, settings: Path):
        parameters = _read(settings).group("racecar")
        super().__init__(world, robot, urdf, parameters)
        self._servos = {name: self._servo(found) for name, found in parameters.groups().items()
                        if found.text("type", "") in SERVOS}
        self._motor = replace(load_settings(
            MotorSettings, find_file("car_control/config/car_control.yaml"), "motor_control"),
            ackermann=True)
        self.command(0.0, 0.0)

    def _servo(self, parameters: ControllerParameters) -> Servo:
        interface, law, _ = SERVOS[parameters.text("type")]
        return law(self._hardware.command_handle(interface, parameters.text("joint")),
                   Pid(PidGains.from_parameters(parameters)))

    def command(self, speed: float, turn: float) -> None:
        """m/s and rad of the bicycle's front wheel, within motor_control's bounds."""
        most = self._motor.max_speed, self._motor.max_steering_angle
        speed, turn = (max(-m, min(m, value)) for m, value in zip(most, (speed, turn), strict=True))
        self._targets = controller_commands(self._motor, DriveCommand(speed, turn))

    def _update(self, _time: float, period: float) -> None:
        for name, servo in self._servos.items():
            servo.update(self._targets[name], period)


DRIVES = {"gazebo_diff_drive": GazeboDiffDrive, "diff_drive_controller": DiffDriveController,
          "racecar": RacecarDrive}


def _read(settings: Path) -> ControllerParameters:
    return ControllerParameters(
        str(settings), yaml.safe_load(settings.read_text(encoding="utf-8")))
