"""Requests by number keys, pressed by a person who watches the table."""

from __future__ import annotations

from tangy_hw.perception.requests.help_request_source import RequestSource


class Keyboard(RequestSource):
    """The program passes keys in; a seat's number toggles its request."""

    def press(self, key: str) -> bool:
        """Handle a key; return whether it belongs to a seat."""
        seat = int(key) if len(key) == 1 and key in "123456789" else 0
        if not 1 <= seat <= self.seats:
            return False
        if seat in self._asks:
            self._withdraw(seat)
        else:
            self._ask(seat)
        return True
