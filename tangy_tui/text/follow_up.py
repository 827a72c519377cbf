"""Follow-up commands in messages, with the options of the present call."""

from __future__ import annotations

import re
import shlex

from tangy_profiles.plain_text import plain

ACTIVITY, DATA, UNFINISHED = "activity", "data", "unfinished"
_OF_AN_ACTIVITY = ("teach", "learn", "policy", "demonstrations", "play", "live")
_OF_A_FOLDER = (*_OF_AN_ACTIVITY, "report", "log", "people", "store", "watch")
_OF_UNFINISHED = ("learn", "demonstrations conflicts", "demonstrations resolve")
_COMMAND = re.compile(r"`tangy ([a-z]+(?: [a-z]+)?)([^`]*)`")


def follow_up(words: str, *, activity: str = "", data: str = "", unfinished: bool = False) -> str:
    """Add the options of the present call to each command that a message names in backticks.

    Args:
        words: the message.
        activity: the name or file of the call's activity; "" if it is the chosen one.
        data: its data folder; "" if it is the usual one.
        unfinished: whether the call used unfinished demonstrations.
    """

    def with_options(found: re.Match[str]) -> str:
        command = found[1]
        verb = command.split()[0]
        given = ["--unfinished"] if unfinished and command in _OF_UNFINISHED else []
        if activity and verb in _OF_AN_ACTIVITY and f"--{ACTIVITY}" not in found[2]:
            given.append(f"--{ACTIVITY} {shlex.quote(activity)}")
        if data and verb in _OF_A_FOLDER and f"--{DATA}" not in found[2]:
            given.append(f"--{DATA} {shlex.quote(data)}")
        return plain(f"`tangy {' '.join([command + found[2], *given])}`")

    return _COMMAND.sub(with_options, words)
