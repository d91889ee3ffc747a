"""How a service call reaches the loop and how its failure comes back."""

from collections.abc import Callable
from typing import Any

import rospy

from bullet_sim.errors import SimulationError
from bullet_sim_ros import names
from bullet_sim_ros.errors import format_error
from bullet_sim_ros.inputs import Input
from bullet_sim_ros.mailbox import Closed
from bullet_sim_ros.simulation import Simulation

Handler = Callable[[Simulation, Any, Any], None]
_registry: list[tuple[str, type, Handler]] = []
# Time passes or not: what the world is at a step is the same.
HARMLESS = (names.PAUSE_PHYSICS, names.UNPAUSE_PHYSICS, names.STEP_PHYSICS)


class CallFails(Exception):
    """The call itself is to fail, so that the client sees a ServiceException."""


def service(name: str, kind: type) -> Callable[[Handler], Handler]:
    """Register `handler(simulation, request, response)`, which fills the response in the loop."""
    def register(handler: Handler) -> Handler:
        _registry.append((name, kind, handler))
        return handler

    return register


def offer_registered(simulation: Simulation) -> None:
    """Advertise all registered services."""
    for name, kind, handler in _registry:
        _offer(simulation, name, kind, handler)


def _offer(simulation: Simulation, name: str, kind: type, handler: Handler) -> None:
    mailbox, made = simulation.mailbox, kind._response_class
    resolved = rospy.resolve_name(name)
    acts = name not in HARMLESS and not name.startswith("~get_")
    if acts:
        simulation.inputs.add(resolved, kind._request_class, lambda request: lambda: _repeat(
            simulation, request, made(), handler))

    def answer(request):
        mailbox.announce(resolved, request)
        response = made()
        source = Input(resolved, 0, request, called=True) if acts else None
        try:
            mailbox.call(lambda: handler(simulation, request, response), source)
        except (CallFails, Closed) as error:
            raise rospy.ServiceException(str(error)) from None
        except Exception as error:  # whatever a request does, the caller gets one line
            message = format_error(error)
            if "success" not in response.__slots__:
                raise rospy.ServiceException(message) from None
            response.success = False
            response.status_message = message
            rospy.logerr("%s", message)
        return response

    rospy.Service(name, kind, answer)


def _repeat(simulation: Simulation, request, response, handler: Handler) -> None:
    """A request of a run that is repeated: whether it failed, its caller was told then."""
    try:
        handler(simulation, request, response)
    except Exception as error:
        rospy.loginfo("the run's call failed, too: %s", format_error(error))


def done(response, message: str) -> None:
    """Mark a response as successful."""
    response.success = True
    response.status_message = message


class ServiceError(SimulationError):
    """A request that cannot be met, in the words of gazebo_ros_api_plugin.cpp."""
