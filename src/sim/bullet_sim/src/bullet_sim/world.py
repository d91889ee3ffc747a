"""The simulated world: the only thing that steps, and the owner of simulated time."""

import logging
import math
import time
import zlib
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace

import numpy as np

from bullet_sim.actors import Actor
from bullet_sim.description import ModelDescription, WorldDescription
from bullet_sim.errors import SimulationError, UnknownName
from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.nan_recovery import lost_models, recover_from_nan
from bullet_sim.nested import carried_lights, find_link, light_name
from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.contacts import Contact, read_contacts
from bullet_sim.physics.crowding import Crowded
from bullet_sim.physics.engine import EngineError
from bullet_sim.physics.parameter_bounds import check_kept, check_physics, possible_physics
from bullet_sim.physics.rays import RayHits, cast_rays
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.profiler import Profiler
from bullet_sim.rendering.scene import Scene
from bullet_sim.timed_forces import TimedForces

_log = logging.getLogger(__name__)


class World:
    """Models by name, integer ticks, step, pause and reset. Not thread-safe: one thread owns it."""

    def __init__(self, description: WorldDescription | None = None, seed: int = 0,
                 initial_time: float = 0.0):
        description = description or WorldDescription()
        self.description = replace(description, physics=possible_physics(description.physics))
        self.seed = seed
        self._initial_time = initial_time
        # A saved world starts at its saved time; a reset sets the initial time.
        self.tick = round((self.description.sim_time or initial_time) / self.timestep)
        self.paused = False
        self.models: dict[str, Model] = {}
        self.scene = Scene(self.description.scene)
        self.forces = TimedForces()
        self.profiler = Profiler()
        self.each_step: list[Callable[[], None]] = []  # called after every single step
        self.each_removal: list[Callable[[str], None]] = []  # with the name of a removed model
        self._moving: list[Model] = []
        self._actors: dict[str, Actor] = {}
        self._logged_errors: set[str] = set()  # of the engine, without a known cause
        self._client = PhysicsClient(self.description.physics, self.description.gravity)
        for light in self.description.lights:
            self.scene.add_light(light)
        self._spawn_all()
        for name, visual in self.description.scenery:
            self.scene.add_link(("", name), (visual,), IDENTITY)

    def _spawn_all(self) -> None:
        """The models of the description; one line for each that cannot be, one for a crowd."""
        crowd: list[str] = []
        for model in self.description.models:
            try:
                self.spawn(model)
            except Crowded as error:
                crowd.append(f"{model.name!r}: {error}")
            except SimulationError as error:
                _log.error("model %r: %s; left out", model.name, error)
        if crowd:
            _log.error("world %s, model %s; it and %d models after it are left out",
                       self.description.name, crowd[0], len(crowd) - 1)

    # --- time

    @property
    def timestep(self) -> float:
        """Length of one step, s."""
        return self.description.physics.max_step_size

    @property
    def time(self) -> float:
        """Simulated time, s: a whole number of steps."""
        return self.tick * self.timestep

    def step(self, count: int = 1) -> None:
        """Advance by `count` steps; while paused, time does not advance."""
        if self.paused or count < 1:
            return
        if self.is_at_rest and not (self.each_step or self.forces or self._actors):
            self.tick += count
            return
        start = time.perf_counter()
        for tick in range(self.tick + 1, self.tick + count + 1):
            try:
                self._step_once()
            except EngineError as error:
                self.tick = tick
                self.delete_lost_models(error)
        self.profiler.add("physics", time.perf_counter() - start, count)

    @property
    def is_at_rest(self) -> bool:
        """Whether the next step would change nothing but the time."""
        return self._client.auto_disable.disabled

    def _step_once(self) -> None:
        moving, gravity = self._moving, self.description.gravity
        if self.forces:  # first: they may end the rest in which models do nothing
            self.forces.apply((self.tick + 1) * self.timestep, self.timestep)
        for model in moving:
            model.before_step(gravity)
        self._client.step()
        self.tick += 1
        if self._client.auto_disable.found_nan:
            recover_from_nan(self._client, self.models.values())
        for model in moving:
            model.forget()
        for actor in self._actors.values():
            actor.walk(self.time)
        for function in self.each_step:
            function()

    def delete_lost_models(self, error: EngineError) -> None:
        """After an error of the engine: delete the models that it has lost; the rest is kept."""
        for name in lost_models(self.models.values(), error, self._logged_errors):
            self._remove(self.models[name])

    def random(self, name: str, tick: int | None = None) -> np.random.Generator:
        """A generator for a name and a tick (default: now): the same in every run with one seed.

        It does not depend on earlier draws, so noise does not depend on who reads when.
        """
        tick = self.tick if tick is None else tick
        return np.random.default_rng([self.seed, zlib.crc32(name.encode()), tick])

    # --- contents

    def spawn(self, description: ModelDescription, pose: Pose = IDENTITY,
              name: str | None = None) -> Model:
        """Add a model: its own pose is kept as an offset to `pose`.

        As gazebo_ros_api_plugin.cpp, updateSDFAttributes.

        SimulationError if there is a model of that name, or the engine cannot hold it.
        """
        name = name or description.name
        if name in self.models:
            raise SimulationError(
                f"a model named {name!r} is already there; delete it or choose another")
        model = self.models[name] = Model(name, description, pose * description.pose, self._client)
        self._note_moving()
        try:
            if description.trajectory:
                self._actors[name] = Actor(model, description.trajectory)
            self._show(model)
        except Exception:
            self.delete(name)
            raise
        return model

    def _note_moving(self) -> None:
        self._moving = [model for model in self.models.values() if not model.static]

    def _show(self, model: Model) -> None:
        """Add a model's visuals and lights to the scene."""
        for link in model.links.values():
            self.scene.add_link((model.name, link.name), link.description.visuals, link.pose)
            for light in link.description.lights:
                self.scene.add_light(replace(light, name=light_name(link, light),
                                             pose=link.pose * light.pose))

    def delete(self, name: str) -> None:
        """Remove a model. UnknownName if there is none of that name."""
        self._remove(self.model(name))

    def _remove(self, model: Model) -> None:
        name = model.name
        del self.models[name]
        self._actors.pop(name, None)
        self._note_moving()
        self.scene.remove_model(name)
        for light in carried_lights(model):
            if light in self.scene.lights:
                self.scene.remove_light(light)
        self.forces.drop_model(model)
        with ExitStack() as stack:  # all are called, even if removing or one of them fails
            for function in reversed(self.each_removal):
                stack.callback(function, name)
            model.remove()

    def model(self, name: str) -> Model:
        """The model of that name. UnknownName if there is none."""
        if name not in self.models:
            raise UnknownName("model", name, self.models)
        return self.models[name]

    def link(self, name: str) -> Link:
        """A link by scoped name `model::link`, or by an unscoped name that only one model has.

        UnknownName if there is none.
        """
        return find_link(self.models, name)

    # --- reset

    def reset_models(self) -> None:
        """Reset every model to where it was spawned; time is kept (Gazebo's reset_world)."""
        for model in self.models.values():
            model.reset()

    def reset_simulation(self) -> None:
        """As `reset_models`, and time starts again from its initial value."""
        self.reset_models()
        self.tick = round(self._initial_time / self.timestep)

    # --- reads

    def update_scene(self) -> Scene:
        """The scene with every moving link at its current pose."""
        for model in self.models.values():
            for name, (pose, _) in model.link_states().items():
                self.scene.set_pose((model.name, name), pose)
        return self.scene

    def cast_rays(self, starts: np.ndarray, ends: np.ndarray) -> RayHits:
        """First collision shape along each ray; `starts` and `ends` are (n, 3) in the world."""
        return cast_rays(self._client, starts, ends)

    def contacts(self) -> list[Contact]:
        """The contacts of the last step; read from the engine when asked for."""
        return read_contacts(self._client, [
            (model.name, body) for model in self.models.values() for body in model.bodies])

    def configure_physics(self, **changes) -> None:
        """Change fields of the world's PhysicsDescription, and gravity (m/s^2): all or none.

        SimulationError for impossible values.
        """
        gravity = changes.pop("gravity", self.description.gravity)
        physics = replace(self.description.physics, **changes)
        check_physics(physics)
        check_kept(self.description.physics, physics)
        self._client.configure(physics, gravity)
        # Up to a whole number of the new steps: time must not go back.
        self.tick = math.ceil(self.time / physics.max_step_size - 1e-6)
        self.description = replace(self.description, physics=physics, gravity=gravity)

    def close(self) -> None:
        """Disconnect from the engine."""
        self._client.close()
