"""`tangy watch` and `tangy serve` on the command line."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest
from aiohttp import WSMsgType, web
from aiohttp.test_utils import TestClient, TestServer

from tangy_tui.app.serving import (
    COOKIE,
    LOOPBACK,
    TOKEN,
    address,
    known_as,
    make_server,
    new_token,
    only_known,
)
from tests.support.waiting import PATIENCE

Tangy = Callable[..., CompletedProcess[str]]


def test_stop_without_a_game_is_refused(tangy: Tangy, tmp_path: Path) -> None:
    done = tangy("watch", "--stop", "--data", tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert not list(tmp_path.iterdir()), "who only looks makes nothing"


def test_serving_on_all_addresses_is_refused(tangy: Tangy) -> None:
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
async def test_only_clients_with_the_token_are_admitted(
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


async def test_the_token_is_removed_from_the_address_after_its_use() -> None:
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
def test_a_browser_is_admitted_by_its_host_header(host: str, port: int, sent: str) -> None:
    assert known_as(host, port) == {sent}
    assert address(host, port, "t").startswith(f"http://{sent}")


class Page:
    """A browser page without an application."""

    def __init__(self, *_: object, **__: object) -> None:
        self.stopped = False

    async def start(self, width: int, height: int) -> None:
        """Start without showing anything."""

    async def stop(self) -> None:
        """End."""
        self.stopped = True


async def test_pages_are_closed_when_the_server_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("textual_serve.server.AppService", Page)
    server = make_server("nothing", LOOPBACK, 80, "known")
    app = web.Application()
    app.add_routes([web.get("/ws", server.handle_websocket)])
    async with TestClient(TestServer(app)) as client:
        page = await client.ws_connect("/ws")
        ends = asyncio.create_task(server.on_shutdown(app))
        assert (await page.receive(PATIENCE)).type is WSMsgType.CLOSE
        await ends
