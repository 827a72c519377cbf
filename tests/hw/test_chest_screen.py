"""The chest screen sends pictures to its pages, and knows whether they are really shown."""

from __future__ import annotations

import asyncio
import json
import os
import signal
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest

from tangy_hw.device_protocols import AnswersCalls, DeviceError, Picture
from tangy_hw.drivers import chest
from tangy_hw.drivers.chest import WebChestScreen
from tests.hw.chest_pages import ask, paired
from tests.hw.waiting import PATIENCE, until

CALL = Picture("Next number", "B-12", ("N-40", "O-75"), "Ana")


class Page:
    """A tablet's browser; `answers`: it confirms each picture that it has drawn."""

    def __init__(self, screen: WebChestScreen, name: str, *, answers: bool = True) -> None:
        self._screen, self.name, self.answers = screen, name, answers
        self.shown: list[dict[str, Any]] = []
        self.alive = 0
        self.calls: dict[str, str] = {}
        self.head = b""
        self._task = asyncio.create_task(self._look())
        self._writer: asyncio.StreamWriter | None = None

    async def _look(self) -> None:
        reader, self._writer = await asyncio.open_connection("127.0.0.1", self._screen.port)
        head = f"GET /events?page={self.name} HTTP/1.1\r\nHost: 127.0.0.1\r\n".encode()
        self._writer.write(head + paired(self._screen.pairing) + b"\r\n")
        self.head = await reader.readuntil(b"\r\n\r\n")
        while True:
            kind, said = (await reader.readuntil(b"\n\n")).decode().strip().split("\n")
            line = said.removeprefix("data: ")
            number = line
            if kind == "event: calls":
                self.calls = json.loads(line)
                continue
            if kind == "event: show":
                self.shown.append(json.loads(line))
                number = self.shown[-1]["n"]
            else:
                self.alive += 1
            if self.answers:
                cookie = paired(self._screen.pairing)
                target = f"/seen?page={self.name}&number={number}"
                answer = await ask(self._screen.port, "POST", target, cookie)
                assert answer.startswith(b"HTTP/1.1 204")

    @property
    def texts(self) -> list[str]:
        """The lines it got to show."""
        return [one["text"] for one in self.shown]

    def go(self) -> None:
        """Vanish without closing the connection."""
        self._task.cancel()
        if self._writer is not None:
            self._writer.transport.abort()


@pytest.fixture(autouse=True)
def patience(monkeypatch: pytest.MonkeyPatch) -> None:
    """Give pages more time, because they share their processor with other tests."""
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


class TestAnsweringCalls:
    async def test_a_press_on_the_button_of_an_open_call_answers_it(
        self, screen: WebChestScreen
    ) -> None:
        (page,) = await opened(screen, "one")
        satisfied: AnswersCalls = screen
        satisfied.offer({"staff 7": "Station 2", "expert 7": "Anna"})
        await until(lambda: len(page.calls) == 2)
        late = Page(screen, "two")
        await until(lambda: late.calls == page.calls)
        cookie = paired(screen.pairing)
        pressed = await ask(screen.port, "POST", "/answer?call=staff%207", cookie)
        assert pressed.startswith(b"HTTP/1.1 204")
        await until(lambda: screen.answered == ("staff 7",))
        screen.offer({})
        assert screen.answered == ()
        await until(lambda: page.calls == {})
        pressed = await ask(screen.port, "POST", "/answer?call=staff%207", cookie)
        assert pressed.startswith(b"HTTP/1.1 404")
        page.go()
        late.go()

    async def test_a_viewer_may_answer_a_call_and_a_stranger_may_not(
        self, screen: WebChestScreen
    ) -> None:
        (page,) = await opened(screen, "one")
        screen.offer({"staff": "Station 2"})
        await until(lambda: page.calls == {"staff": "Station 2"})  # the page has the call
        pairing = screen.pairing
        looks_on = f"Cookie: {pairing.cookie}={pairing.token(viewer=True)}\r\n".encode()
        pressed = await ask(screen.port, "POST", "/answer?call=staff")
        assert pressed.startswith(b"HTTP/1.1 403") and screen.answered == ()
        pressed = await ask(screen.port, "POST", "/answer?call=staff", looks_on)
        assert pressed.startswith(b"HTTP/1.1 204")
        await until(lambda: screen.answered == ("staff",))
        page.go()

    async def test_a_restarted_process_shows_the_call_buttons_again(
        self, screen: WebChestScreen
    ) -> None:
        screen.offer({"staff": "Station 2"})
        assert screen.pid is not None
        os.kill(screen.pid, signal.SIGKILL)
        await until(lambda: screen.pid is None)
        await until(lambda: screen.pid is not None and not screen.why.startswith("screen: the"))
        (page,) = await opened(screen, "one")
        await until(lambda: page.calls == {"staff": "Station 2"})
        page.go()


