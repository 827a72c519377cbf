"""The chest screen's server trusts only paired tablets, and strangers cannot lock them out."""

from __future__ import annotations

import asyncio
import json
import stat
from collections.abc import AsyncIterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.drivers import chest_server
from tangy_hw.drivers.chest_pairing import (
    FILE,
    MOST_WRONG,
    MOST_WRONG_OF_ALL,
    WINDOW_SECONDS,
    CodeCheck,
    Pairing,
    TooManyCodes,
    keep_pairing,
)
from tangy_hw.drivers.chest_server import ChestServer
from tests.hw.chest_pages import ask, paired
from tests.hw.waiting import PATIENCE, until
from tests.support.media import make_picture

PAIRING = Pairing(bytes(32), "12345678")
COOKIE = paired(PAIRING)


class Served(ChestServer):
    """A server that records its reports."""

    def __init__(self) -> None:
        self.told: list[dict[str, Any]] = []
        super().__init__("127.0.0.1", 0, PAIRING, self.told.append, ["tangy.example"])


@pytest.fixture
async def server() -> AsyncIterator[Served]:
    made = Served()
    made.show(0, {"text": "here"})
    await made.start()
    yield made
    await made.close()


async def events(
    server: Served, page: str, cookie: bytes = COOKIE
) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    """Open the events of a page."""
    reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
    head = f"GET /events?page={page} HTTP/1.1\r\nHost: localhost\r\n".encode()
    writer.write(head + cookie + b"\r\n")
    return reader, writer


async def status(reader: asyncio.StreamReader) -> int:
    """Read the head of a response, and return its status."""
    async with asyncio.timeout(PATIENCE):
        return int((await reader.readuntil(b"\r\n\r\n")).split(b" ")[1])


async def half_sent(server: Served) -> asyncio.StreamWriter:
    """Send half a request."""
    _, writer = await asyncio.open_connection("127.0.0.1", server.port)
    writer.write(b"GET / HTTP/1.1\r\nHost: 127")
    return writer


class TestRequests:
    @pytest.mark.parametrize(
        ("path", "kind"),
        [("/", b"text/html"), ("/chest.css", b"text/css"), ("/chest.js", b"text/j")],
    )
    async def test_the_page_is_whole_and_loads_nothing_from_elsewhere(
        self, server: Served, path: str, kind: bytes
    ) -> None:
        head, _, body = (await ask(server.port, "GET", path)).partition(b"\r\n\r\n")
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
            ("GET", "/answer?call=staff", 405), ("POST", "/answer?call=nobody", 404),
            ("GET", "/pair", 405), ("POST", "/paired", 405), ("GET", "/paired", 204),
            ("GET", "/events?page=" + "x" * 41, 503), ("GET", "/?" + "&" * 20, 400),
            ("GET", "/" + "x" * 9000, 400), ("GET", "http://[", 400),
        ],
    )  # fmt: skip
    async def test_unknown_requests_are_refused(
        self, server: Served, method: str, target: str, status: int
    ) -> None:
        answer = await ask(server.port, method, target, COOKIE)
        assert answer.startswith(f"HTTP/1.1 {status} ".encode())

    @pytest.mark.parametrize(
        "line",
        [b"Content-Length: 257\r\n", b"Content-Length: x\r\n", b"Transfer-Encoding: a\r\n",
         b"Content-Length: " + b"9" * 5000 + b"\r\n"],
    )  # fmt: skip
    async def test_invalid_bodies_are_refused(self, server: Served, line: bytes) -> None:
        answer = await ask(server.port, "POST", "/seen", line)
        assert answer.startswith(b"HTTP/1.1 400 ")

    async def test_only_paired_tablets_get_the_file_of_a_picture(
        self, server: Served, tmp_path: Path
    ) -> None:
        photo = make_picture(tmp_path / "photo.png")
        server.show(7, {"text": "Who is this?", "file": str(photo)})
        assert str(tmp_path).encode() not in server.newest and b'"file": true' in server.newest
        answer = await ask(server.port, "GET", "/file?n=7", COOKIE)
        head, _, body = answer.partition(b"\r\n\r\n")
        assert b"Content-Type: image/png" in head and body == photo.read_bytes()
        assert b" 404 " in await ask(server.port, "GET", "/file?n=7")
        (tmp_path / "text.png").write_text("no picture")
        for file in ("", str(tmp_path / "none.png"), str(tmp_path / "text.png"), "/dev/zero"):
            server.show(8, {"text": "", "file": file})
            assert b'"file": false' in server.newest
            assert b" 404 " in await ask(server.port, "GET", "/file?n=8", COOKIE)

    async def test_one_connection_serves_many_requests(self, server: Served) -> None:
        reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
        for _ in range(3):
            writer.write(b"HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n")
            assert await status(reader) == 200
        writer.close()

    @given(st.text(max_size=40))
    def test_an_event_is_one_line_of_printable_ascii(self, text: str) -> None:
        server = Served()
        server.show(7, {"text": text})
        kind, line, *rest = server.newest.decode().split("\n")
        assert kind == "event: show" and rest == ["", ""]
        assert line.isascii() and line.isprintable()
        assert json.loads(line.removeprefix("data: ")) == {"n": 7, "text": text, "file": False}


