"""The connected browsers: their requests in, answers and events of their watches out.

The queues of messages to a browser are limited, so that a slow one costs no memory. Refusals and
errors are in the language that the page asks for by `?language=zh_CN`.
"""

import asyncio
import inspect
import itertools
import json
import struct
from collections import deque
from collections.abc import Callable
from typing import Any

import rospy
from aiohttp import WSMsgType, web
from terminal_language.catalogue import read_catalogue

from sim_viewer import registry
from sim_viewer.registry import Context, Node, Refused

MOST_ANSWERS = 100  # unread ones, after which nothing more is read from the browser
MOST_KEPT = 500  # messages of one watchable; the oldest is dropped first
MOST_BYTES = 4 << 20  # of one watch, likewise
LARGEST_MESSAGE = 1 << 20  # bytes; more closes the connection
MOST_BROWSERS = 100
MOST_AT_ONCE = 64  # operations in progress, and watches, of one browser
LONGEST_ID = 64  # characters of a message's number, which is sent back
GOODBYE = 1.0  # s for all browsers together, when the node ends
LANGUAGES = ("zh_CN",)  # of a page, besides English
LINES = ("faults", "loose")  # what an event says to its reader, lists of lines
PING_PERIOD = 15.0  # s; a browser that does not answer is disconnected


class Outbox:
    """Answers in order; of each watchable the newest message, and those marked to be kept."""

    def __init__(self, loop: asyncio.AbstractEventLoop):
        self._loop = loop
        self._answers: deque[str] = deque()
        self._watched: dict[int, deque[tuple[bool, str | bytes]]] = {}
        self._something = asyncio.Event()
        self._has_space = asyncio.Event()
        self._has_space.set()
        self._ended = False

    def answer(self, message: dict[str, Any]) -> None:
        """Queue an answer; in the loop's thread."""
        self._answers.append(encode(message))
        self._something.set()
        if len(self._answers) >= MOST_ANSWERS and not self._ended:
            self._has_space.clear()

    async def wait_for_space(self) -> None:
        """Waits until the browser has read enough of its answers, or has disconnected."""
        await self._has_space.wait()

    def end(self) -> None:
        """Nothing will be sent any more."""
        self._ended = True
        self._has_space.set()

    def open(self, watch: int) -> None:
        """Accept messages of this watch from now on."""
        self._watched[watch] = deque(maxlen=MOST_KEPT)

    def close(self, watch: int) -> None:
        """Drop this watch's queued messages, and those that still come."""
        self._watched.pop(watch, None)

    def post(self, watch: int, data: Any, keep: bool) -> None:
        """Queue a watch's message; from any thread. Bytes are sent after the watch's number."""
        message = (struct.pack("<I", watch) + data if isinstance(data, bytes)
                   else encode({"watch": watch, "data": data}))
        try:
            self._loop.call_soon_threadsafe(self._put, watch, message, keep)
        except RuntimeError:
            pass  # the loop has ended

    def _put(self, watch: int, message: str | bytes, keep: bool) -> None:
        mail = self._watched.get(watch)
        if mail is None:
            return
        if mail and not keep and not mail[-1][0]:
            mail.pop()
        mail.append((keep, message))
        size = sum(len(one) for _, one in mail) if len(mail) > 1 else 0
        while size > MOST_BYTES:
            size -= len(mail.popleft()[1])
        self._something.set()

    async def next(self) -> str | bytes:
        """Waits for something to send; watches take turns."""
        while True:
            if self._answers:
                self._has_space.set()
                return self._answers.popleft()
            for watch, mail in self._watched.items():
                if mail:
                    message = mail.popleft()[1]
                    self._watched[watch] = self._watched.pop(watch)  # to the end of the queue
                    return message
            self._something.clear()
            await self._something.wait()


def encode(data: Any) -> str:
    """JSON that every browser reads: NaN and infinity become null."""
    try:
        return json.dumps(data, allow_nan=False, separators=(",", ":"))
    except ValueError:
        return json.dumps(_finite(data), allow_nan=False, separators=(",", ":"))


def _finite(data: Any) -> Any:
    if isinstance(data, float):
        return data if abs(data) < float("inf") else None
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    if isinstance(data, (list, tuple)):
        return [_finite(value) for value in data]
    return data


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
            await self._serve(socket, request.query.get("language", ""))
        finally:
            self._sockets.discard(socket)
        return socket

    async def _serve(self, socket: web.WebSocketResponse, language: str) -> None:
        client = Client(socket, Context(self._node, next(self._numbers)), speaker(language))
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


def speaker(language: str) -> Callable[[str], str]:
    """What turns a line of ours into this language; English if it is none of LANGUAGES."""
    return read_catalogue(language).translate if language in LANGUAGES else str


class Client:
    """One connection; `say` turns what is said to its user into its language."""

    def __init__(self, socket: web.WebSocketResponse, context: Context, say: Callable[[str], str]):
        self._socket = socket
        self._context = context
        self._say = say
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
        line = self._say(" ".join(reason.split()))
        self._outbox.answer({"id": number, "ok": False, "error": line})

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
                       lambda data, keep=False: self._outbox.post(number, self._told(data), keep))
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

    def _told(self, data: Any) -> Any:
        """A watch's event; its error, and lists of lines, in the page's language."""
        if not isinstance(data, dict):
            return data
        told = {name: [self._say(line) for line in data[name]] for name in LINES if name in data}
        if isinstance(data.get("error"), str):
            told["error"] = self._say(data["error"])
        return {**data, **told} if told else data

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
