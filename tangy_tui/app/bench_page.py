"""The chest screen of a bench, which a tablet finds again after the bench was opened anew."""

from __future__ import annotations

import socket
from contextlib import suppress
from dataclasses import dataclass, field
from urllib.parse import urlsplit

from tangy_hw.drivers.chest_pairing import Pairing


@dataclass
class BenchPage:
    """The address of a bench's chest screen, which stays the same if the bench is opened again."""

    pairing: Pairing = field(default_factory=Pairing)
    port: int = 0
    """0: any free port."""

    def free_port(self) -> int:
        """Return the port, or 0 if another program has it by now."""
        with socket.socket() as tried, suppress(OSError):
            tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            tried.bind(("", self.port))
            return self.port
        return 0

    def keep(self, address: str) -> None:
        """Keep the port of an address, if there is one."""
        self.port = urlsplit(address).port or self.port
