"""The question about old games of which the log does not tell where they were played."""

from __future__ import annotations

from tangy_tui.text.numbers import counted

SIMULATED = ("simulated", "simulated", "in the room on the screen")
BENCH = ("bench", "on the bench", "with simulated devices")
LIVE = ("live", "live", "with a robot, among people")
UNKNOWN = ("unknown", "nobody knows", "they count for none of these; this is not asked again")
LATER = "You can say it later, game by game: tangy log world 3 live."


def question(games: int) -> str:
    """Ask where old games were played."""
    return f"Where was this played? {counted(games, 'old game')} without a place in the log"


def settled_words(games: int, world: str) -> str:
    """Say what the games count as from now on."""
    counts = "counts" if games == 1 else "count"
    return f"{counted(games, 'game')} now {counts} as {world}. {LATER}"


def unknown_words(games: int) -> str:
    """Say, below a list, of how many games nobody knows where they were played."""
    verb = "was" if games == 1 else "were"
    told = f"The log does not tell where {counted(games, 'game')} {verb} played (?)"
    return f"{told}: tangy log world unknown live says it of all of them."
