"""The grammar of requests in free wording: slower, faster, a pause, the number again, a fall.

They become the commands that staff could type (see `command_grammar`), and only those that hurt
nobody if they were meant otherwise. `word_frames` tells how they are read.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import suppress

from tangy_profiles.errors import TangyError
from tangy_tui.app.game_commands import CallAgain, ChangePace, GameCommand, Pause
from tangy_tui.app.word_frames import ASKS_BY, COULD_BE_ASKED, Bag, one_of, words_in

_POLITE_BEFORE = re.compile(r"(?:please|ok(?:ay)?|tangy)(?:,\s*|\s+)(?=\S)", re.I)
_POLITE_AFTER = re.compile(r"(?<=\w)(?:,\s*|\s+)(?:please|thank you|thanks|tangy)[ .!]*$", re.I)

_ASKS = ASKS_BY - COULD_BE_ASKED
_PACE_WORDS = one_of(
    "go going goes for a bit little much down up call calling calls talk talking numbers number"
    " pace way everybody everyone people residents game play playing speak keep make take read"
    " time tempo rather quite very slightly need"
)
_FAST = one_of("fast quick quickly rapid rapidly hasty speedy rushed hurried")
_SLOW = one_of("slow slowly")
_SLOWER = one_of("slower easier")
_FASTER = one_of("faster quicker")
_NO = one_of("not never no less")

_FRAMES: tuple[tuple[GameCommand, Bag], ...] = (
    (ChangePace(-1), Bag((_FAST, one_of("too not less")), _PACE_WORDS, never_begins=_ASKS)),
    (
        ChangePace(-1),
        Bag((_SLOWER,), _PACE_WORDS | one_of("more"), never_begins=_ASKS, without=_NO),
    ),
    (
        ChangePace(-1),
        Bag((_SLOW, one_of("down more")), _PACE_WORDS, never_begins=_ASKS, without=_NO | {"too"}),
    ),
    (
        ChangePace(-1),
        Bag((one_of("keep follow"), one_of("not hardly barely"), one_of("we they people")),
              one_of("up with pace you everybody"), never_begins=_ASKS),
    ),
    (
        ChangePace(1),
        Bag((_FASTER,), _PACE_WORDS | one_of("more"), never_begins=_ASKS, without=_NO | {"too"}),
    ),
    (ChangePace(1), Bag((_SLOW, one_of("too")), _PACE_WORDS, never_begins=_ASKS, without=_NO)),
    (
        ChangePace(1),
        Bag((one_of("speed hurry pick step"), one_of("up")), _PACE_WORDS,
              never_begins=_ASKS, without=_NO),
    ),
    (
        Pause(),
        Bag(
            (one_of("break pause breather rest"),),
            one_of("we need take short for coffee tea lunch cake minutes minute five ten let us"
                   " like want time quick little drink everybody bit have while must should"
                   " moment game make"),
            never_begins=_ASKS | one_of("your my their"),
            without=_NO | {"robot"},
        ),
    ),
    (
        Pause(),
        Bag(
            (one_of("hold wait hang"), one_of("minute moment second seconds minutes bit")),
            one_of("game little everybody"),
            never_begins=_ASKS,
            without=_NO,
        ),
    ),
    (
        CallAgain(),
        Bag(
            (one_of("again once repeat"), one_of("say call read tell repeat announce give said")),
            one_of("number last more time what just it"),
            never_begins=_ASKS - one_of("what"),
            without=one_of("not numbers another new next"),
        ),
    ),
    (
        CallAgain(),
        Bag(
            (one_of("hear catch understand get heard missed miss"), one_of("not missed"),
             one_of("number it that call what")),
            one_of("last said quite everybody nobody somebody could"),
            never_begins=_ASKS | one_of("you"),
        ),
    ),
)  # fmt: skip

_SOMEBODY = (
    r"(?:some(?:body|one)|any(?:body|one)|she|he|(?:a|an|the|one|our|my)(?: old| elderly| of the)?"
    r" (?:lad(?:y|ies)|m[ae]n|wom[ae]n|gentlem[ae]n|residents?|persons?|guests?|players?"
    r"|nurses?|colleagues?|patients?|visitors?|people))"
)
_FELL = (
    r"(?: has| have|'s| is| just| had)* (?:fell|fallen|falling|collapsed|fainted|slipped|tripped)"
    r"(?! asleep| silent| quiet| in| for| behind| out)\b.*"
)
_ON_THE_FLOOR = r" (?:is |are |lies |lie |lying |sits )+(?:down )?on the (?:floor|ground)\b.*"
_FALLS = re.compile(
    rf"(?:help[,!]? |quick[,!]? |oh (?:no|dear)[,!]? )?(.+?)(?:{_FELL}|{_ON_THE_FLOOR})", re.I
)


def without_courtesy(text: str) -> str:
    """Return words without "please", thanks and Tangy's name at their ends."""
    said = " ".join(text.split())
    while (shorter := _POLITE_AFTER.sub("", _POLITE_BEFORE.sub("", said, count=1)
           if _POLITE_BEFORE.match(said) else said)) != said:  # fmt: skip
        said = shorter
    return said


def read_request(text: str) -> GameCommand | None:
    """Parse a request in free wording; None if it is none."""
    words = words_in(text)
    return next((command for command, frame in _FRAMES if frame.fits(words)), None)


def tells_a_fall(text: str, find_person: Callable[[str], str]) -> bool:
    """Return whether words tell that somebody fell: then the robot must not drive up to them."""
    found = _FALLS.fullmatch(" ".join(text.replace("\u2019", "'").split()).strip(" .!"))
    if found is None:
        return False
    if re.fullmatch(_SOMEBODY, found[1], re.I):
        return True
    with suppress(TangyError):
        return bool(find_person(found[1]))
    return False
