"""Words for a map made from a log."""

from __future__ import annotations

from tangy_profiles.reading import plain

BETTER = (
    "Give a log of a smaller area, one that often returns to places it has seen, or one that a "
    "mapping program has corrected, without --match."
)


def refusal(path: str, why: str, picture: str) -> str:
    """Say why a matched map is not taken, what to do, and which picture shows it, if any."""
    shown = f" {picture} shows it." if picture else ""
    return plain(f"{path}: {why} {BETTER}{shown}")


def unknown_words() -> str:
    """Say that nobody can tell whether a map closes."""
    return (
        "nobody can tell whether the map closes. The robot came back to places, and no scan fits "
        "what it saw there before."
    )


def apart_words(metres: float, torn: int, closed: int) -> str:
    """Say how far apart the copies of a place are (metres), and how many scans say so or not."""
    return (
        f"the map does not close. Where the robot came back to a place, its poses are {metres:.1f} "
        f"m apart ({torn} scans; {closed} agree), so walls stand in the map twice."
    )


def contradicted_words(share: float, most: float) -> str:
    """Say which share of the beams contradicts a map, and how many may."""
    return (
        f"the map does not close. After matching, {share:.0%} of the beams contradict it (at most "
        f"{most:.0%} in a map that closed), so walls stand in it twice."
    )
