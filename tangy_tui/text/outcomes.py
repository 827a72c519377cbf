"""Words for played games: their faults, and the injections that did not occur."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tangy_tui.text.numbers import counted


def faults_logged(count: int) -> str:
    """Tell how many faults a live game had, and the command to see them."""
    return f"{counted(count, 'fault')}. Read more with `tangy log report last`."


def faults_played(count: int, critical: int) -> str:
    """Tell how many faults simulated games had, and the commands to see them."""
    return (
        f"{counted(count, 'fault')}, {critical} of them critical. "
        "`tangy log` lists the games, `tangy log report last` shows the last one."
    )


def fault_left(name: str) -> str:
    """Name the fault of the last game that nobody cleared."""
    return f"The last game ended with a fault that nobody has cleared: {name}."


def injecting_words(example: str) -> str:
    """Explain the syntax of a fault to inject."""
    return f"\nFor example: --inject {example}@12. After @ write a step, after ~ a chance."


def did_not_come(injected: object, times: int, games: int) -> str:
    """Tell in how many games an injected fault did not occur."""
    return f"{injected} did not come about in {times} of {counted(games, 'game')}."


def score_lines(score: Mapping[str, Any]) -> list[str]:
    """Format the recognition of injected faults: in total, and each miss."""
    lines = [
        f"Recognised: {_share_words(score['recall'])} of what could be noticed.",
        f"Right: {_share_words(score['precision'])} of what was said.",
    ]
    for kind, one in score["kinds"].items():
        if one["recall"]["n"] and one["recall"]["share"] < 1:
            lines.append(f"  {kind}: {_share_words(one['recall'])}")
    if score["false_alarms"]:
        told = ", ".join(f"{code} ({times})" for code, times in score["false_alarms"].items())
        lines.append(f"Without a cause: {told}.")
    return lines


def _share_words(share: Mapping[str, Any]) -> str:
    if not share["n"]:
        return "none"
    low, high = share["interval"]
    return f"{share['share']:.0%} ({low:.0%} to {high:.0%}, n {share['n']})"
