"""Pairs tablets with the chest screen: a tablet exchanges a short code for a token that it keeps.

The console shows the code to the people in charge of the robot. A token is signed with a key that
stays in the data folder, so it outlives the robot process and needs no list.
"""

from __future__ import annotations

import hashlib
import hmac
import json
import os
import re
import secrets
import time
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

DIGITS = 8  # of a code: at 500 guesses a minute, trying all takes months
KEY_BYTES = 32
MOST_WRONG, MOST_WRONG_OF_ALL = 5, 500  # wrong codes per window, from one address and in total
WINDOW_SECONDS = 60.0
MOST_ADDRESSES = 256  # for which wrong codes are remembered
FILE = "tablets.json"
LARGEST_FILE = 1000  # bytes
VIEWER = "v"  # prefix of the tokens of viewers
_TOKEN = re.compile(rf"({VIEWER}?[0-9a-f]{{16}})\.([0-9a-f]{{64}})")


class TooManyCodes(Exception):
    """There were too many wrong codes: none is checked for a while."""


@dataclass(frozen=True, slots=True)
class Pairing:
    """Secrets of pairing: the key that signs tokens, and the code on the console."""

    key: bytes = field(default_factory=lambda: secrets.token_bytes(KEY_BYTES), repr=False)
    code: str = field(
        default_factory=lambda: f"{secrets.randbelow(10**DIGITS):0{DIGITS}}", repr=False
    )

    @property
    def shown(self) -> str:
        """Code as people read it, in two groups."""
        return f"{self.code[: DIGITS // 2]}-{self.code[DIGITS // 2 :]}"

    @property
    def cookie(self) -> str:
        """Name of the cookie with a tablet's token; it depends on the key."""
        return f"tangy_{hashlib.sha256(self.key).hexdigest()[:8]}"

    def token(self, *, viewer: bool = False) -> str:
        """Make a token for another tablet of the robot, or for a `viewer`."""
        name = (VIEWER if viewer else "") + secrets.token_hex(8)
        return f"{name}.{self._signed(name)}"

    def knows(self, token: str) -> bool:
        """Return whether a token was made with this key."""
        found = _TOKEN.fullmatch(token)
        return found is not None and hmac.compare_digest(self._signed(found[1]), found[2])

    def is_viewer(self, token: str) -> bool:
        """Return whether a token was made for a viewer."""
        return token.startswith(VIEWER) and self.knows(token)

    def _signed(self, name: str) -> str:
        return hmac.new(self.key, name.encode(), hashlib.sha256).hexdigest()

    def to_json(self) -> dict[str, str]:
        """Return the secrets and the code, to be kept in a file and read by `from_json`."""
        return {"key": self.key.hex(), "code": self.code}

    @classmethod
    def from_json(cls, body: Mapping[str, object]) -> Pairing:
        """Read the output of `to_json`.

        Raises:
            ValueError: it is not a pairing.
        """
        key, code = body.get("key"), body.get("code")
        if not (isinstance(key, str) and isinstance(code, str)):
            raise ValueError("no pairing")
        read = bytes.fromhex(key)
        if len(read) != KEY_BYTES or not re.fullmatch(rf"[0-9]{{{DIGITS}}}", code):
            raise ValueError("no pairing")
        return cls(read, code)


class CodeCheck:
    """Checks entered codes, with a rate limit on wrong ones."""

    def __init__(self, code: str, clock: Callable[[], float] = time.monotonic) -> None:
        """Prepare to check a code; `clock` returns the time in s."""
        self._code = code.encode()
        self._clock = clock
        self._wrong: dict[str, deque[float]] = {}
        self._all: deque[float] = deque(maxlen=MOST_WRONG_OF_ALL)

    def right(self, entered: str, address: str) -> bool:
        """Return whether a code is correct; spaces and hyphens are ignored.

        Raises:
            TooManyCodes: too many wrong codes in a minute, from this address or in total.
        """
        since = self._clock() - WINDOW_SECONDS
        mine = self._wrong.get(address, deque())
        for times, most in ((mine, MOST_WRONG), (self._all, MOST_WRONG_OF_ALL)):
            while times and times[0] <= since:
                times.popleft()
            if len(times) >= most:
                raise TooManyCodes
        if hmac.compare_digest(re.sub(r"[\s-]", "", entered).encode(), self._code):
            self._wrong.pop(address, None)
            return True
        mine.append(self._clock())
        self._all.append(self._clock())
        self._wrong.pop(address, None)
        self._wrong[address] = mine
        while len(self._wrong) > MOST_ADDRESSES:
            del self._wrong[next(iter(self._wrong))]
        return False


def keep_pairing(folder: Path) -> Pairing:
    """Return the pairing stored in a data folder, or create and store a new one.

    If it cannot be stored, it is a new one each time. Deleting the file unpairs all tablets.
    """
    path = folder / FILE
    if (kept := _read(path)) is not None:
        return kept
    made = Pairing()
    begun = path.with_name(f".{FILE}.{os.getpid()}")
    try:
        with suppress(FileNotFoundError):
            begun.unlink()
        file = os.open(begun, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, 0o600)
        with os.fdopen(file, "w", encoding="utf-8") as writing:
            writing.write(json.dumps(made.to_json()) + "\n")
        try:
            os.link(begun, path)  # another process may have been first: its pairing wins
        except FileExistsError:
            if (kept := _read(path)) is not None:
                return kept
            begun.replace(path)  # the file was damaged
    except OSError:
        return made
    finally:
        with suppress(OSError):
            begun.unlink()
    return made


def _read(path: Path) -> Pairing | None:
    """Read a stored pairing; None if there is no valid one."""
    try:
        file = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return None
    with os.fdopen(file, "rb") as reading:
        try:
            body = json.loads(reading.read(LARGEST_FILE))
            return Pairing.from_json(body if isinstance(body, dict) else {})
        except (OSError, ValueError, RecursionError):
            return None
