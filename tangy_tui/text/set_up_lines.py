"""Words of the set-up by lines: its commands, and the answers to those that it does not take."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from tangy_profiles.reading import plain
from tangy_tui.app.readiness import Check
from tangy_tui.app.set_up import SetUp
from tangy_tui.text.set_up import NAMES, STOPPED

UNCHANGED = "That changes nothing."
COMMANDS: Mapping[str, str] = {
    **{word: f"{word} Rosa" for word in ("left", "here")},
    **{word: f"{word} Anna" for word in ("guest", "add")},
    "seat": "seat Rosa 3",
    "rename": "rename Rosa to Rosie",
    "activity": "activity trivia",
    "activities": "activities",
    "room": "room hall",
    "rooms": "rooms",
    "play": "play for line, full card",
    "patterns": "patterns",
    "several": "several winners",
    "one": "one winner",
    "pace": "pace 20",
    "faster": "faster",
    "slower": "slower",
    "visits": "visits on",
    "words": "words gentle",
    "time": "time 40",
    "duty": "duty Nina",
    "show": "show",
    "try": "try",
    "help": "help",
    "begin": "begin",
    "end": "end",
}
"""An example of each command of the set-up by lines, by its first word."""
WITH_CALLS = frozenset({"several", "one", "pace", "faster", "slower", "visits"})
WITH_PATTERNS = frozenset({"play", "patterns"})
NOT_FOR_TEAMS = frozenset({"guest", "add", "rename"})
NAMED_APART = ("activities", "rooms", "patterns", "one", "faster", "slower")
"""Commands that help leaves out because it names similar ones."""
LAST = ("show", "try", "help", "begin", "end")
"""Commands that it names in sentences of their own."""


def commands_of(setup: SetUp) -> dict[str, str]:
    """Return the examples of the commands that make sense for the chosen activity."""
    rules, left_out = setup.workspace.activity.rules, set[str]()
    if not setup.calls:
        left_out |= WITH_CALLS
    if not rules.patterns:
        left_out |= WITH_PATTERNS
    if not rules.strengths:
        left_out.add("words")
    if setup.teams_play:
        left_out |= NOT_FOR_TEAMS
    return {word: example for word, example in COMMANDS.items() if word not in left_out}


def help_words(setup: SetUp) -> str:
    """List the commands for the chosen activity."""
    known = commands_of(setup)
    choices = [known[word] for word in known if word not in (*NAMED_APART, *LAST)]
    tried = "cards, faces and sound" if setup.calls else "faces and sound"
    return (
        f"Type: {', '.join(choices)}. Show lists everything again. Try switches Tangy on, so that "
        f"you can try {tried}. Then: begin. Or: end."
    )


def not_known_words(typed: str, near: str, known: Mapping[str, str] = COMMANDS) -> str:
    """Tell that a line is no command of the set-up, and the command that it may have meant.

    Args:
        typed: the line.
        near: the first word of the command; "" if none is similar.
        known: an example of each command, by its first word.
    """
    first, example = typed.partition(" ")[0].casefold(), known.get(near, "")
    if near == first:
        return plain(f"Tangy does not understand '{typed[:60]}'. Type it like this: {example}.")
    meant = f"Did you mean: {example}?" if example else "help lists all commands."
    return plain(f"Tangy does not know '{typed[:60]}'. {meant} All that you chose is kept.")


def in_a_game_words(typed: str) -> str:
    """Tell that a command works only in a game."""
    return plain(f"'{typed[:60]}' works in a game. Nothing moves yet: begin starts it.")


def no_seat_words(seats: int) -> str:
    """Tell which seats there are."""
    return f"The seats have the numbers 1 to {seats}."


def patterns_to_choose(names: Iterable[str]) -> str:
    """List the patterns to choose from."""
    labels = ", ".join(names)
    if not labels:
        return "This activity has no patterns to choose."
    return f"You can play for: {labels}. Type: play for, and one or more of them."


def lines_anyway(not_ready: Sequence[Check]) -> str:
    """Name the failed checks, and ask whether to begin in spite of them."""
    names = ", ".join(NAMES[check.name] for check in not_ready).lower()
    return f"Not ready: {names}. Type begin to begin anyway, or end."


def lines_stopped() -> str:
    """Tell that the robot was stopped before the game, and how to begin or leave."""
    return f"{STOPPED} Type begin, or end."


def begin_or_end(typed: str) -> str:
    """Ask again after a line that is neither."""
    return plain(f"I do not know '{typed[:60]}' here. Type begin to begin anyway, or end.")


def activities_line(titles: Iterable[str]) -> str:
    """List the activities to choose from."""
    return f"You can play: {', '.join(titles)}. Type: activity, and one of them."


def rooms_line(names: Iterable[str]) -> str:
    """List the rooms to choose from."""
    return f"There are these rooms: {', '.join(names)}. Type: room, and one of them."
