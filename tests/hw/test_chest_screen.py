"""The chest screen tells its pages what to show, and knows whether people really see it."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tangy_hw.devices import DeviceError, Picture
from tangy_hw.drivers import chest
from tangy_hw.drivers.chest import WebChestScreen
from tests.hw.waiting import PATIENCE, until

CALL = Picture("Next number", "B-12", ("N-40", "O-75"), "Ana")


class Page:
    """A tablet, as its browser speaks; `answers`: it says that it has drawn what it was told."""

    def __init__(self, screen: WebChestScreen, name: str, *, answers: bool = True) -> None:
        self._screen, self.name, self.answers = screen, name, answers
        self.shown: list[dict[str, Any]] = []
        self.alive = 0
        self.head = b""
        self._task = asyncio.create_task(self._look())
        self._writer: asyncio.StreamWriter | None = None

    async def _look(self) -> None:
        reader, self._writer = await asyncio.open_connection("127.0.0.1", self._screen.port)
        self._writer.write(f"GET /events?page={self.name} HTTP/1.1\r\n\r\n".encode())
        self.head = await reader.readuntil(b"\r\n\r\n")
        while True:
            kind, said = (await reader.readuntil(b"\n\n")).decode().strip().split("\n")
            line = said.removeprefix("data: ")
            number = line
            if kind == "event: show":
                self.shown.append(json.loads(line))
                number = self.shown[-1]["n"]
            else:
                self.alive += 1
            if self.answers:
                answer = await ask(self._screen, "POST", f"/seen?page={self.name}&number={number}")
                assert answer.startswith(b"HTTP/1.1 204")

    @property
    def texts(self) -> list[str]:
        """The lines it was told to show."""
        return [one["text"] for one in self.shown]

    def go(self) -> None:
        """Vanish, without a word."""
        self._task.cancel()
        if self._writer is not None:
            self._writer.transport.abort()


async def ask(screen: WebChestScreen, method: str, target: str, more: bytes = b"") -> bytes:
    """Send one request, and return all that is answered."""
    reader, writer = await asyncio.open_connection("127.0.0.1", screen.port)
    head = f"{method} {target} HTTP/1.1\r\nHost: here\r\nConnection: close\r\n"
    writer.write(head.encode() + more + b"\r\n")
    async with asyncio.timeout(PATIENCE):
        answer = await reader.read()
    writer.close()
    return answer


@pytest.fixture(autouse=True)
def patience(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let pages be slow that share their processor with other tests."""
    monkeypatch.setattr(chest, "SHOW_SECONDS", PATIENCE)


@pytest.fixture
async def screen() -> AsyncIterator[WebChestScreen]:
    made = WebChestScreen(port=0)
    await made.start()
    yield made
    await made.close()


async def opened(screen: WebChestScreen, *names: str) -> list[Page]:
    """Open pages, and wait until they have answered."""
    pages = [Page(screen, name) for name in names]
    await until(lambda: screen.pages == len(names))
    return pages


