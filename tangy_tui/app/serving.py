"""The application in a browser: each page opened with the token runs it in its own process.

Textual's own server (textual-serve) does that; this module adds access control. The browser sends
the token once, then keeps it in a cookie that is not sent with requests from other sites.
"""

from __future__ import annotations

import asyncio
import hmac
import secrets
import shlex
import sys
from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING, Any

from tangy_profiles.errors import TangyError

if TYPE_CHECKING:
    from aiohttp import web

LOOPBACK = "127.0.0.1"
COOKIE = "tangy_token"
TOKEN = "token"  # noqa: S105 - its name in the URL
TOKEN_BYTES = 16
HTTP = 80  # the port that browsers omit
RUN = "from tangy_tui.cli import main; main()"
EVERYWHERE = ("0.0.0.0", "::", "")  # noqa: S104 - they are refused
"""Wildcard addresses, to which no browser can connect."""
CLOSES_SECONDS = 3.0
"""The time browsers get to acknowledge that their page is closed."""
LONGEST_DAY = 12 * 3600  # s until the cookie expires


class NoServer(TangyError):
    """The package that serves pages is not installed."""


def new_token() -> str:
    """Create a random token."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def command_line(*words: str) -> str:
    """Return the shell command that runs Tangy with these words."""
    return shlex.join([sys.executable, "-P", "-c", RUN, *words])


def address(host: str, port: int, token: str) -> str:
    """Return the URL to open in a browser."""
    name = f"[{host}]" if ":" in host else host
    return f"http://{name}:{port}/?{TOKEN}={token}"


def known_as(host: str, port: int) -> set[str]:
    """Return the Host headers that a browser may send for this host and port."""
    name = f"[{host}]" if ":" in host else host
    return {name if port == HTTP else f"{name}:{port}"}


def make_server(command: str, host: str, port: int, token: str) -> Any:
    """Create the server; `serve()` runs it until it is interrupted.

    Args:
        command: the command line that each page runs.
        host: the host to listen on.
        port: the port to listen on.
        token: the token that a browser must send.

    Raises:
        NoServer: textual-serve is not installed.
    """
    try:
        from textual_serve.server import Server
    except ImportError as missing:
        raise NoServer(str(missing.name)) from None

    pages = set[asyncio.Task[Any]]()
    allowed = known_as(host, port)
    (name,) = allowed

    class TokenServer(Server):  # type: ignore[misc,unused-ignore]
        """Admits only browsers with the token."""

        async def _make_app(self) -> web.Application:
            app = await super()._make_app()
            app.middlewares.append(only_known(token, allowed))
            app.on_response_prepare.append(_keep_to_itself)
            return app

        async def handle_websocket(self, request: web.Request) -> web.WebSocketResponse:
            """Run a page, and keep track of it until it is closed."""
            page = asyncio.current_task()
            assert page is not None  # noqa: S101 - this is a coroutine
            pages.add(page)
            try:
                return await super().handle_websocket(request)
            finally:
                pages.discard(page)

        async def on_shutdown(self, app: web.Application) -> None:
            """Close the open pages: browsers do not until they are asked to."""
            for page in (there := list(pages)):
                page.cancel()
            if there:
                await asyncio.wait(there, timeout=CLOSES_SECONDS)

        async def on_startup(self, app: web.Application) -> None:
            """Print nothing: the caller prints the address of the page."""

        def initialize_logging(self) -> None:
            """Leave the application's own logging as it is."""

    return TokenServer(command, host=host, port=port, title="Tangy", public_url=f"http://{name}")


async def _keep_to_itself(request: web.Request, response: web.StreamResponse) -> None:
    """Forbid the page to load anything from elsewhere: its font would come from a third party."""
    here = f"'self' ws://{request.host}"
    response.headers["Content-Security-Policy"] = (
        f"default-src 'self'; connect-src {here}; img-src 'self' data:; font-src 'self' data:; "
        "style-src 'self' 'unsafe-inline'; script-src 'self' 'unsafe-inline'; "
        "frame-ancestors 'none'"
    )
    response.headers["Referrer-Policy"] = "no-referrer"
    response.headers["Cache-Control"] = "no-store"


def only_known(token: str, allowed: set[str]) -> Any:
    """Create the middleware that asks for the token, and refuses requests from other sites.

    Args:
        token: the token to ask for.
        allowed: the Host headers by which this machine may be addressed.
    """
    from aiohttp import web

    @web.middleware
    async def known(
        request: web.Request,
        handler: Callable[[web.Request], Awaitable[web.StreamResponse]],
    ) -> web.StreamResponse:
        if request.host not in allowed:  # a foreign host name that resolves to this machine
            raise web.HTTPMisdirectedRequest
        origin = request.headers.get("Origin")
        if origin is not None and origin.partition("://")[2] != request.host:
            raise web.HTTPForbidden
        given = request.query.get(TOKEN)
        if given is not None and hmac.compare_digest(given.encode(), token.encode()):
            enters = web.HTTPSeeOther("/")
            enters.set_cookie(COOKIE, token, httponly=True, samesite="Strict", max_age=LONGEST_DAY)
            raise enters
        kept = request.cookies.get(COOKIE, "")
        if not hmac.compare_digest(kept.encode(), token.encode()):
            raise web.HTTPForbidden
        return await handler(request)

    return known
