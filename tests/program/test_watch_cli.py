"""`tangy watch` and `tangy serve` on the command line."""

from __future__ import annotations

import asyncio
import socket
import sys
from asyncio.subprocess import DEVNULL, PIPE
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from signal import SIGINT
from subprocess import CompletedProcess

import pytest
from aiohttp import ClientConnectionError, ClientResponse, ClientSession, CookieJar, web
from aiohttp.test_utils import TestClient, TestServer

from tangy_tui.app.serving import COOKIE, RUN, TOKEN, address, known_as, new_token, only_known
from tangy_tui.app.workspace import Workspace
from tests.support.waiting import until

Tangy = Callable[..., CompletedProcess[str]]


def test_there_is_nothing_to_stop_where_no_game_runs(tangy: Tangy, tmp_path: Path) -> None:
    done = tangy("watch", "--stop", "--data", tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert not list(tmp_path.iterdir()), "who only looks makes nothing"


def test_no_page_is_served_at_all_addresses_at_once(tangy: Tangy) -> None:
    assert tangy("serve", "--host", "0.0.0.0").returncode == 2  # noqa: S104


@pytest.mark.parametrize(
    ("headers", "query", "cookie", "status"),
    [
        ({}, "", False, 403),
        ({}, f"?{TOKEN}=wrong", False, 403),
        ({}, "", True, 200),
        ({"Host": "evil.example"}, "", True, 421),
        ({"Origin": "http://evil.example"}, "", True, 403),
    ],
)
async def test_only_who_knows_the_token_comes_in(
    headers: dict[str, str], query: str, cookie: bool, status: int
) -> None:
    token, allowed = new_token(), set[str]()

    async def page(request: web.Request) -> web.Response:
        return web.Response(text="in")

    app = web.Application(middlewares=[only_known(token, allowed)])
    app.add_routes([web.get("/", page)])
    async with TestClient(TestServer(app)) as client:
        allowed.add(f"{client.host}:{client.port}")
        cookies = {COOKIE: token} if cookie else {}
        got = await client.get(f"/{query}", headers=headers, cookies=cookies)
        assert got.status == status


async def test_the_token_is_kept_out_of_the_address_once_it_was_given() -> None:
    token, allowed = new_token(), set[str]()
    app = web.Application(middlewares=[only_known(token, allowed)])
    async with TestClient(TestServer(app)) as client:
        allowed.add(f"{client.host}:{client.port}")
        place = address("x", 1, token).partition("/?")[2]
        got = await client.get(f"/?{place}", allow_redirects=False)
        assert (got.status, got.headers["Location"]) == (303, "/")
        kept = got.cookies[COOKIE]
        assert (kept.value, kept["httponly"], kept["samesite"]) == (token, True, "Strict")


@pytest.mark.parametrize(
    ("host", "port", "sent"),
    [
        ("192.168.1.20", 8770, "192.168.1.20:8770"),
        ("192.168.1.20", 80, "192.168.1.20"),
        ("::1", 8770, "[::1]:8770"),
    ],
)
def test_a_browser_is_let_in_by_the_name_that_it_sends(host: str, port: int, sent: str) -> None:
    assert known_as(host, port) == {sent}
    assert address(host, port, "t").startswith(f"http://{sent}")


async def test_a_server_that_ends_takes_its_pages_along(tmp_path: Path) -> None:
    Workspace(tmp_path).close()
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = await asyncio.create_subprocess_exec(
        sys.executable, "-c", RUN, "serve", "--port", str(port), "--data", str(tmp_path),
        stdout=PIPE, stderr=DEVNULL,
    )  # fmt: skip
    try:
        assert server.stdout is not None
        place = (await server.stdout.readline()).decode().split()[-1]
        async with ClientSession(cookie_jar=CookieJar(unsafe=True)) as browser:
            assert (await _answered(browser, place)).status == 200
            at = f"127.0.0.1:{port}"
            await browser.ws_connect(f"http://{at}/ws", origin=f"http://{at}")
            await until(lambda: _running(f"watch --by 'a browser' --data {tmp_path}"))
            server.send_signal(SIGINT)
            assert await asyncio.wait_for(server.wait(), 30) == 0
            await until(lambda: not _running(str(tmp_path)))
    finally:
        if server.returncode is None:
            server.kill()


async def _answered(browser: ClientSession, place: str) -> ClientResponse:
    while True:  # the test's own limit ends it
        with suppress(ClientConnectionError):
            return await browser.get(place)
        await asyncio.sleep(0.05)


def _running(said: str) -> bool:
    """Say whether a process runs that was told something."""
    found = False
    for told in Path("/proc").glob("[0-9]*/cmdline"):
        with suppress(OSError):
            found |= said.encode() in told.read_bytes()
    return found
