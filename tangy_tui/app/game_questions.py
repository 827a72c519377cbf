"""The grammar of questions about the game, its calls, its people and Tangy itself.

They are read by frames (see `word_frames`): by what they are about, and not by their wording. A few
sayings that need an answer, such as thanks, are read here, too.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Literal, TypeAlias

from tangy_profiles.errors import TangyError
from tangy_profiles.game_rules import NO_RULES, GameRules
from tangy_tui.app.word_frames import ASKS_BY, COULD_BE_ASKED, Bag, one_of, words_in

Topic: TypeAlias = Literal[
    "last call",
    "calls",
    "called",
    "where",
    "playing",
    "unvisited",
    "battery",
    "clock",
    "todo",
    "end",
    "heard",
    "thanks",
    "louder",
    "come here",
    "no claim",
    "new game",
]


@dataclass(frozen=True, slots=True)
class AsksGame:
    """A question about a topic of the game; `about` is the call that it names."""

    topic: Topic
    about: str = ""


_SHOW = one_of("show tell list give know")
_ASKED = ASKS_BY | one_of("and so but") | _SHOW
_NUMBER = one_of("number numbers call calls ball balls letter")
_CALLED = one_of("called call calls drawn draw drew said announced come came out")
_PEOPLE = one_of(
    "people players residents persons guests participants ladies gentlemen men women everybody"
    " everyone"
)
_PLAY = one_of("playing play plays part taking take takes game games joined join player players")
_VISIT = one_of("visited visit visits helped turn met reached served attended seen")
_CHARGE = one_of("charge charged charging power")
_ENDS = one_of("end finish close quit exit leave out")
_AGO = one_of("again just recently time most very")

QUESTIONS: tuple[tuple[Topic, Bag], ...] = (
    (
        "last call",
        Bag(
            (one_of("last latest previous recent current newest"), _NUMBER | _CALLED),
            _AGO | one_of("tell know"),
            one_of("what which do tell and so who"),
        ),
    ),
    (
        "last call",
        Bag((one_of("what which"), one_of("number ball"), one_of("on at up")), _AGO),
    ),
    (
        "calls",
        Bag(
            (
                one_of("numbers calls balls ones many"),
                one_of("called calls drawn announced already far out"),
            ),
            one_of("see number every complete whole until how till list show") | _SHOW,
            _ASKED - one_of("when why where who whom"),
            one_of("next"),
        ),
    ),
    (
        "playing",
        Bag(
            (one_of("how"), one_of("many"), _PEOPLE | _PLAY),
            one_of("left altogether present"),
        ),
    ),
    ("playing", Bag((one_of("how"), one_of("many"), one_of("we us")), one_of("left altogether"))),
    ("playing", Bag((one_of("who whos"), _PLAY), one_of("else"), one_of("who and so"))),
    (
        "unvisited",
        Bag(
            (one_of("who whom which is are has anybody anyone"), one_of("not never"), _VISIT),
            _PEOPLE | one_of("else anybody anyone somebody someone once at"),
            ASKS_BY | one_of("and so"),
        ),
    ),
    (
        "unvisited",
        Bag(
            (one_of("who whom"), one_of("not never"), one_of("been gone went")),
            one_of("else once"),
        ),
    ),
    (
        "unvisited",
        Bag(
            (one_of("who whom"), one_of("left without missing remaining remains"), _VISIT),
            one_of("else"),
        ),
    ),
    (
        "battery",
        Bag(
            (_CHARGE,),
            one_of(
                "battery what how much enough left need full empty low level remaining fine good"
                " run running about"
            ),
            ASKS_BY,
        ),
    ),
    (
        "clock",
        Bag((one_of("time"), one_of("what tell know")), begins=one_of("what do can could tell")),
    ),
    ("clock", Bag((one_of("how"), one_of("late")))),
    (
        "where",
        Bag((one_of("where"), one_of("you tangy robot it")),
              one_of("gone standing stand go went moment right exactly"),
              one_of("where and so do tell")),
    ),
    (
        "end",
        Bag(
            (one_of("how what where"), _ENDS, one_of("i we to one")),
            one_of("game type press playing session round program get do key it early"),
            one_of("how what where and so tell"),
        ),
    ),
    (
        "todo",
        Bag(
            (one_of("i me we us my"), one_of("do type press")),
            one_of("what should must need shall supposed anything something nothing next want"
                   " tell show expected got"),
            ASKS_BY - one_of("do why when where who whom whose how") | one_of("tell and so but"),
        ),
    ),
    (
        "todo",
        Bag(
            (one_of("i we"), one_of("have need must"), one_of("anything something")),
            one_of("to next"),
            one_of("do and so but"),
        ),
    ),
    (
        "heard",
        Bag(
            (one_of("hear heard listening listen understand understood get got read"),
             one_of("you tangy")),
            one_of("what said i say"),
            one_of("do did can could are have has does"),
            one_of("it we they"),
        ),
    ),
)  # fmt: skip
"""Topics and the questions about them; the first that fits counts."""

_PRAISE = one_of("good great nice lovely excellent brilliant wonderful fantastic fine super")
_WHOLE_VOICE = one_of(
    "speak talk say turn up down bit little too not make more sound voice much very hear volume"
    " speaker loudspeaker what how"
)

SAYINGS: tuple[tuple[Topic, Bag], ...] = (
    ("thanks", Bag((one_of("thank thanks cheers"),), one_of("lot very much many that help"))),
    (
        "thanks",
        Bag((_PRAISE, one_of("job work game round done tangy")), one_of("very such what")),
    ),
    ("louder", Bag((one_of("louder loudly loud volume quieter softer"),), _WHOLE_VOICE)),
    ("louder", Bag((one_of("quiet quietly soft softly"), one_of("too")), _WHOLE_VOICE)),
    (
        "louder",
        Bag(
            (one_of("hear"), one_of("not hardly barely"), one_of("we they i"), one_of("you tangy")),
            one_of("very back"),
        ),
    ),
    (
        "come here",
        Bag(
            (one_of("come drive move roll"), one_of("here me us")),
            one_of("over closer near nearer back"),
            COULD_BE_ASKED | one_of("come drive move roll please tangy robot hey you over"),
        ),
    ),
    (
        "new game",
        Bag(
            (one_of("game round"), one_of("new another next again second fresh more")),
            one_of("start begin play let want like"),
            never_begins=ASKS_BY - COULD_BE_ASKED,
        ),
    ),
    (
        "new game",
        Bag(
            (one_of("play begin start"), one_of("again afresh")),
            one_of("let want like over"),
            never_begins=ASKS_BY - COULD_BE_ASKED,
        ),
    ),
)  # fmt: skip
"""Topics of sentences that are no questions, but get an answer."""

_NO_CLAIM = one_of("no not nobody none mistake wrong false error forget ignore cancel mistaken")
_AROUND_CLAIM = one_of(
    "sorry alarm she he her his got after only thought called shouted yes oh actually yet was"
    " nothing forget claim claims"
)
_SLOT = re.compile(r"[a-z]-?\d{1,3}|\d{1,3}")
_CALL = Bag(
    (_CALLED | one_of("had been number"),),
    one_of("number ball yes"),
    one_of("was were has have had did is are"),
)
_BATTERY = re.compile(r"\b(?:battery|batteries)\b")


def read_game_question(text: str) -> AsksGame | None:
    """Parse words as a question about the game, None if they are none."""
    words = words_in(text)
    for topic, frame in QUESTIONS:
        if frame.fits(words):
            return AsksGame(topic)
    if words and words[0] in ASKS_BY and _BATTERY.search(text.casefold()):
        return AsksGame("battery")
    calls = [word for word in words if _SLOT.fullmatch(word)]
    if len(calls) == 1 and _CALL.fits(tuple(word for word in words if word not in calls)):
        return AsksGame("called", calls[0].upper())
    return None


def read_saying(
    text: str, find_person: Callable[[str], str], rules: GameRules = NO_RULES
) -> AsksGame | None:
    """Parse words that are no question, but need an answer; None if they are none.

    Args:
        text: what was typed.
        find_person: returns the id of a person by name or id, and raises TangyError for others.
        rules: the choices that the activity gives staff.
    """
    words = words_in(text)
    for topic, frame in SAYINGS:
        if frame.fits(words):
            return AsksGame(topic)
    claims = one_of(rules.claim.casefold())
    frame = Bag((_NO_CLAIM, claims), _AROUND_CLAIM, never_begins=one_of("why when who how what"))
    if claims and frame.fits(tuple(w for w in words if not _is_person(w, find_person))):
        return AsksGame("no claim")
    return None


def _is_person(word: str, find_person: Callable[[str], str]) -> bool:
    with suppress(TangyError):
        return bool(find_person(word))
    return False
