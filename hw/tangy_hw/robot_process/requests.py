"""The requests to the robot process: a closed set, the same at both ends.

An immediate request is done when its line arrives; a lasting one is answered at its end.
"""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

ImmediateRequest = Literal["stop", "release", "seen to", "cancel", "drive", "show calls"]
IMMEDIATE_REQUESTS: tuple[ImmediateRequest, ...] = get_args(ImmediateRequest)

LastingRequest = Literal[
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
LASTING_REQUESTS: tuple[LastingRequest, ...] = get_args(LastingRequest)

Request: TypeAlias = ImmediateRequest | LastingRequest


def immediate_request(asked: object) -> ImmediateRequest | None:
    """Return the immediate request of a line."""
    return next((one for one in IMMEDIATE_REQUESTS if one == asked), None)


def lasting_request(asked: object) -> LastingRequest | None:
    """Return the lasting request of a line."""
    return next((one for one in LASTING_REQUESTS if one == asked), None)
