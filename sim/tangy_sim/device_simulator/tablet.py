"""A simulated tablet that opens the page of the chest screen, and acknowledges its events.

A thread does what a browser with the open page does: it pairs once with the code, receives the
events of the page, and acknowledges each as drawn.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from contextlib import suppress
from http.client import NO_CONTENT, OK, HTTPConnection, HTTPException
from typing import Any
from urllib.parse import urlencode, urlsplit

SECONDS = 2.0  # without an event, after which the page is opened again


class Tablet:
    """A tablet that shows a page until it is closed; `picture` is its content."""

    def __init__(self, url: str, code: str, shown: Callable[[str], object] = str) -> None:
        """Open the page at an address, and pair with a code.

        `shown` is called with the text of each picture once it is drawn.
        """
        self._shown = shown
        self._code = code
        self._cookie = ""
        self._number = 0
        parts = urlsplit(url)
        self._place = (parts.hostname or "127.0.0.1", parts.port or 80)
        self.picture: dict[str, Any] = {}
        self.calls: dict[str, str] = {}
        """Whom a button is shown for, by the key of their call."""
        self.on = True
        """Whether it is switched on; otherwise it answers and shows nothing."""
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, name="tablet", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Close the page."""
        self._over.set()
        self._thread.join()

    def press(self, key: str) -> bool:
        """Press the button of a call; return whether the robot took the answer."""
        asks = HTTPConnection(*self._place, timeout=SECONDS)
        try:
            head = {"Cookie": self._cookie}
            asks.request("POST", f"/answer?{urlencode({'call': key})}", headers=head)
            return asks.getresponse().status == NO_CONTENT
        finally:
            asks.close()

    def _run(self) -> None:
        while not self._over.wait(0.05):
            if self.on:
                with suppress(OSError, HTTPException, ValueError):
                    self._show()

    def _show(self) -> None:
        page = HTTPConnection(*self._place, timeout=SECONDS)
        answers = HTTPConnection(*self._place, timeout=SECONDS)
        try:
            if not self._paired(answers):
                return
            page.request("GET", "/events?page=bench", headers={"Cookie": self._cookie})
            told, kind = page.getresponse(), ""
            if told.status != OK:
                return
            while self.on and not self._over.is_set():
                line = told.readline().decode()
                if not line:
                    return
                if line.startswith("event:"):
                    kind = line.partition(":")[2].strip()
                elif line.startswith("data:"):
                    self._answer(answers, kind, line.partition(":")[2].strip())
        finally:
            page.close()
            answers.close()

    def _paired(self, asks: HTTPConnection) -> bool:
        """Pair if necessary; return whether it is paired."""
        if not self._cookie:
            asks.request("POST", "/pair", body=self._code)
            said = asks.getresponse()
            said.read()
            self._cookie = (said.getheader("Set-Cookie") or "").partition(";")[0]
        return bool(self._cookie)

    def _answer(self, answers: HTTPConnection, kind: str, data: str) -> None:
        if kind == "calls":
            self.calls = json.loads(data)
            return
        number = data
        if kind == "show":
            self.picture = json.loads(data)
            number = str(self.picture["n"])
        head = {"Cookie": self._cookie}
        answers.request("POST", f"/seen?page=bench&number={number}", headers=head)
        answers.getresponse().read()
        if kind == "show" and int(number) > self._number:  # not a repetition
            self._number = int(number)
            self._shown(str(self.picture["text"]))