class TestStrangers:
    @pytest.mark.parametrize(
        ("method", "target"),
        [("GET", "/events?page=one"), ("POST", "/seen?page=one&number=0"), ("GET", "/paired")],
    )
    @pytest.mark.parametrize(
        "cookie",
        [
            b"", paired(Pairing()), f"Cookie: {PAIRING.cookie}=\r\n".encode(),
            f"Cookie: {PAIRING.cookie}={'0' * 16}.{'0' * 64}\r\n".encode(),
        ],
    )  # fmt: skip
    async def test_an_unpaired_client_can_neither_read_nor_post(
        self, server: Served, method: str, target: str, cookie: bytes
    ) -> None:
        _, writer = await events(server, "one")  # a paired page is open under that name
        await until(lambda: "one" in server.windows)
        answer = await ask(server.port, method, target, cookie)
        assert answer.startswith(b"HTTP/1.1 403 ") and answer.endswith(b"\r\n\r\n")
        assert server.told == []
        writer.close()

    @pytest.mark.parametrize(
        ("host", "more", "status"),
        [
            ("localhost", b"", 200), ("192.168.1.5:8765", b"", 200), ("[fe80::1]:8765", b"", 200),
            ("Tangy.Example:80", b"", 200), ("tangy.example.", b"", 200),
            ("evil.example", b"", 421), ("127.0.0.1.evil.example", b"", 421), ("", b"", 421),
            ("[", b"", 421), ("a@evil.example", b"", 421),
            ("127.0.0.1:80", b"Origin: http://127.0.0.1:80\r\n", 200),
            ("127.0.0.1:80", b"Origin: http://evil.example\r\n", 421),
            ("127.0.0.1:80", b"Origin: null\r\n", 421),
        ],
    )  # fmt: skip
    async def test_requests_for_another_host_or_origin_are_refused(
        self, server: Served, host: str, more: bytes, status: int
    ) -> None:
        answer = await ask(server.port, "GET", "/", COOKIE + more, host=host)
        assert answer.startswith(f"HTTP/1.1 {status} ".encode())

    async def test_half_sent_requests_are_dropped_and_a_paired_tablet_gets_in(
        self, server: Served
    ) -> None:
        writers = [await half_sent(server) for _ in range(3 * chest_server.MOST_CONNECTIONS)]
        await until(lambda: server.connections == chest_server.MOST_CONNECTIONS)
        reader, writer = await events(server, "mine")
        assert await status(reader) == 200
        writers += [await half_sent(server) for _ in range(3 * chest_server.MOST_CONNECTIONS)]
        for number in range(3):
            target = f"/seen?page=mine&number={number}"
            assert (await ask(server.port, "POST", target, COOKIE)).startswith(b"HTTP/1.1 204 ")
        async with asyncio.timeout(PATIENCE):
            await reader.readuntil(b"event: alive")  # its events continue
        assert server.connections <= chest_server.MOST_CONNECTIONS
        for one in (*writers, writer):
            one.transport.abort()

    async def test_a_request_sent_byte_by_byte_gets_no_extra_time(
        self, server: Served, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(chest_server, "ASK_SECONDS", 0.2)
        reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
        ended = asyncio.ensure_future(reader.read())
        sent = 0
        while not ended.done() and sent < 100 * PATIENCE:
            writer.write(b"G")
            sent += 1
            await asyncio.wait([ended], timeout=0.02)
        assert ended.done()
        with suppress(ConnectionResetError):  # the data sent meanwhile is refused, too
            assert ended.result() == b""
        await until(lambda: server.connections == 0)
        writer.close()

    async def test_hanging_pages_give_way_to_a_paired_tablet(
        self, server: Served, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        opened = [await events(server, f"p{n}") for n in range(chest_server.MOST_PAGES)]
        for reader, _ in opened:
            assert await status(reader) == 200
        reader, late = await events(server, "late")
        assert await status(reader) == 503
        monkeypatch.setattr(chest_server, "GONE_SECONDS", 0.0)
        reader, another = await events(server, "another")
        assert await status(reader) == 200
        assert "p0" not in server.windows and len(server.windows) == chest_server.MOST_PAGES
        for one in (*(writer for _, writer in opened), late, another):
            one.close()

    async def test_the_server_reports_a_closed_page(self, server: Served) -> None:
        reader, writer = await events(server, "one")
        assert await status(reader) == 200
        writer.transport.abort()
        await until(lambda: server.told == [{"gone": "one"}])

    async def test_a_page_cannot_confirm_a_picture_that_was_never_shown(
        self, server: Served
    ) -> None:
        reader, writer = await events(server, "one")
        assert await status(reader) == 200
        await ask(server.port, "POST", "/seen?page=one&number=99999", COOKIE)
        assert server.told == [{"page": "one", "seen": 0}]
        writer.close()


class TestPairing:
    async def test_a_viewer_sees_the_picture_and_is_not_reported_as_a_page(
        self, server: Served
    ) -> None:
        answer = await ask(server.port, "POST", "/pair", body=b"1234 5678 viewer")
        cookie = answer.split(b"Set-Cookie: ")[1].split(b";")[0]
        assert PAIRING.is_viewer(cookie.decode().partition("=")[2])
        head = b"Cookie: " + cookie + b"\r\n"
        assert (await ask(server.port, "GET", "/paired", head)).startswith(b"HTTP/1.1 204 ")
        reader, writer = await events(server, "one")
        assert await status(reader) == 200
        said = len(server.told)
        seen = "/seen?page=one&number=0"
        assert (await ask(server.port, "POST", seen, head)).startswith(b"HTTP/1.1 204 ")
        assert server.told[said:] == []
        assert (await ask(server.port, "POST", seen, COOKIE)).startswith(b"HTTP/1.1 204 ")
        assert [told["page"] for told in server.told[said:]] == ["one"]
        writer.close()

    async def test_a_tablet_exchanges_the_code_for_a_lasting_token(self, server: Served) -> None:
        answer = await ask(server.port, "POST", "/pair", body=b"1234 5678")
        assert answer.startswith(b"HTTP/1.1 204 ")
        (line,) = (line for line in answer.decode().split("\r\n") if line.startswith("Set-Cookie"))
        assert "HttpOnly" in line and "SameSite=Strict" in line
        cookie = line.removeprefix("Set-Cookie: ").partition(";")[0]
        head = f"Cookie: {cookie}\r\n".encode()
        assert (await ask(server.port, "GET", "/paired", head)).startswith(b"HTTP/1.1 204 ")
        # Another process with the same key and another code knows it, too.
        assert Pairing(PAIRING.key, "00000000").knows(cookie.partition("=")[2])
        assert not Pairing().knows(cookie.partition("=")[2])

    @pytest.mark.parametrize("body", [b"", b"12345679", b"123456789", b"\xff" * 8, b"x" * 256])
    async def test_a_wrong_code_does_not_pair(self, server: Served, body: bytes) -> None:
        answer = await ask(server.port, "POST", "/pair", body=body)
        assert answer.startswith(b"HTTP/1.1 403 ") and b"Set-Cookie" not in answer

    async def test_the_right_code_must_wait_after_too_many_wrong_codes(
        self, server: Served
    ) -> None:
        for _ in range(MOST_WRONG):
            await ask(server.port, "POST", "/pair", body=b"00000000")
        answer = await ask(server.port, "POST", "/pair", body=b"12345678")
        assert answer.startswith(b"HTTP/1.1 429 ")

    def test_wrong_codes_are_limited_for_each_address_and_in_total_for_a_while(self) -> None:
        now = 0.0
        check = CodeCheck("12345678", lambda: now)
        for _ in range(MOST_WRONG):
            assert not check.right("0", "a")
        with pytest.raises(TooManyCodes):
            check.right("12345678", "a")
        assert check.right("1234-5678", "b")  # another address counts separately
        for number in range(MOST_WRONG_OF_ALL - MOST_WRONG):
            assert not check.right("0", f"many-{number}")
            if number == 10 * MOST_WRONG:  # wrong guesses lock out nobody else
                assert check.right("12345678", "c")
        with pytest.raises(TooManyCodes):
            check.right("12345678", "c")
        now += WINDOW_SECONDS
        assert check.right("12345678", "a") and check.right("12345678", "c")

    def test_the_pairing_file_is_readable_only_by_its_owner(self, tmp_path: Path) -> None:
        first = keep_pairing(tmp_path)
        assert keep_pairing(tmp_path) == first
        assert stat.S_IMODE((tmp_path / FILE).stat().st_mode) == 0o600
        assert [path.name for path in tmp_path.iterdir()] == [FILE]
        assert first.key.hex() not in repr(first) and first.code not in repr(first)

    @pytest.mark.parametrize("content", [b"", b"{", b"[]", b'{"key": "00", "code": "1"}', b"\xff"])
    def test_a_damaged_pairing_file_is_replaced(self, tmp_path: Path, content: bytes) -> None:
        (tmp_path / FILE).write_bytes(content)
        made = keep_pairing(tmp_path)
        assert keep_pairing(tmp_path) == made

    def test_the_pairing_is_new_each_time_without_a_data_folder(self, tmp_path: Path) -> None:
        assert keep_pairing(tmp_path / "none") != keep_pairing(tmp_path / "none")
        assert not (tmp_path / "none").exists()
