"""The address of the bench's chest screen stays, as long as its port is free."""

from __future__ import annotations

import socket

from tangy_tui.app.bench_page import BenchPage


def test_a_page_keeps_its_port_unless_another_program_has_it() -> None:
    page = BenchPage()
    assert page.free_port() == 0
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        page.keep(f"http://127.0.0.1:{port}/")
        assert page.free_port() == 0
    assert page.free_port() == port
    page.keep("")  # a robot without a chest screen
    assert page.port == port


def test_each_page_has_a_pairing_of_its_own() -> None:
    assert BenchPage().pairing != BenchPage().pairing
