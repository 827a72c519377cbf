"""Detection of sentences that stop the robot or the game, as opposed to mentions of stopping.

The rules know the verbs of stopping, and look at their objects. These stop the robot: no object
("stop"), the robot, its movements, the game, and how quickly ("stop right away"). These do not:
actions of people ("stop teasing her"), other things ("stop the music"), places ("stop at the
table"), negations ("don't stop") and reports ("the rain has stopped"). What was learnt
(`stop_likelihood`) judges sentences without such a verb ("that'll do now"), and those with one
that the rules do not know ("please to stop now"), if it is almost certain. If in doubt the robot
stops, because a stopped robot hurts nobody.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from functools import cache

from tangy_tui.language.answers import yes_or_no
from tangy_tui.language.steering import steering_of
from tangy_tui.language.stop_likelihood import stop_likelihood
from tangy_tui.language.stop_patterns import (
    ASKS_FIRST,
    CRIES,
    ENDS_A_THOUGHT,
    FORBIDS,
    NO_COMMAND_AFTER,
    NO_CRY_AFTER,
    NO_CRY_BEFORE,
    REPORTS_OR_ASKS,
    alarm,
    before,
    command,
    cry,
    own_words,
    sentence,
)
from tangy_tui.language.words import LONGEST_TEXT, likeness, run_together, words_of

STOPS = (
    *("stop", "stop now", "stop tangy", "tangy stop", "stop stop", "stop stop stop", "halt"),
    *("no stop", "oh stop", "wait stop", "please stop", "stop it", "stop that", "stop right now"),
    *("stop right there", "stop please", "stop what you are doing", "i said stop", "stop moving"),
    *("stop the robot", "stop that robot", "stop the robot now", "please stop the robot"),
    *("robot stop", "make the robot stop", "emergency stop", "emergency", "stop the game"),
    *("stop this game", "stop the game now", "make it stop", "stop right away", "stop at once"),
    *("stop immediately", "stop this", "stop everything", "stop driving", "stop where you are"),
    *("stop the machine", "stand still", "freeze", "halt the robot", "stop that machine"),
    *("stop that thing", "stop this thing", "stop it right there", "stop it now", "stop it please"),
    *("get it to stop", "tell it to stop", "get the robot to stop", "tell the robot to stop"),
    *("i want it to stop", "i want the robot to stop", "i want you to stop"),
    *("can you stop the robot", "could you stop that", "would you stop it please"),
    *("can we stop now", "can we stop the game", "we want to stop", "you have to stop"),
    *("somebody stop it", "somebody stop the robot", "everybody stop", "no no stop"),
    *("tangy stop moving", "stop moving now", "stop turning", "stop rolling", "stop going"),
    *("switch it off", "switch the robot off", "turn it off", "turn the robot off"),
    *("do not move", "do not come closer", "emergency stop now", "tangy stand still"),
)
"""The most usual stop commands, which speech recognition listens for first."""

TELLING = ("the", "robot", "machine", "game", "emergency", "everything", "immediately")
"""Words whose misspellings are corrected."""
SAME_WORD = 0.7  # similarity from which an unknown word counts as a misspelling
LIKELY = 0.6  # likelihood from which words without a verb of stopping stop the robot
ALMOST_CERTAIN = 0.95  # likelihood from which words with one do that the rules do not know
# The second was chosen with each written set left out of the training once.
FEWEST, MOST = 3, 30  # words of what is judged so; fewer are mostly commands to the program
_VERB = re.compile(r"\b(?:stop|halt)")
_NEGATED = re.compile(r"(?:\bnot|nt|\bnever)(?: \w+){0,2} (?:stop|halt)")  # "dont ever stop"
_PAUSES = re.compile(r"[.!?;:,\n\u2026\u2013\u2014]+|\s-+\s")
_CLEAR = re.compile(r"\b(?:robot|machine|game|emergency stop|stop tangy)$")
_DRAWN_OUT = re.compile("s+t+o+p+")
_LETTERS = sorted("stop")
_WORDS_OF_THESE_LETTERS = frozenset(("opts", "post", "pots", "spot", "tops"))


def stops(text: str, game: Collection[str] = ()) -> bool:
    """Return whether a typed or spoken sentence stops the robot.

    Args:
        text: the sentence.
        game: the words of the activity's title, in lower case, which mean the game.
    """
    if stops_by_rules(text, game):
        return True
    whole = _joined(words_of(text))
    by_rules_alone = not FEWEST <= len(whole.split(" ")) <= MOST or _NEGATED.search(whole)
    if by_rules_alone or steering_of(text) is not None or yes_or_no(text) is not None:
        return False
    needed = ALMOST_CERTAIN if _VERB.search(whole) else LIKELY
    return likelihood(text, game) >= needed


def stops_by_rules(text: str, game: Collection[str] = ()) -> bool:
    """Return whether a sentence stops the robot by the rules alone, without what was learnt."""
    whole = _joined(words_of(text))
    parts = (_joined(words_of(part)) for part in _PAUSES.split(text[:LONGEST_TEXT]))
    clauses = dict.fromkeys((*parts, whole))
    aimed = any(_is_aimed(_mended(clause, game)) for clause in clauses if clause)
    return aimed or whole.replace(" ", "") in _run_together()


def prepare() -> None:
    """Compile the patterns and load the model in advance, which takes two tenths of a second."""
    stops(STOPS[0])
    likelihood(STOPS[0])


def stops_whatever_follows(words: str) -> bool:
    """Return whether the words so far stop the robot, whatever words follow."""
    return bool(_CLEAR.search(words)) and stops(words)


def likelihood(text: str, game: Collection[str] = ()) -> float:
    """Return the probability, from 0 to 1, that words stop the robot, by what was learnt alone."""
    return stop_likelihood(tuple(_mended(_joined(words_of(text)), game).split(" ")))


def _is_aimed(clause: str) -> bool:
    """Return whether a clause stops the robot, after any calls and requests."""
    seen, reached = {0}, [0]
    while reached:
        at = reached.pop()
        if sentence().fullmatch(clause, at):
            return True
        ends = {found.end() for found in (p.match(clause, at) for p in before()) if found}
        if (said := command().match(clause, at)) and clause[said.end() :].startswith(" "):
            ends.add(said.end() + 1)  # it may be repeated
        reached += ends - seen
        seen |= ends
    return _is_two_words(clause) or _ends_in_a_cry(clause) or _ends_in_a_command(clause)


def _is_two_words(clause: str) -> bool:
    """Return whether a clause is a cry with its object, or a name with a cry."""
    first, _, last = clause.partition(" ")
    if not last or " " in last:
        return False
    if first in CRIES:
        return last not in NO_CRY_BEFORE
    return last in CRIES and first not in NO_CRY_AFTER


def _ends_in_a_cry(clause: str) -> bool:
    """Return whether a clause ends in a cry to stop that is independent of the words before."""
    found = cry().fullmatch(clause)
    if found is None or ASKS_FIRST.match(clause):
        return False
    words = found["before"].split(" ")
    if found["what"] and words[-1] in ENDS_A_THOUGHT and not FORBIDS.search(found["before"]):
        return True
    named = found["what"] not in (None, " it")
    if words[-1] in NO_CRY_AFTER or (not named and {"a", "an"}.intersection(words[-3:])):
        return False
    asks = len(words) > 2 and words[-1] == "please" and words[-2] not in NO_CRY_AFTER
    return asks or bool(found["what"]) or alarm().fullmatch(found["before"]) is not None


def _ends_in_a_command(clause: str) -> bool:
    """Return whether an alarmed clause ends in a stop command, as in "my foot hold it"."""
    if ASKS_FIRST.match(clause) or REPORTS_OR_ASKS.match(clause):
        return False
    words = clause.split(" ")
    for at in range(1, len(words)):
        first = " ".join(words[:at])
        told = words[at - 1] in NO_COMMAND_AFTER or FORBIDS.search(first)
        alarmed = not told and alarm().fullmatch(first)
        if alarmed and command().fullmatch(" ".join(words[at:])):
            return True
    return False


def _joined(words: Iterable[str]) -> str:
    return " ".join(word.replace("'", "") for word in words)


def _mended(clause: str, game: Collection[str]) -> str:
    """Correct misspellings, and replace the words of the activity's title by "game"."""
    return " ".join(_mend(word, game) for word in clause.split(" "))


def _mend(word: str, game: Collection[str]) -> str:
    if word in own_words():
        return word
    if word in game:
        return "game"
    if word[:1] == "t" and len(word) in (2, 3) and set(word) <= set("the"):
        return "the"
    hurried = sorted(word) == _LETTERS and word not in _WORDS_OF_THESE_LETTERS
    if hurried or _DRAWN_OUT.fullmatch(word):
        return "stop"
    return next((known for known in TELLING if likeness(word, known) >= SAME_WORD), word)


@cache
def _run_together() -> frozenset[str]:
    return frozenset(run_together(words_of(phrase)) for phrase in STOPS)
