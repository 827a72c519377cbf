"""Pairing of tablets with the chest screen: a short code, once, for a token that the tablet keeps.

The code stands on the console; who can read it is in charge of the robot. A token is signed with a
key that stays in the data folder, so that it outlasts the robot process and needs no list.
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

DIGITS = 8  # of a code: at 500 a minute, all of them take months of trying
KEY_BYTES = 32
MOST_WRONG, MOST_WRONG_OF_ALL = 5, 500  # codes, from one address and from all, in a window
WINDOW_SECONDS = 60.0
MOST_ADDRESSES = 256  # whose wrong codes are remembered
FILE = "tablets.json"
LARGEST_FILE = 1000  # bytes
VIEWER = "v"  # begins the token of a page that only looks on
_TOKEN = re.compile(rf"({VIEWER}?[0-9a-f]{{16}})\.([0-9a-f]{{64}})")


class TooManyCodes(Exception):
    """There were too many wrong codes: none is looked at for a while."""


@dataclass(frozen=True, slots=True)
class Pairing:
    """The secrets of pairing: the key that signs tokens, and the code on the console."""

    key: bytes = field(default_factory=lambda: secrets.token_bytes(KEY_BYTES), repr=False)
    code: str = field(
        default_factory=lambda: f"{secrets.randbelow(10**DIGITS):0{DIGITS}}", repr=False
    )

    @property
    def shown(self) -> str:
        """The code as people read it: in two groups, that no line breaks between."""
        return f"{self.code[: DIGITS // 2]}-{self.code[DIGITS // 2 :]}"

    @property
    def cookie(self) -> str:
        """The name under which a tablet keeps its token; another key has another one."""
        return f"tangy_{hashlib.sha256(self.key).hexdigest()[:8]}"

    def token(self, *, viewer: bool = False) -> str:
        """Make a token for one more tablet of the robot, or for a `viewer` who only looks on."""
        name = (VIEWER if viewer else "") + secrets.token_hex(8)
        return f"{name}.{self._signed(name)}"

    def knows(self, token: str) -> bool:
        """Say whether a token was made with this key."""
        found = _TOKEN.fullmatch(token)
        return found is not None and hmac.compare_digest(self._signed(found[1]), found[2])

    def is_viewer(self, token: str) -> bool:
        """Say whether a token was made for somebody who only looks on."""
        return token.startswith(VIEWER) and self.knows(token)

    def _signed(self, name: str) -> str:
        return hmac.new(self.key, name.encode(), hashlib.sha256).hexdigest()

    def to_json(self) -> dict[str, str]:
        """Return it as JSON keeps it."""
        return {"key": self.key.hex(), "code": self.code}

    @classmethod
    def from_json(cls, body: Mapping[str, object]) -> Pairing:
        """Read what `to_json` wrote.

        Raises:
            ValueError: it is no pairing.
        """
        key, code = body.get("key"), body.get("code")
        if not (isinstance(key, str) and isinstance(code, str)):
            raise ValueError("no pairing")
        read = bytes.fromhex(key)
        if len(read) != KEY_BYTES or not re.fullmatch(rf"[0-9]{{{DIGITS}}}", code):
            raise ValueError("no pairing")
        return cls(read, code)


class CodeCheck:
    """Looks at the codes that are entered, and at so many wrong ones only."""

    def __init__(self, code: str, clock: Callable[[], float] = time.monotonic) -> None:
        """Prepare for a code; `clock` gives the time in s."""
        self._code = code.encode()
        self._clock = clock
        self._wrong: dict[str, deque[float]] = {}
        self._all: deque[float] = deque(maxlen=MOST_WRONG_OF_ALL)

    def right(self, entered: str, address: str) -> bool:
        """Say whether a code is the right one; blanks and hyphens in it do not count.

        Raises:
            TooManyCodes: too many wrong ones came within a minute, from this address or from all.
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
    """Return the pairing of a data folder: the one that was kept, or a new one, which is kept.

    Where nothing can be kept it is new each time. Deleting the file unpairs all tablets.
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
            os.link(begun, path)  # another program may have been first: its pairing holds
        except FileExistsError:
            if (kept := _read(path)) is not None:
                return kept
            begun.replace(path)  # it was damaged
    except OSError:
        return made
    finally:
        with suppress(OSError):
            begun.unlink()
    return made


def _read(path: Path) -> Pairing | None:
    """Read a stored pairing; None if none can be read."""
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
