"""Commands that are similar to words which are none: suggestions for staff who type in a game."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from difflib import get_close_matches

from tangy_profiles.errors import TangyError
from tangy_profiles.game_rules import NO_RULES, GameRules
from tangy_tui.app.claim_grammar import CHECK
from tangy_tui.app.command_grammar import FIXED, read_command
from tangy_tui.app.inquiry_grammar import read_inquiry
from tangy_tui.app.offered import EVERYTHING, Need, needs_of
from tangy_tui.app.word_frames import words_in

NEAR = 0.75  # least similarity of a whole line: some commands move the robot
NEAR_WORD = 0.8  # least similarity of a word
MOST = 3
"""The most suggestions."""
BEGUN = ("autonomy", "drive")
"""The beginnings of commands that have to go on."""

COMMANDS: dict[str, tuple[str, ...]] = {
    "slower": ("slow", "slower", "slowly", "too fast", "too quick", "so fast", "so quickly"),
    "faster": ("fast", "faster", "quick", "quicker", "quickly", "speed", "hurry", "too slow"),
    "pause": ("pause", "break", "wait", "rest", "hold on", "coffee", "tea", "lunch"),
    "go on": ("continue", "resume", "proceed", "start"),
    "call again": ("again", "repeat", "louder", "hear", "heard", "catch", "missed"),
    "take back": ("undo", "wrong", "mistake", "back"),
    "take over": ("control", "myself"),
    "stop": ("fell", "fallen", "fainted", "collapsed", "accident", "emergency", "ambulance"),
    "end": ("finish", "finished", "quit", "exit", "over", "end"),
    "why": ("why", "reason", "what", "doing", "happening", "happens", "next", "explain"),
    "one winner": ("winner", "single"),
    "several winners": ("winners",),
    "visits on": ("visit", "visits"),
}
"""Words that hint at a command without a person."""

OPPOSITE = {"slower": "faster", "faster": "slower"}
"""Commands of which only one can be meant; two words in a row decide ("too fast" is slower)."""

ABOUT_PERSON: dict[str, tuple[str, ...]] = {
    "ask for {name}": ("help", "helps", "needs", "need", "ask", "asks", "assist", "visit", "go"),
    "left {name}": (
        *("left", "gone", "leaves", "leave", "leaving", "went", "away", "out", "remove"),
        *("goodbye", "bye", "bed", "home", "toilet", "bathroom", "loo", "doctor", "visitors"),
        *("tired", "sleepy", "sleeps", "asleep", "unwell", "ill", "sick", "finished", "enough"),
        *("stop playing", "not play", "no longer", "any more", "anymore", "not well"),
        *("not feel", "not feeling", "feels bad", "had enough", "wants to rest", "a rest"),
    ),
    "here {name}": (
        *("here", "back", "came", "come", "comes", "coming", "arrived", "arrives", "in"),
        *("returned", "returns", "joined", "joins", "welcome"),
    ),
    "{claim} {name}": ("won", "wins", "win", "winner", "check", "finished", "claim"),
    "{name} has card 17": ("card", "cards", "holds"),
    "void {name}": ("void", "response", "answer"),
}
"""Words that hint at a command about a person."""

OF_SEVERAL = ("left {name}", "here {name}")
"""The commands that take several names."""

NUMBERED: dict[str, tuple[str, ...]] = {
    "pace {number}": ("pace", "seconds", "second", "every", "interval"),
    "{claim} {number}": ("card", "check", "claim"),
}
"""Words that hint at a command with a number."""

PLAIN_NUMBERS = {"pace {number}": 20, "{claim} {number}": 17}
"""The numbers of examples."""


def nearest_command(text: str) -> str:
    """Return the command most similar to some words, "" if none is close."""
    words = text.casefold().strip()
    close = get_close_matches(words, [*FIXED, "stop", *BEGUN], 1, NEAR)
    return close[0] if close else ""


def nearest_commands(
    text: str,
    names: Sequence[str] = (),
    rules: GameRules = NO_RULES,
    offers: Collection[Need] = EVERYTHING,
) -> tuple[str, ...]:
    """Return commands that words may mean, the likeliest first; () if none is close.

    Args:
        text: the words that are no command.
        names: the names of the people.
        rules: the choices that the activity gives staff.
        offers: what the game has; commands that need something else are left out.
    """
    found = dict.fromkeys((nearest_command(text), *_hinted(text, names, rules.claim or CHECK)))
    return tuple(one for one in found if _is_offered(one, rules, offers))[:MOST]


def _is_offered(near: str, rules: GameRules, offers: Collection[Need]) -> bool:
    """Return whether a game takes what would be suggested."""
    try:
        command = read_command(near, str, rules=rules)
    except TangyError:  # such as a pace that is too long
        return False
    if command is None:
        return near in BEGUN or read_inquiry(near) is not None
    return needs_of(type(command)) <= {*offers}


def _hinted(text: str, names: Sequence[str], claim: str) -> Iterator[str]:
    """Yield the commands that single words hint at; those about a person first."""
    words = [*words_in(text.replace("-", " "))]
    words = ["claim" if word == claim.casefold() else word for word in words]
    number = next((word for word in words if word.isascii() and word.isdecimal()), "")
    found = _named(words, names)
    for command, hints in ABOUT_PERSON.items() if found else ():
        if _hints(words, hints):
            who = [_joined(found)] if command in OF_SEVERAL else found
            yield from (command.format(name=name, claim=claim) for name in who)
    if number or not found:
        for command, hints in NUMBERED.items():
            if _hints(words, hints):
                yield command.format(number=number or PLAIN_NUMBERS[command], claim=claim)
    hinted = [one for one, hints in COMMANDS.items() if not found and _hints(words, hints)]
    yield from (one for one in hinted if OPPOSITE.get(one) not in hinted or _in_two(words, one))


def _in_two(words: Sequence[str], command: str) -> bool:
    """Return whether two words in a row hint at a command: "too fast"."""
    spoken = f" {' '.join(words)} "
    return any(f" {hint} " in spoken for hint in COMMANDS[command] if " " in hint)


def _hints(words: Sequence[str], hints: Sequence[str]) -> bool:
    spoken, hints = f" {' '.join(words)} ", [*hints]
    if any(f" {hint} " in spoken for hint in hints if " " in hint):
        return True
    hints = [hint for hint in hints if " " not in hint]
    return any(
        word in hints
        or (len(word) > len("back") and get_close_matches(word, hints, 1, NEAR_WORD))
        or (len(word) > len("le") and any(hint[:-1] == word for hint in hints))
        for word in words
    )


def _named(words: Sequence[str], names: Sequence[str]) -> list[str]:
    """Return the names that words contain, in full, or a word of them, or one misspelt."""
    spoken = f" {' '.join(words)} "
    full = [name for name in names if f" {name.casefold()} " in spoken]
    first = [name for name in names if set(name.casefold().split()) & set(words)]
    if full or first:
        return full or first
    firsts = {name.casefold().split()[0]: name for name in names if name.split()}
    near = (get_close_matches(word, firsts, 1, NEAR_WORD) for word in words)
    return list(dict.fromkeys(firsts[one[0]] for one in near if one))


def _joined(names: Sequence[str]) -> str:
    """Return names as a command takes them: "Ida, Otto and Rosa"."""
    *most, last = names
    return f"{', '.join(most)} and {last}" if most else last
