"""Connections of a simulated device, which a fault cuts."""

from __future__ import annotations

from typing import Generic, Protocol, TypeVar


class Cuttable(Protocol):
    """A connection that can be cut from this end."""

    def cut(self) -> None:
        """Close it at once."""
        ...


ConnectionT = TypeVar("ConnectionT", bound=Cuttable)


class Connections(Generic[ConnectionT]):
    """The open connections of a device; setting `closed` cuts them.

    The device itself has to cut each new connection while it is `closed`.
    """

    def __init__(self) -> None:
        self.connections: set[ConnectionT] = set()
        self._closed = False

    @property
    def closed(self) -> bool:
        """Whether connections are cut."""
        return self._closed

    @closed.setter
    def closed(self, so: bool) -> None:
        self._closed = so
        if so:
            self.cut()

    def cut(self) -> None:
        """Cut all connections that are open now."""
        for one in tuple(self.connections):
            one.cut()
