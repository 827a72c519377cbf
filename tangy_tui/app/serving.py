"""The program in a browser: each page opened with the token runs it in a process of its own.

Textual's own server (textual-serve) does that; what is ours is who may come in. The token is asked
for once and then kept by the browser in a cookie that no other site's page is sent with.
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
TOKEN = "token"  # noqa: S105 - what it is called in the address
TOKEN_BYTES = 16
HTTP = 80  # the port that browsers do not say
RUN = "from tangy_tui.cli import main; main()"
EVERYWHERE = ("0.0.0.0", "::", "")  # noqa: S104 - they are refused
"""Where a server would listen at all addresses: no browser can be sent there."""
CLOSES_SECONDS = 3.0
"""In which browsers are to say that their page is closed."""
LONGEST_DAY = 12 * 3600  # s that a browser may stay


class NoServer(TangyError):
    """What serves pages is not installed."""


def new_token() -> str:
    """Make a token that nobody can guess."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def command_line(*words: str) -> str:
    """Return the command that runs Tangy with these words, as a shell takes it."""
    return shlex.join([sys.executable, "-P", "-c", RUN, *words])


def address(host: str, port: int, token: str) -> str:
    """Return the URL to open in a browser."""
    name = f"[{host}]" if ":" in host else host
    return f"http://{name}:{port}/?{TOKEN}={token}"


def known_as(host: str, port: int) -> set[str]:
    """Return by which names a browser that was sent to a host and a port asks for this machine."""
    name = f"[{host}]" if ":" in host else host
    return {name if port == HTTP else f"{name}:{port}"}


def make_server(command: str, host: str, port: int, token: str) -> Any:
    """Make the server; `serve()` runs it until it is interrupted.

    Args:
        command: what each page runs.
        host: where it listens.
        port: where it listens.
        token: what whoever comes in has to know.

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
        """Lets in only those who know the token."""

        async def _make_app(self) -> web.Application:
            app = await super()._make_app()
            app.middlewares.append(only_known(token, allowed))
            app.on_response_prepare.append(_keep_to_itself)
            return app

        async def handle_websocket(self, request: web.Request) -> web.WebSocketResponse:
            """Run a page, and take note of it until it is closed."""
            page = asyncio.current_task()
            assert page is not None  # noqa: S101 - this is a coroutine
            pages.add(page)
            try:
                return await super().handle_websocket(request)
            finally:
                pages.discard(page)

        async def on_shutdown(self, app: web.Application) -> None:
            """Close the pages that are open: a browser would not until it is asked."""
            for page in (there := list(pages)):
                page.cancel()
            if there:
                await asyncio.wait(there, timeout=CLOSES_SECONDS)

        async def on_startup(self, app: web.Application) -> None:
            """Print nothing: the caller tells the page's address."""

        def initialize_logging(self) -> None:
            """Leave the program's own log as it is."""

    return TokenServer(command, host=host, port=port, title="Tangy", public_url=f"http://{name}")


async def _keep_to_itself(request: web.Request, response: web.StreamResponse) -> None:
    """Let the page load nothing from elsewhere: its typeface would come from a stranger."""
    here = f"'self' ws://{request.host}"
    response.headers["Content-Security-Policy"] = (
        f"default-src 'self'; connect-src {here}; img-src 'self' data:; font-src 'self' data:; "
        "style-src 'self' 'unsafe-inline'; script-src 'self' 'unsafe-inline'; "
        "frame-ancestors 'none'"
    )
    response.headers["Referrer-Policy"] = "no-referrer"
    response.headers["Cache-Control"] = "no-store"


def only_known(token: str, allowed: set[str]) -> Any:
    """Make the middleware that asks for the token, and refuses pages of other sites.

    Args:
        token: what has to be known.
        allowed: by which names and ports this machine may be called.
    """
    from aiohttp import web

    @web.middleware
    async def known(
        request: web.Request,
        handler: Callable[[web.Request], Awaitable[web.StreamResponse]],
    ) -> web.StreamResponse:
        if request.host not in allowed:  # another site's name that was made to lead here
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