class TestShowing:
    async def test_what_is_shown_is_on_every_page_when_show_returns(
        self, screen: WebChestScreen
    ) -> None:
        pages = await opened(screen, "one", "two")
        await screen.show(CALL)
        await until(lambda: all(page.shown[-1]["n"] == 1 for page in pages))
        for page in pages:
            assert page.shown[-1] == {
                "n": 1, "text": "Next number", "number": "B-12", "before": ["N-40", "O-75"],
                "asks": "Ana",
            }  # fmt: skip
            page.go()

    async def test_who_comes_later_sees_what_is_on(self, screen: WebChestScreen) -> None:
        await screen.show(Picture("first"))
        await screen.show(Picture("second"))
        (page,) = await opened(screen, "late")
        assert page.texts == ["second"]
        page.go()

    async def test_pictures_that_follow_at_once_end_with_the_last(
        self, screen: WebChestScreen
    ) -> None:
        (page,) = await opened(screen, "one")
        await asyncio.gather(*(screen.show(Picture(str(number))) for number in range(20)))
        assert page.texts[-1] == "19"
        page.go()

    async def test_one_page_that_answers_is_enough(self, screen: WebChestScreen) -> None:
        good, bad = await opened(screen, "good", "bad")
        bad.answers = False
        await screen.show(CALL)
        good.go()
        bad.go()

    async def test_a_page_that_does_not_draw_is_an_error(
        self, screen: WebChestScreen, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(chest, "SHOW_SECONDS", 0.1)
        (page,) = await opened(screen, "one")
        page.answers = False
        with pytest.raises(DeviceError, match="no tablet has shown it"):
            await screen.show(CALL)
        page.go()

    @settings(max_examples=20, suppress_health_check=[HealthCheck.function_scoped_fixture])
    @given(st.text(max_size=40), st.text(max_size=10), st.text(max_size=20))
    async def test_whatever_is_said_is_one_line_of_plain_signs_and_comes_back(
        self, text: str, number: str, asks: str
    ) -> None:
        line = chest._drawn(7, Picture(text, number, (number,), asks))
        assert line.isascii() and line.isprintable()
        assert json.loads(line)["text"] == text and json.loads(line)["asks"] == asks


class TestReading:
    async def test_nobody_looks_at_first(self, screen: WebChestScreen) -> None:
        await screen.show(CALL)  # nobody is there who could fail to take it
        assert screen.reading().state == "WARN"
        assert screen.url in screen.why

    async def test_a_page_that_answers_is_well_and_one_that_has_gone_is_stale(self) -> None:
        now = 50.0
        screen = WebChestScreen(port=0, clock=lambda: now)
        await screen.start()
        (page,) = await opened(screen, "one")
        assert (screen.reading().state, screen.why) == ("OK", "")
        answered = screen._arrivals._number
        now += 1
        await screen.show(CALL)
        assert screen._arrivals._number > answered
        assert screen.reading().rate is not None
        page.go()
        now += 1.5
        reading = screen.reading()
        assert (reading.state, reading.age) == ("STALE", 1.5)
        now += 2
        assert screen.pages == 0 and "any more" in screen.why
        await screen.show(CALL)  # and it is no error that nobody took it
        await screen.close()

    async def test_a_page_that_hangs_is_stale_though_it_is_connected(
        self, screen: WebChestScreen, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(chest, "ALIVE_SECONDS", 0.02)
        screen._stale_after = 0.15
        (page,) = await opened(screen, "one")
        await until(lambda: page.alive > 10 and screen.reading().state == "OK")
        page.answers = False
        await until(lambda: screen.reading().state == "STALE")
        page.answers = True
        await until(lambda: screen.reading().state == "OK")
        page.go()

    async def test_the_same_page_after_a_lost_link_is_one_page(
        self, screen: WebChestScreen
    ) -> None:
        (page,) = await opened(screen, "one")
        again = Page(screen, "one")
        await until(lambda: bool(again.shown))
        assert screen.pages == 1
        await screen.show(CALL)
        assert again.texts[-1] == CALL.text and page.texts == [""]
        page.go()
        again.go()

    async def test_a_port_in_use_is_told_and_waited_for(
        self, screen: WebChestScreen, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(chest, "AGAIN_SECONDS", 0.02)
        second = WebChestScreen(port=screen.port)
        await second.start()
        assert second.reading().state == "ERROR" and "cannot listen" in second.why
        await screen.close()
        await until(lambda: second.reading().state == "WARN")
        await second.close()

    @pytest.mark.parametrize(("host", "port"), [("127.0.0.1", 70_000), ("a..b", 0)])
    async def test_a_place_that_cannot_be_is_told(self, host: str, port: int) -> None:
        screen = WebChestScreen(host, port)
        await screen.start()
        assert screen.reading().state == "ERROR"
        assert screen.why.startswith(f"screen cannot listen at {host}:{port} (")
        await screen.close()


class TestRequests:
    @pytest.mark.parametrize(
        ("path", "kind"),
        [("/", b"text/html"), ("/chest.css", b"text/css"), ("/chest.js", b"text/j")],
    )
    async def test_the_page_is_whole_and_loads_nothing_from_elsewhere(
        self, screen: WebChestScreen, path: str, kind: bytes
    ) -> None:
        head, _, body = (await ask(screen, "GET", path)).partition(b"\r\n\r\n")
        assert head.startswith(b"HTTP/1.1 200 OK") and b"Content-Type: " + kind in head
        assert b"default-src 'none'" in head
        assert f"Content-Length: {len(body)}".encode() in head
        assert b"://" not in body and b"@import" not in body

    @pytest.mark.parametrize(
        ("method", "target", "status"),
        [
            ("GET", "/../devices.py", 404), ("GET", "/seen?page=x&number=1", 405),
            ("POST", "/seen?page=nobody&number=1", 404), ("POST", "/seen", 404),
            ("POST", "/", 405), ("PUT", "/seen", 405), ("GET", "/events", 503),
            ("GET", "/events?page=" + "x" * 41, 503), ("GET", "/?" + "&" * 20, 400),
            ("GET", "/" + "x" * 9000, 400), ("GET", "http://[", 400),
        ],
    )  # fmt: skip
    async def test_anything_else_is_refused(
        self, screen: WebChestScreen, method: str, target: str, status: int
    ) -> None:
        answer = await ask(screen, method, target)
        assert answer.startswith(f"HTTP/1.1 {status} ".encode())

    @pytest.mark.parametrize(
        "line",
        [b"Content-Length: 99999\r\n", b"Content-Length: x\r\n", b"Transfer-Encoding: a\r\n"],
    )
    async def test_bodies_that_are_no_use_are_refused(
        self, screen: WebChestScreen, line: bytes
    ) -> None:
        assert (await ask(screen, "POST", "/seen", line)).startswith(b"HTTP/1.1 400 ")

    async def test_an_answer_to_what_was_never_shown_counts_for_nothing(
        self, screen: WebChestScreen, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(chest, "SHOW_SECONDS", 0.1)
        (page,) = await opened(screen, "one")
        page.answers = False
        await ask(screen, "POST", "/seen?page=one&number=99999")
        with pytest.raises(DeviceError):
            await screen.show(CALL)
        page.go()

    async def test_there_are_not_more_pages_than_a_room_holds(self, screen: WebChestScreen) -> None:
        pages = await opened(screen, *(str(number) for number in range(chest.MOST_PAGES)))
        answer = await ask(screen, "GET", "/events?page=one-more")
        assert answer.startswith(b"HTTP/1.1 503 ")
        for page in pages:
            page.go()

    async def test_one_connection_serves_many_requests(self, screen: WebChestScreen) -> None:
        reader, writer = await asyncio.open_connection("127.0.0.1", screen.port)
        for _ in range(3):
            writer.write(b"HEAD / HTTP/1.1\r\n\r\n")
            async with asyncio.timeout(PATIENCE):
                assert (await reader.readuntil(b"\r\n\r\n")).startswith(b"HTTP/1.1 200")
        writer.close()
