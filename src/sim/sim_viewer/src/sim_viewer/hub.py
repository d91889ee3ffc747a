"""The connected browsers: their requests in, answers and events of their watches out."""

import asyncio
import inspect
import itertools
import json
from typing import Any

import rospy
from aiohttp import WSMsgType, web

from sim_viewer import registry
from sim_viewer.context import Context, Node
from sim_viewer.outbox import Outbox
from sim_viewer.registry import Refused

LARGEST_MESSAGE = 1 << 20  # bytes; more closes the connection
MOST_BROWSERS = 100
MOST_AT_ONCE = 64  # operations in progress, and watches, of one browser
LONGEST_ID = 64  # characters of a message's number, which is sent back
GOODBYE = 1.0  # s for all browsers together, when the node ends
PING_PERIOD = 15.0  # s; a browser that does not answer is disconnected


class Hub:
    """Owns the connections; everything here runs in the loop's thread."""

    def __init__(self, node: Node):
        self._node = node
        self._numbers = itertools.count(1)
        self._sockets: set[web.WebSocketResponse] = set()

    async def serve(self, request: web.Request) -> web.WebSocketResponse:
        """The handler of /ws: returns when the connection has ended.

        HTTPServiceUnavailable where too many pages are open.
        """
        if len(self._sockets) >= MOST_BROWSERS:
            raise web.HTTPServiceUnavailable(text=f"{MOST_BROWSERS} pages are open already\n")
        socket = web.WebSocketResponse(max_msg_size=LARGEST_MESSAGE, heartbeat=PING_PERIOD,
                                       compress=False)
        self._sockets.add(socket)
        try:
            await socket.prepare(request)
            await self._serve(socket)
        finally:
            self._sockets.discard(socket)
        return socket

    async def _serve(self, socket: web.WebSocketResponse) -> None:
        client = Client(socket, Context(self._node, next(self._numbers)))
        try:
            await client.serve()
        finally:
            await client.close()

    async def close(self) -> None:
        """Close all connections; browsers that do not answer in time are not waited for."""
        goodbyes = [asyncio.ensure_future(socket.close()) for socket in self._sockets]
        if goodbyes:
            _, deaf = await asyncio.wait(goodbyes, timeout=GOODBYE)
            for one in deaf:
                one.cancel()


class Client:
    """One connection."""

    def __init__(self, socket: web.WebSocketResponse, context: Context):
        self._socket = socket
        self._context = context
        self._outbox = Outbox(context.loop)
        self._tasks: set[asyncio.Task] = set()
        self._watches: dict[int, Any] = {}
        self._numbers = itertools.count(1)

    async def serve(self) -> None:
        """Handle messages until the connection ends."""
        sender = asyncio.create_task(self._send_all())
        try:
            async for message in self._socket:
                if message.type is WSMsgType.TEXT:
                    self._take(message.data)
                    await self._outbox.wait_for_space()
        finally:
            sender.cancel()

    async def close(self) -> None:
        """End its operations and watches."""
        self._context.closed()
        for task in self._tasks:
            task.cancel()
        for watch in list(self._watches):
            await self._unwatch(watch)

    async def _send_all(self) -> None:
        try:
            while not self._socket.closed:
                message = await self._outbox.next()
                # Waits while the browser's connection is full.
                if isinstance(message, bytes):
                    await self._socket.send_bytes(message)
                else:
                    await self._socket.send_str(message)
        except ConnectionError:
            pass  # the browser disconnected
        finally:
            self._outbox.end()

    # --- in

    def _take(self, text: str) -> None:
        number = None
        try:
            request = _decode(text)
            number = _number(request.pop("id", None))
            if len(self._tasks) >= MOST_AT_ONCE:
                raise Refused(f"more than {MOST_AT_ONCE} operations at once")
        except Refused as error:
            self._refuse(number, str(error))
            return
        task = asyncio.create_task(self._answer(number, request))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _answer(self, number: Any, request: dict[str, Any]) -> None:
        name = request.pop("op", None)
        try:
            data = await self._do(name, request)
            self._outbox.answer({"id": number, "ok": True, "data": data})
        except Refused as error:
            self._refuse(number, str(error))
        except Exception as error:
            rospy.logwarn("operation %s: %s: %s", name, type(error).__name__, error)
            self._refuse(number, f"{name}: {type(error).__name__}: {error}")

    def _refuse(self, number: Any, reason: str) -> None:
        self._outbox.answer({"id": number, "ok": False, "error": " ".join(reason.split())})

    async def _do(self, name: Any, args: dict[str, Any]) -> Any:
        if name == "watch":
            return await self._watch(args)
        if name == "unwatch":
            await self._unwatch(args.get("watch"))
            return None
        operation = registry.find_operation(name)
        if operation.control and not self._context.control:
            raise Refused(f"{name}: this page may only look; start it with control:=true")
        return await operation.function(self._context, **operation.arguments(args))

    # --- watching

    async def _watch(self, args: dict[str, Any]) -> dict[str, int]:
        kind = registry.find_watchable(args.get("what"))
        if len(self._watches) >= MOST_AT_ONCE:
            raise Refused(f"more than {MOST_AT_ONCE} things watched at once")
        number = next(self._numbers)
        watched = kind(self._context, registry.argument(args, "args", dict, {}),
                       lambda data, keep=False: self._outbox.post(number, data, keep))
        self._watches[number] = watched
        self._outbox.open(number)
        # Answers overtake queued events; the page keeps events that come before this answer.
        answer = {"watch": number}
        try:
            await self._run(watched.start)
        except BaseException:
            await self._unwatch(number)
            raise
        if number not in self._watches:  # ended meanwhile, and `start` went on after `stop`
            await self._stop(watched)
        return answer

    async def _unwatch(self, number: Any) -> None:
        watched = self._watches.pop(number, None) if isinstance(number, int) else None
        if watched is None:
            return
        self._outbox.close(number)
        await self._stop(watched)

    async def _stop(self, watched: Any) -> None:
        try:
            await self._run(watched.stop)
        except Exception as error:
            rospy.logwarn("end of a watch: %s: %s", type(error).__name__, error)

    async def _run(self, function: Any) -> None:
        """Run coroutines in the loop, plain functions in a worker thread."""
        if inspect.iscoroutinefunction(function):
            await function()
        else:
            await self._context.run_in_thread(function)


def _decode(text: str) -> dict[str, Any]:
    """The object in a message; Refused if there is none."""
    try:
        request = json.loads(text, parse_constant=_no_number)
    except (ValueError, RecursionError) as error:
        raise Refused(f"this is not valid JSON: {error}") from None
    if not isinstance(request, dict):
        raise Refused("a message is an object: {\"id\": 1, \"op\": \"NAME\"}")
    return request


def _number(given: Any) -> int | float | str | None:
    """A message's id; Refused if it is not one that can be sent back."""
    if given is None or (isinstance(given, (int, float, str)) and len(str(given)) <= LONGEST_ID):
        return given
    raise Refused(f"id is a number, or at most {LONGEST_ID} characters")


def _no_number(name: str) -> None:
    raise ValueError(f"{name} is not a number")
