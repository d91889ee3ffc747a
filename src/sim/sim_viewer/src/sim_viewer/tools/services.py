"""Services: the list, a form for a request, and the call."""

import asyncio
import threading
from collections.abc import Callable
from typing import Any

import rosgraph
import rospy
import rosservice
from roslib.message import get_service_class

from sim_viewer.registry import Refused, operation
from sim_viewer.tools.master import MasterView
from sim_viewer.tools.messages import fill, template, to_text

TIMEOUT = 30.0  # s to wait for an answer
MOST_AT_ONCE = 8  # calls of all pages


@operation("services")
async def services(context: Any) -> list[dict[str, str]]:
    """`[{name, node}]` by name; types are queried one by one, since only the node knows them."""
    state = await context.run_in_thread(context.node.shared(MasterView).state)
    return [{"name": name, "node": ", ".join(nodes)}
            for name, nodes in sorted(state.services.items())]


@operation("service")
async def service(context: Any, name: str) -> dict[str, str]:
    """`{type, request, response}`: YAML with every field at its default."""
    kind = await context.run_in_thread(service_class, name)
    return {"type": kind._type, "request": template(kind._request_class),
            "response": template(kind._response_class)}


@operation("call_service", control=True)
async def call_service(context: Any, name: str, request: str) -> str:
    """The response as YAML; `request` is a filled-in form."""
    kind = await context.run_in_thread(service_class, name)
    message = await context.run_in_thread(fill, kind._request_class, request)
    return to_text(await context.node.shared(Calls).call(name, kind, message))


def service_class(name: str) -> type:
    """The class of a running service; Refused if it does not run or is not built here."""
    if not rosgraph.names.is_legal_name(name):
        raise Refused(f"{name!r:.60} is not the name of a service")
    try:
        kind = rosservice.get_service_type(name)
    except (rosservice.ROSServiceException, OSError) as error:
        raise Refused(f"{name} does not answer: {error}") from None
    if kind is None:
        raise Refused(f"{name}: no such service. The Services tab lists what there is")
    found = get_service_class(kind)
    if found is None:
        raise Refused(f"{name} is {kind}, which is not built here: build its package, "
                      "source its workspace and start the page again")
    return found


class Calls:
    """Runs calls, each in a thread of its own: a service that hangs blocks nothing else."""

    def __init__(self, node: Any):
        self._loop: asyncio.AbstractEventLoop = node.loop
        self._under_way = 0

    async def call(self, name: str, kind: type, *fields: Any) -> Any:
        """The response to a request or its fields.

        Refused with the server's reason, or when it takes too long.
        """
        return await self.run(name, lambda: rospy.ServiceProxy(name, kind)(*fields))

    async def run(self, name: str, work: Callable[[], Any], limit: float = TIMEOUT) -> Any:
        """Run `work`, which calls the services of `name`, and return its result; Refused as `call`,
        after `limit` s."""
        if self._under_way >= MOST_AT_ONCE:
            raise Refused(f"{MOST_AT_ONCE} calls are still waiting for their answers")
        answer = self._loop.create_future()
        self._under_way += 1
        threading.Thread(target=self._work, args=(work, answer), daemon=True).start()
        try:
            return await asyncio.wait_for(asyncio.shield(answer), limit)
        except TimeoutError:
            raise Refused(f"{name} has not answered within {limit:.0f} s") from None
        except (rospy.ServiceException, rospy.ROSException) as error:
            raise Refused(f"{name}: {error}") from None

    def _work(self, work: Callable[[], Any], answer: asyncio.Future) -> None:
        try:
            result = work()
        except Exception as error:
            result = error
        try:
            self._loop.call_soon_threadsafe(self._done, answer, result)
        except RuntimeError:
            pass  # the loop has ended

    def _done(self, answer: asyncio.Future, result: Any) -> None:
        self._under_way -= 1
        if answer.done():
            return
        if isinstance(result, Exception):
            answer.set_exception(result)
            answer.exception()  # nobody may be waiting any more
        else:
            answer.set_result(result)
