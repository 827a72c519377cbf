"""Calling a person by a command or an address; a delivered call is not answered yet."""

from __future__ import annotations

import json
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest

from tangy_hw.calling import CallNews, call
from tangy_profiles.contacts import Contact

MESSAGE = {"text": "It stands still.", "for": "expert"}


def news(contact: Contact, seconds: float = 20.0) -> list[CallNews]:
    """Call a person, and return the reports."""
    told: list[CallNews] = []
    call(contact, MESSAGE, seconds, told.append)
    return told


def program(code: str) -> Contact:
    return Contact("Anna", command=(sys.executable, "-c", code))


class TestCommand:
    def test_a_command_that_prints_an_answer_has_reached_the_person(self) -> None:
        assert news(program("print('calling'); print('answered: Anna comes')")) == [
            CallNews("answered", "Anna comes")
        ]

    def test_a_command_that_exits_cleanly_has_only_sent_the_message(self) -> None:
        assert news(program("print('sent')")) == [CallNews("sent")]

    def test_the_command_receives_the_message(self) -> None:
        code = "import sys, json; print('answered', json.loads(sys.stdin.readline())['text'])"
        assert news(program(code)) == [CallNews("answered", "It stands still.")]

    def test_a_failing_command_is_reported_with_its_status_and_output(self) -> None:
        (told,) = news(program("raise SystemExit('no line to the outside')"))
        assert told.stage == "failed"
        assert "status 1" in told.said and "no line to the outside" in told.said

    def test_a_missing_command_is_reported_as_failed(self) -> None:
        (told,) = news(Contact("Anna", command=("/no/such/program",)))
        assert told.stage == "failed" and "/no/such/program" in told.said

    def test_a_hanging_command_is_killed_after_the_timeout(self) -> None:
        (told,) = news(program("import time; time.sleep(60)"), 0.3)
        assert told.stage == "failed"


@contextmanager
def address(reply: bytes, status: int = 200) -> Iterator[tuple[str, list[bytes]]]:
    """Serve an address on this machine, and record the posts to it."""
    posted: list[bytes] = []

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            posted.append(self.rfile.read(int(self.headers["Content-Length"])))
            self.send_response(status)
            self.end_headers()
            self.wfile.write(reply)

        def log_message(self, format: str, *args: object) -> None:
            """Say nothing."""

    server = HTTPServer(("127.0.0.1", 0), Handler)
    serving = threading.Thread(target=server.serve_forever, args=(0.02,))
    serving.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/tangy", posted
    finally:
        server.shutdown()
        serving.join()
        server.server_close()


@pytest.mark.parametrize(
    ("reply", "told"),
    [
        (b'{"answered": "Anna"}', CallNews("answered", "Anna")),
        (b'{"answered": true}', CallNews("answered")),
        (b'{"answered": false}', CallNews("sent")),
        (b"Answered by Anna", CallNews("answered", "by Anna")),
        (b"ok", CallNews("sent")),
        (b"", CallNews("sent")),
    ],
)
def test_an_address_gets_the_message_and_only_an_answer_counts(
    reply: bytes, told: CallNews
) -> None:
    with address(reply) as (url, posted):
        assert news(Contact("Anna", url=url)) == [told]
        assert json.loads(posted[0]) == MESSAGE


def test_an_unreachable_or_refusing_address_is_reported_as_failed() -> None:
    with address(b"answered", 503) as (url, _):
        (told,) = news(Contact("Anna", url=url))
        assert told.stage == "failed" and "503" in told.said
    (told,) = news(Contact("Anna", url=url), 2.0)
    assert told == CallNews("failed", "the address cannot be reached: Connection refused")
