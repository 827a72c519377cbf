"""Formats of counts, shares and lists, the same in every sentence."""

from __future__ import annotations

from collections.abc import Iterable

_OFTEN = {0: "never", 1: "once", 2: "twice"}
_ORDINALS = {1: "first", 2: "second", 3: "third"}


def counted(number: int, noun: str, nouns: str = "") -> str:
    """Format a number with its noun: "1 step", "2 steps", "3,725 entries".

    Args:
        number: the number.
        noun: the singular.
        nouns: the plural, if it is not the singular with an "s".
    """
    return f"{number:,} {noun if number == 1 else nouns or noun + 's'}"


def often(times: int) -> str:
    """Tell how often something happened: "once", "twice", "3 times"; "never" for 0."""
    return _OFTEN.get(times, f"{times:,} times")


def of_times(part: int, times: int) -> str:
    """Tell how often of how many times something happened: "1 of 1 times", "7 of 9 times"."""
    return f"{part:,} of {times:,} times"


def ordinal(number: int) -> str:
    """Format an ordinal number: "second", "4th", "21st"."""
    if number in _ORDINALS:
        return _ORDINALS[number]
    ends = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10)
    return f"{number}{ends or 'th'}"


def number(value: float | None, digits: int = 2) -> str:
    """Format a number, or a dash for None."""
    return "\N{EN DASH}" if value is None else f"{value:.{digits}f}"


def percent(share: float | None) -> str:
    """Format a share (0 to 1) as a percentage with one decimal at most, or a dash for None.

    Shares close to 0 or 1 are not rounded to them.
    """
    if share is None:
        return "\N{EN DASH}"
    if 0 < share < 0.001:
        return "<0.1%"
    if 0.999 < share < 1:
        return ">99.9%"
    return f"{100 * share:.1f}".removesuffix(".0") + "%"


def listed(things: Iterable[object], last: str = "and") -> str:
    """Format a list as in speech: "1", "1 and 2", "1, 2 and 3"; "" if it is empty."""
    *most, end = [str(thing) for thing in things] or [""]
    return f"{', '.join(most)} {last} {end}" if most else end
