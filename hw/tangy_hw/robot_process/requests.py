"""The requests to the robot process: a closed set, the same at both ends.

An immediate request is done when its line arrives; a deed takes time, and is answered at its end.
"""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

AtOnce = Literal["stop", "release", "seen to", "cancel", "drive", "show calls"]
AT_ONCE: tuple[AtOnce, ...] = get_args(AtOnce)

Deed = Literal[
    "perform",
    "go",
    "spin",
    "card",
    "face",
    "picture",
    "sights",
    "wait",
    "settle",
    "replan",
    "answered",
    "restart",
    "relax",
    "place",
    "fail",
]
DEEDS: tuple[Deed, ...] = get_args(Deed)

Request: TypeAlias = AtOnce | Deed


def at_once_of(asked: object) -> AtOnce | None:
    """Return the immediate request of a line."""
    return next((one for one in AT_ONCE if one == asked), None)


def deed_of(asked: object) -> Deed | None:
    """Return the lasting request of a line."""
    return next((one for one in DEEDS if one == asked), None)
