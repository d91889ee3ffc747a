"""Repeats a run from its log: to an image, and on from there.

Same seed and same commands are the same bits, so going back to an image is repeating the run up to
it. Time begins by the service GO_TO_IMAGE; the world then stands, paused, before the answer to that
image, and messages to it are dropped. When it is unpaused, it sends the image to all that listen,
and goes on as any world in lockstep.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import rospy
from std_srvs.srv import Trigger, TriggerRequest, TriggerResponse

from bullet_sim.errors import SimulationError
from bullet_sim.fingerprint import description_hash, fingerprint
from bullet_sim.formats.run_log import Event, read_run_log
from bullet_sim.physics.engine import EngineError
from bullet_sim_ros import names
from bullet_sim_ros.inputs import Input
from bullet_sim_ros.mailbox import Closed
from bullet_sim_ros.run_log import request_hash
from bullet_sim_ros.scheduler import PeriodicTask
from bullet_sim_ros.simulation import Simulation


class ReplayError(SimulationError):
    """Why an image cannot be gone to; one line."""


class Replay:
    """Owned by the loop's thread."""

    def __init__(self, simulation: Simulation, path: Path):
        """OSError or RunLogError if the log cannot be read."""
        self._simulation, self._world = simulation, simulation.world
        self._log = read_run_log(path)
        self._world_hash = description_hash(self._world.description)
        self._next = 0  # index of the next event
        # Number of the image at which the world stands, unanswered; 0: not begun
        self._image = 0
        self._stands_at = self._world.tick
        self._unanswered = False  # whether that image was not noted yet, to be answered
        self._changed = False  # whether a service has changed the world since
        self._left = False  # whether the world has gone its own way
        self._fingerprint = b""
        self._setup: list[tuple[str, str]] = []  # calls so far, as in the log
        self._shown: set[PeriodicTask] = set()  # tasks whose listeners have the present state
        simulation.mailbox.each_input.append(self._note_input)
        simulation.each_turn.append(self._turn)
        rospy.Service(names.GO_TO_IMAGE, Trigger, self._answer)

    def _answer(self, _request: TriggerRequest) -> TriggerResponse:
        """In a ROS thread: go to the image that the parameter REPLAY_TO names."""
        number = int(rospy.get_param(names.REPLAY_TO, 1))
        try:
            self._simulation.mailbox.call(lambda: self._go_to(number))
        except (SimulationError, Closed) as error:
            return TriggerResponse(False, str(error))
        return TriggerResponse(True, f"image {number}")

    # --- in the loop

    def _note_input(self, source: Input) -> None:
        if not source.called or source.message is None:  # those that are repeated are not called
            return
        if self._image == 0:
            self._setup.append((source.name, request_hash(source)))
        else:
            self._changed = True

    def _go_to(self, number: int) -> None:
        """Repeat up to an image; ReplayError if it is behind, or if the state differs there."""
        if self._left or self._changed or self._world.tick != self._stands_at:
            raise ReplayError("the world has gone on by itself: only a new replay can go back")
        if number <= self._image:
            raise ReplayError(f"the world is at image {self._image}: only a new replay can go back")
        if number > (last := len(self._log.images)):
            raise ReplayError(f"the log ends at image {last}")
        if self._image == 0:
            self._check_begin()
        simulation = self._simulation
        simulation.mailbox.deaf, simulation.scheduler.heard = True, False
        self._world.paused = False
        try:
            while self._image < number and not simulation.stopped():
                self._repeat(self._log.events[self._next])
                self._next += 1
        finally:
            self._world.paused, simulation.scheduler.heard = True, True
            self._stands_at = self._world.tick
            self._shown.clear()
            simulation.publish_clock()

    def _check_begin(self) -> None:
        if self._log.header["world_sha256"] != self._world_hash:
            raise ReplayError(f"the world {self._log.header['world']} has changed since the run")
        # In any order: robots may be spawned by several nodes. The fingerprints tell the rest.
        if Counter(self._setup) != Counter(self._log.setup):
            changed = [name for name, _ in Counter(self._log.setup) - Counter(self._setup)]
            raise ReplayError("the robot's description, or where it is spawned, has changed since "
                              f"the run (service {(changed or [self._setup[0][0]])[0]})")

    def _repeat(self, event: Event) -> None:
        if self._unanswered:  # as far as who notes this run is concerned
            self._simulation.lockstep.note()
            self._unanswered = False
        self._advance_to(event.tick)
        if event.kind == "image":
            self._fingerprint = fingerprint(self._world, self._fingerprint)
            if self._fingerprint != event.data:
                raise ReplayError(f"the state at image {event.number} ({self._world.time:.3f} s) "
                                  "differs from the run's")
            self._image, self._unanswered = event.number, True
        elif event.kind == "lacks":
            raise ReplayError(f"at {self._world.time:.3f} s the run used {event.name}, which is "
                              "not in its log")
        else:
            try:
                source, act = self._simulation.inputs.repeated(
                    event.name, event.number, event.data)
            except LookupError:
                raise ReplayError(f"nobody here takes {event.name}, as in the run at "
                                  f"{self._world.time:.3f} s") from None
            self._simulation.mailbox.note(source)
            act()

    def _advance_to(self, tick: int) -> None:
        """Step; do what the run did at each step, but nothing that only listeners want."""
        world, scheduler = self._world, self._simulation.scheduler
        while world.tick < tick and not self._simulation.stopped():
            try:
                world.step(min(scheduler.next_tick(), tick) - world.tick)
                scheduler.run()
            except EngineError as error:
                world.delete_lost_models(error)

    def _turn(self) -> None:
        """In each turn of the loop, before it steps."""
        if self._image == 0 or self._left:
            return
        if self._world.paused and self._world.tick == self._stands_at:
            self._show()
        else:
            self._leave()

    def _show(self) -> None:
        """Publish the present state to those who have begun to listen since the world stands."""
        for task in self._simulation.scheduler.for_listeners():
            if not task.wanted():
                self._shown.discard(task)
            elif task not in self._shown:
                self._shown.add(task)
                task.action()
        self._simulation.lockstep.cancel()

    def _leave(self) -> None:
        """From here on the world goes its own way, beginning with the image at which it stood."""
        self._left, self._simulation.mailbox.deaf = True, False
        if self._world.tick != self._stands_at:  # it was stepped by a service
            return
        scheduler = self._simulation.scheduler
        for task in scheduler.for_listeners():  # the camera has the world wait for an answer
            if scheduler.is_due(task) and task.wanted():
                task.action()
        self._simulation.lockstep.wait(self._simulation.stopped)