class TestShowing:
    async def test_show_returns_after_every_page_has_the_picture(
        self, screen: WebChestScreen
    ) -> None:
        pages = await opened(screen, "one", "two")
        await screen.show(CALL)
        await until(lambda: all(page.shown[-1]["n"] == 1 for page in pages))
        for page in pages:
            assert page.shown[-1] == {
                "n": 1, "text": "Next number", "number": "B-12", "before": ["N-40", "O-75"],
                "asks": "Ana", "file": False,
            }  # fmt: skip
            page.go()

    async def test_a_page_that_joins_late_gets_the_current_picture(
        self, screen: WebChestScreen
    ) -> None:
        (early,) = await opened(screen, "early")
        await screen.show(Picture("first"))
        await screen.show(Picture("second"))  # it ends when the page has drawn the picture
        (late,) = await opened(screen, "late")
        await until(lambda: bool(late.texts))
        assert early.texts[-2:] == ["first", "second"] and late.texts == ["second"]
        early.go()
        late.go()

    async def test_pictures_in_quick_succession_end_with_the_last(
        self, screen: WebChestScreen
    ) -> None:
        (page,) = await opened(screen, "one")
        await asyncio.gather(*(screen.show(Picture(str(number))) for number in range(20)))
        assert page.texts[-1] == "19"
        page.go()

    async def test_show_returns_if_one_page_confirms(self, screen: WebChestScreen) -> None:
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

    async def test_control_and_unusual_characters_arrive_unchanged(
        self, screen: WebChestScreen
    ) -> None:
        (page,) = await opened(screen, "one")
        for text in (
            "Next \u2028\n\n",
            "event: show\ndata: 7\n\n",
            "\ud83d\x00\x1b[2J",
            "\U0001f600",
        ):
            await screen.show(Picture(text, text, (text,), text))
            assert page.shown[-1]["text"] == page.shown[-1]["asks"] == text
        page.go()


class TestReading:
    async def test_the_screen_warns_until_a_page_opens(self, screen: WebChestScreen) -> None:
        await screen.show(CALL)  # there is no page that could fail to show it
        assert screen.reading().state == "WARN"
        assert screen.url in screen.why and screen.code in screen.why

    async def test_the_reading_is_ok_with_a_page_and_stale_without(self) -> None:
        now = 50.0
        screen = WebChestScreen(port=0, clock=lambda: now)
        await screen.start()
        (page,) = await opened(screen, "one")
        assert (screen.reading().state, screen.why) == ("OK", "")
        now += 1
        await screen.show(CALL)
        assert screen.reading().rate is not None
        page.go()
        now += 1.5
        reading = screen.reading()
        assert (reading.state, reading.age) == ("STALE", 1.5)
        now += 2
        assert screen.pages == 0 and "any more" in screen.why
        await screen.show(CALL)  # it is no error that no page took it
        await screen.close()

    async def test_a_page_that_hangs_is_stale_though_it_is_connected(
        self, screen: WebChestScreen
    ) -> None:
        screen.stale_after = 0.9
        (page,) = await opened(screen, "one")
        await until(lambda: page.alive > 2 and screen.reading().state == "OK")
        page.answers = False
        await until(lambda: screen.reading().state == "STALE")
        page.answers = True
        await until(lambda: screen.reading().state == "OK")
        page.go()

    async def test_a_reconnected_page_counts_once(self, screen: WebChestScreen) -> None:
        (page,) = await opened(screen, "one")
        again = Page(screen, "one")
        await until(lambda: bool(again.shown))
        assert screen.pages == 1
        await screen.show(CALL)
        assert again.texts[-1] == CALL.text and page.texts == [""]
        page.go()
        again.go()

    async def test_the_screen_reports_a_used_port_and_retries(self, screen: WebChestScreen) -> None:
        second = WebChestScreen(port=screen.port)
        await second.start()
        assert second.reading().state == "ERROR" and "cannot listen" in second.why
        await screen.close()
        await until(lambda: second.reading().state == "WARN")
        await second.close()

    @pytest.mark.parametrize(("host", "port"), [("127.0.0.1", 70_000), ("a..b", 0)])
    async def test_an_invalid_address_is_reported_as_an_error(self, host: str, port: int) -> None:
        screen = WebChestScreen(host, port)
        await screen.start()
        assert screen.reading().state == "ERROR"
        assert screen.why.startswith(f"screen cannot listen at {host}:{port} (")
        await screen.close()


FILES_OF_A_PAGE = 4  # files of the test itself while a page answers


def files() -> int:
    """Return the number of files this process has open."""
    return sum(1 for _ in Path("/proc/self/fd").iterdir())


class TestItsProcess:
    async def test_a_killed_process_is_restarted_on_its_port(self, screen: WebChestScreen) -> None:
        (page,) = await opened(screen, "one")
        await screen.show(CALL)
        port = screen.port
        assert screen.pid is not None
        os.kill(screen.pid, signal.SIGKILL)
        await until(lambda: screen.reading().state == "ERROR")
        assert "has ended (signal 9)" in screen.why
        page.go()
        await until(lambda: screen.reading().state != "ERROR")
        assert screen.port == port
        (again,) = await opened(screen, "one")
        assert again.shown[-1]["number"] == CALL.number
        again.go()

    async def test_connections_from_strangers_open_no_files_in_the_robot_process(
        self, screen: WebChestScreen
    ) -> None:
        (page,) = await opened(screen, "mine")
        before = files()
        strangers = [await asyncio.open_connection("127.0.0.1", screen.port) for _ in range(200)]
        for _, writer in strangers:
            writer.write(b"GET / HTTP/1.1\r\nHost: 127")
        # The paired page keeps showing pictures, and confirming them.
        await screen.show(CALL)
        alive = page.alive
        await until(lambda: page.alive > alive + 1)
        assert screen.reading().state == "OK"
        assert files() <= before + len(strangers) + FILES_OF_A_PAGE
        for _, writer in strangers:
            writer.transport.abort()
        page.go()
