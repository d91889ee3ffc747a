"""Who may connect to the server: by a token, and by host names that no other site can use.

Another site can let its host name resolve to 127.0.0.1 (DNS rebinding), or open a WebSocket here
from its own origin. Browsers report that in the headers Host and Origin, so both are checked.
"""

import hmac
import ipaddress
import socket
from collections.abc import Awaitable, Callable
from urllib.parse import urlsplit

from aiohttp import web

from sim_viewer.options import Options

HEADERS = {
    "Content-Security-Policy": "default-src 'self'; img-src 'self' blob: data:; "
                               "style-src 'self' 'unsafe-inline'; frame-ancestors 'self'",
    "Cache-Control": "no-cache",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


class Access:
    """Decides on each request; a browser that showed the token once gets it as a cookie."""

    def __init__(self, options: Options):
        self._token = options.token
        own = socket.gethostname().lower()
        self._names = {"localhost", own, own.split(".")[0], f"{own.split('.')[0]}.local",
                       options.address.lower(), *options.hosts}

    @web.middleware
    async def guard(self, request: web.Request,
                    handler: Callable[[web.Request], Awaitable[web.StreamResponse]]
                    ) -> web.StreamResponse:
        """aiohttp middleware: 403 with the reason, or the answer with safe headers."""
        reason = self.refusal(request)
        if reason:
            return web.Response(status=403, text=reason + "\n", headers=HEADERS)
        try:
            answer = await handler(request)
        except web.HTTPException as refused:  # 404 and its like are answers, too
            refused.headers.update(HEADERS)
            raise
        except (OSError, ValueError):  # an impossible file name
            return web.Response(status=404, text="no such file\n", headers=HEADERS)
        if not answer.prepared:
            for name, value in HEADERS.items():
                answer.headers.setdefault(name, value)
            if self._token and request.query.get("token"):
                answer.set_cookie(_cookie(request), self._token, httponly=True, samesite="Strict")
        return answer

    def refusal(self, request: web.Request) -> str:
        """Why this request must not be answered; empty if it may be."""
        host = request.headers.get("Host", "")
        if not self._known(host):
            return (f"This server does not go by the name {host!r}; open it by its address, "
                    "or start it with hosts:=NAME.")
        origin = request.headers.get("Origin")
        if origin is not None and _place(origin) != host.lower():
            return f"A page of {origin!r} may not speak to this server."
        if self._token and not self._shows_token(request):
            return "Open the address with ?token=... that the server printed."
        return ""

    def _known(self, host: str) -> bool:
        try:
            parts = urlsplit(f"//{host}")
            name = "" if "@" in host else parts.hostname or ""
        except ValueError:
            return False
        if name in self._names:
            return True
        try:
            ipaddress.ip_address(name)  # an address, which DNS rebinding cannot fake
        except ValueError:
            return False
        return True

    def _shows_token(self, request: web.Request) -> bool:
        # Either of them: behind a proxy, a token in the address may be the proxy's own.
        shown = (request.query.get("token", ""), request.cookies.get(_cookie(request), ""))
        return any(hmac.compare_digest(one.encode(errors="replace"), self._token.encode())
                   for one in shown)


def _cookie(request: web.Request) -> str:
    """The cookie's name, with the port: browsers share cookies between all ports of a host."""
    return f"sim_viewer_{request.transport.get_extra_info('sockname')[1]}"


def _place(origin: str) -> str | None:
    """Host and port of an origin; None if it cannot be parsed."""
    try:
        return urlsplit(origin).netloc.lower()
    except ValueError:
        return None
