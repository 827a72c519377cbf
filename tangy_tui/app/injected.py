"""The faults that can be injected into a robot."""

from __future__ import annotations

from collections.abc import Iterable

from tangy_sim.worlds.injection import KINDS


def possible_kinds(codes: Iterable[str]) -> tuple[str, ...]:
    """Return the kinds of fault whose correct diagnosis is one of these codes."""
    known = set(codes)
    return tuple(name for name, kind in KINDS.items() if kind.code in known)
