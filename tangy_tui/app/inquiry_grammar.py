"""The grammar of questions about the program or the game; they change nothing."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import Literal, TypeAlias

from tangy_profiles.errors import TangyError
from tangy_tui.app.game_questions import AsksGame, read_game_question
from tangy_tui.app.time_grammar import asks_time

Inquiry = Literal["help", "where", "why", "shown", "what to do", "faults", "phrases", "patterns"]
"""Questions about the program or the game; they change nothing."""

INQUIRIES: dict[str, Inquiry] = {
    **dict.fromkeys(("help", "?"), "help"),
    "where": "where",
    "why": "why",
    **dict.fromkeys(("what", "what to do", "what should i do", "what should i do?"), "what to do"),
    "faults": "faults",
    "phrases": "phrases",
    **dict.fromkeys(("patterns", "pattern", "which patterns"), "patterns"),
}

WHOSE_CARDS = (
    *("cards", "card", "whose card", "whose cards", "who has which card", "all cards"),
    *("whose cards are there", "which cards", "which cards are there", "what cards are there"),
)
"""Questions in a game about whose card is whose."""

WHO_IS_HERE = ("people", "who", "who is here", "who is there")
"""Questions in a game about who is here, and who has come or left."""

_WAITS = (
    r"(?:waits?|waiting|waited|asks?|asked|asking|wants?|needs?|queues|queu?eing"
    r"|(?:has|have|with|got) (?:a|their|his|her) hands?(?: up)?)"
)
_FOR_HELP = (
    r"(?: (?:for|to|be|help|helped|a|visit|visited|tangy|the|robot|it|you|us|now|longest|so|far"
    r"|still|in|line|up|of|me))*"
)
_WHO_WAITS = re.compile(
    rf"(?:and )?who(?:'s| is| are| has| have| else| all| still)* {_WAITS}{_FOR_HELP}"
    rf"|(?:is|are|does|do|has|did) (?:anybody|anyone|somebody|someone|there)(?: else| still)*"
    rf" (?:(?:anybody|anyone|somebody|someone) )?{_WAITS}{_FOR_HELP}"
    r"|(?:show )?(?:me )?(?:the )?(?:queue|requests|waiting list)"
    r"|who(?: is|'s) (?:in the queue|in line|on the list)"
)
"""Questions about everybody who waits, in the order of the visits."""

_ANYBODY = r"(?:anybody|anyone|somebody|someone|people|they)"
_A_WIN = r"(?:won|wins?|winning)"
_WHO_WON = re.compile(
    rf"(?:and )?who(?:'s| is| was| are| were| has| have| else| all| already)*"
    rf" (?:{_A_WIN}|(?:the |our )?winners?)(?: (?:now|yet|so far|already|the|this|game|it|then))*"
    rf"|(?:has|have|did|does) {_ANYBODY}(?: else| already)* {_A_WIN}"
    r"(?: (?:yet|so far|already|now))*"
    r"|(?:is|was|are|were) there (?:a|any) winners?(?: (?:yet|so far|already|now))*"
)
"""Questions about everybody who has won in the game."""

_TANGY = r"(?:you|it|tangy|the robot|he|she)"
_WHY = re.compile(
    r"why(?: (?:that|this|now|not|so|not now|not yet))?"
    rf"|(?:why|what) (?:is|are|does|do|did|will|would) {_TANGY}"
    r"(?: (?:doing|do|going to do|up to|waiting|waiting for|wait|wait for|stand|standing))"
    r"(?: (?:that|this|it|there|here|still))?(?: (?:now|next|then|right now|at the moment))?"
    r"|what(?: is|'s|s) (?:happening|going on|next|up)(?: here)?(?: now| next)?"
    r"|what (?:happens|comes) (?:now|next)|what next|what now"
    r"|who(?: is|'s| comes| gets help)? next|whose turn(?: is it)?(?: now)?"
    rf"|where (?:is|are|does|will) {_TANGY} (?:going|go|driving|drive)(?: to)?(?: now| next)?"
)
"""Questions about what Tangy does now or next, and whose turn it is."""
_NEXT = re.compile(
    r"(?:and )?(?:what|who)(?: is|'s|s| comes| happens| gets (?:help|a visit))?(?: up)? next"
    r"|whose turn(?: is it| is)?(?: now| next)?"
    rf"|(?:what|who) (?:does|will|is) {_TANGY} (?:do|doing|visit|visiting|help|helping) next"
)
"""Questions in a game about who or what comes next."""
_WHY_OTHERWISE = re.compile(r"why .*\b(?:you|it|tangy|the robot|nobody|nothing|no one)\b.*")
"""All other questions that begin so, unless they are about something else."""
_DO = (
    r"(?:go|visit|help|drive|move|come|see|look|check|call|ask|tell|give|show|say|take|let|make"
    r"|play|try|start|greet|prais\w+|remind|encourage|sing|read|draw|send|bring|do|have|talk)\b"
)
_DOING = (
    r"(?:go|visit|help|driv|mov|com|see|look|check|call|ask|tell|giv|show|say|tak|lett|mak|play"
    r"|try|start|greet|prais|remind|encourag|sing|read|draw|send|bring|do|hav|talk)ing\b"
)
_PROPOSAL = re.compile(
    r"(?:and |but |so )?(?:why do not (?:you|we) (?!.*\b(?:any\w*|ever|at all)\b)"
    rf"|(?:will|would|how about|what about) you\b|why not {_DO}|(?:how|what) about {_DOING})"
    rf"|.*\bso (?:please )?{_DO}"
)
"""What proposes something, and asks nothing: "why don't you go to Rosa"."""


def read_inquiry(text: str) -> Inquiry | None:
    """Parse words as a question to the program, None if they are none."""
    words = " ".join(text.split()).casefold()
    if words in INQUIRIES:
        return INQUIRIES[words]
    words = words.replace("\u2019", "'").rstrip(" ?.!")
    otherwise = _WHY_OTHERWISE.fullmatch(words) and not _OTHER.search(words)
    if otherwise and _PROPOSAL.match(_in_full(words)):
        return None
    return "why" if _WHY.fullmatch(words) or otherwise else None


@dataclass(frozen=True, slots=True)
class AsksAbout:
    """A question about people, by id: why Tangy goes to them or not, and when their turn is."""

    people: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class AsksHowLong:
    """A question about how long the session has lasted, and when it ends."""


@dataclass(frozen=True, slots=True)
class AsksWhoWaits:
    """A question about everybody who waits for a visit, in the order of the visits."""


@dataclass(frozen=True, slots=True)
class AsksWhoWon:
    """A question about everybody who has won in the game."""


@dataclass(frozen=True, slots=True)
class AsksNext:
    """A question about who or what comes next."""


Question: TypeAlias = AsksAbout | AsksGame | AsksHowLong | AsksNext | AsksWhoWaits | AsksWhoWon


_SHORT = {
    "n't": " not",
    "'ll": " will",
    "when's": "when is",
    "why's": "why is",
    "who's": "who is",
    "where's": "where is",
    "how's": "how is",
    "what's": "what is",
}
"""Short forms, and what they stand for."""
_IRREGULAR = {"won't": "will not", "can't": "can not", "cannot": "can not"}
_ASKING = re.compile(
    r"(?:and |but |so )?(?:why|when|how long|how many|how soon|how come|how about|what about"
    r"|what is with|who is before|who comes before|who is ahead of|what does|what is|where is"
    r"|is|are|has|have|did|does|will|nobody|no one|tangy (?:is|does) not|you (?:are|do) not"
    r"|it (?:is|does) not) .+|\S+s'? turn"
)
"""The beginnings of questions that may be about a person."""
_ABOUT_TURN = re.compile(
    r"^(?:and |but |so )?(?:why|when|how long|how soon|how come|how about|what about|what is with"
    r"|who )|\b(?:turn|next|first|wait|waits|waiting|waited|asked|asks|asking|queue|line|visit"
    r"|visits|visited|helped|before|go|goes|going|come|comes"
    r"|coming|forgotten|forget|up|here|there|away)\b"
)
"""What a question of this kind contains."""
_OTHER = re.compile(
    r"\b(?:cards?|win|wins|won|winner|marks?|marked|numbers?|scores?|points?|answers?"
    r"|answered|called|named|battery|camera)\b"
)
"""Words of questions about something else."""
_TO = re.compile(
    r".*\b(?:you|it|tangy|robot|he|she|nobody|no one|anybody|anyone)\b.*"
    r" (?:(?<!going )to|with|at|help|helps|helping|helped|visit|visits|visiting|visited|see|sees)"
    r" (?P<to>\S+)"
    r"|(?:why|when) is it (?:not )?(?P<whose>\S+(?: \S+)?)'s? turn|why not (?P<not>\S+)"
)
"""Questions that name a person, even if nobody is called so."""
_LAST = re.compile(
    r"(?: (?:now|then|yet|first|next|again|still|please|at all|at last|today|so long))+$"
)
_THINGS = frozenset(
    {
        *("the", "a", "us", "me", "it", "them", "him", "her", "that", "this", "anybody", "anyone"),
        *("everybody", "everyone", "people", "somebody", "someone", "now", "so", "you", "all"),
        *("nobody", "nothing", "each", "front", "home", "sleep", "bed", "yourself", "itself"),
        *("something", "anything", "everything", "there", "here", "once", "last", "least"),
    }
)
_NOT_NAMES = frozenset(("will", "may", "can", "is", "does", "do", "has", "to", "by", "so"))
"""Words that are names only if no other name is there."""
_SUBJECTS = frozenset(("you", "it", "tangy", "the", "he", "she", "we", "they", "i"))
"""After one of these words they are no names: "when will it come"."""
LONGEST_NAME = 4  # words


def read_question(text: str, find_person: Callable[[str], str]) -> Question | None:
    """Parse words as a question about the game, the time, who waits, who has won, or turns.

    Return None if they are none.

    Args:
        text: what was typed.
        find_person: returns the id of a person by name or id, and raises TangyError for others.

    Raises:
        TangyError: it asks about a person, but nobody is called so; one sentence.
    """
    words = " ".join(text.replace("\u2019", "'").split()).strip(" ?.!,")
    asked = read_game_question(text)
    if asked is not None and asked.topic == "clock":
        return asked
    if asks_time(text):
        return AsksHowLong()
    if _WHO_WAITS.fullmatch(words.casefold()):
        return AsksWhoWaits()
    if _WHO_WON.fullmatch(words.casefold()):
        return AsksWhoWon()
    if _NEXT.fullmatch(words.casefold()):
        return AsksNext()
    return asked or _about_people(words, find_person)


def _about_people(words: str, find_person: Callable[[str], str]) -> AsksAbout | None:
    """Parse words as a question about people's turns; raises as `read_question`.

    Any question counts that begins like one and names somebody, so that no wording has to be
    learnt.
    """
    plain = _in_full(words.casefold())
    if not _ASKING.fullmatch(plain) or not _ABOUT_TURN.search(plain):
        return None
    others = (other[0] for other in _OTHER.finditer(plain))
    if any(not _called(other, find_person) for other in others):  # "when is Mark next" asks
        return None
    if _PROPOSAL.match(plain):
        return None
    found = list(_named(plain.split(), find_person))
    people = [person for word, person in found if word not in _NOT_NAMES]
    if people or found:
        return AsksAbout(tuple(dict.fromkeys(people or [person for _, person in found])))
    if (to := _TO.fullmatch(_LAST.sub("", plain))) is not None:
        wanted = to["to"] or to["whose"] or to["not"]
        if not {*wanted.split()} & _THINGS:
            as_typed = re.search(re.escape(wanted), words, re.I)
            find_person(wanted if as_typed is None else as_typed[0])
    return None


def _in_full(words: str) -> str:
    for short, full in (_IRREGULAR | _SHORT).items():
        words = re.sub(rf"{short}(?=\s|$)", full, words)
    return words


def _named(words: list[str], find_person: Callable[[str], str]) -> Iterator[tuple[str, str]]:
    """Yield the people whom words name, the longest names first at each word."""
    first = 0
    while first < len(words):
        for last in range(min(first + LONGEST_NAME, len(words)), first, -1):
            name = " ".join(words[first:last]).strip(",;:?")
            person = _person(name, find_person)
            if person and not _is_verb(words, first, last):
                yield name, person
                first = last - 1
                break
        first += 1


def _is_verb(words: list[str], first: int, last: int) -> bool:
    """Return whether a word that may be a name is none here: "when will it", not "is Will the"."""
    follows = words[last : last + 1]
    could_be = words[first:last][0] in _NOT_NAMES and words[first - 1 : first] != ["is"]
    return could_be and last == first + 1 and not _SUBJECTS.isdisjoint(follows)


def _person(name: str, find_person: Callable[[str], str]) -> str:
    """Return the person with a name, perhaps in the genitive; "" for nobody."""
    genitive = "" if name in _NOT_NAMES else name.removesuffix("s")  # "has" is not Ha's
    for wanted in (name, name.removesuffix("'s"), name.removesuffix("'"), genitive):
        if wanted and (person := _called(wanted, find_person)):
            return person
    return ""


def _called(name: str, find_person: Callable[[str], str]) -> str:
    """Return the person with exactly this name or id; "" for nobody."""
    with suppress(TangyError):
        return find_person(name)
    return ""
