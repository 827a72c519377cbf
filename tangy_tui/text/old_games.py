"""The question where old games were played, if the log does not tell."""

from __future__ import annotations

from tangy_tui.text.numbers import counted

SIMULATED = ("simulated", "simulated", "in the room on the screen")
BENCH = ("bench", "on the bench", "with simulated devices")
LIVE = ("live", "live", "with a robot, among people")
UNKNOWN = ("unknown", "nobody knows", "they count for none of these; Tangy does not ask again")
LATER = "You can change it later, game by game: tangy log world 3 live."


def question(games: int) -> str:
    """Ask where old games were played."""
    return f"Where did you play {counted(games, 'old game')}? The log does not say."


def settled_words(games: int, world: str) -> str:
    """Tell in which world the games now count."""
    counts = "counts" if games == 1 else "count"
    return f"{counted(games, 'game')} now {counts} as {world}. {LATER}"


def unknown_words(games: int) -> str:
    """Tell, below a list, for how many games the log does not tell the world."""
    verb = "was" if games == 1 else "were"
    told = f"The log does not say where {counted(games, 'game')} {verb} played (?)"
    return f"{told}. To set all of them: tangy log world unknown live."
