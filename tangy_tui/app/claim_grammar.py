"""The grammar of claims: "bingo 17", "Rosa has bingo", "somebody shouts bingo at table 3".

A sentence claims with the words of its activity: the word for a claim, or a pattern to play for.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import suppress

from tangy_profiles.errors import TangyError
from tangy_profiles.game_rules import GameRules
from tangy_profiles.reading import plain
from tangy_tui.app.game_commands import ClaimCard

CHECK = "check"
"""The word before a card's number in every activity; an activity may define another."""
_AND = r",? (?:and|&) |, ?"
_SAYS = (
    r"(?:says?|said|shouts?|shouted|shouting|calls?|called|calling|claims?|claimed|claiming"
    r"|yells?|yelled|cries|thinks?)\b"
)
_HAS = r"(?:has|have|has got|have got|got|['\u2019](?:s|ve)(?! card)(?: got)?)\b"
_LEAD = re.compile(
    r"(?:(?:i think|i believe|i hear|listen|look|oh|hey|yes|and|but|tangy|please|now)\b,? ?)*", re.I
)
_CLAIMS = re.compile(
    rf"(?P<who>.+?)(?: (?:both|all|also|just|now))*"
    rf"(?: (?:is |are )?{_SAYS}(?: out| that)?"
    rf"(?: (?:he|she|they|it|i|we)(?= |['\u2019]))? ?(?P<second>{_HAS})?| ?{_HAS})"
    r" ?(?:just |also |now )?(?:an? |the |got )*(?P<what>\w[\w ]*?)"
    r"(?: (?:on|with|at|from|in)(?: the)?(?: card)?(?: number)? #?(?P<card>\d{1,6}))?"
    r"(?: (?:on|at|from|in)(?: the)? (?:table|row|corner|back|front)\b.*)?"
    r"(?:,? (?:now|too|again|already|as well|here|over there))*",
    re.I,
)
_WINS = re.compile(r"(?P<who>.+?) (?:wins|won|has won|may win)(?: now| too)?", re.I)
_THERE_IS = re.compile(
    r"(?:there(?: is|['\u2019]s) |(?:another|a|one more) )*(?P<what>\w[\w ]*?)"
    r"(?: (?:on|at|from|in))?(?: the)? (?:table|row|corner)\b.*"
    r"|there(?: is|['\u2019]s) (?:an?|another) (?P<only>\w[\w ]*)",
    re.I,
)
_NUMBER = re.compile(r"(?:the )?(?:cards? )?(?:numbers? |no\.? )?#?(\d{1,6})[,:]?", re.I)
_OF = re.compile(r"^(?:(?:for|by|of|from) )?(.+?)(?:['\u2019]s(?: card)?)?$", re.I)
_WITH_CARD = re.compile(r"(.+?),? (?:with |has )?(?:card )?(?:number )?#?(\d{1,6})", re.I)
_NOT = re.compile(r"\b(?:not|no|never|nobody|none|cannot|almost|nearly)\b|n['\u2019]t\b", re.I)
_ASKS = re.compile(
    r"(?:who|whose|what|which|when|where|why|how|does|do|did|has|have|is|are|was|if|until|can|may"
    r"|will|should)\b",
    re.I,
)
_NOBODY_NAMED = re.compile(
    r"(?:somebody|someone|anybody|anyone|everybody|everyone|he|she|they|we|i|it|this|that|these"
    r"|those|the|an?|one|two|some|people|another|others?|you|my|table|row)\b",
    re.I,
)
_LONGEST_NAME = 2  # words of what is taken for a name that nobody has


def read_claim(said: str, find_person: Callable[[str], str], rules: GameRules) -> ClaimCard | None:
    """Parse a claim with a card's number, a name, or both; None if the words are none.

    Raises:
        TangyError: they claim, but for no card and nobody that is known; one sentence.
    """
    if not rules.claim:
        return None
    word, _, rest = said.partition(" ")
    if word.casefold() in (CHECK, rules.claim.casefold()):
        return _after_word(word, rest, find_person)
    return _sentence(said[_LEAD.match(said).end() :], find_person, rules)  # type: ignore[union-attr]


def one_claim_each(said: str) -> list[str]:
    """Return a line for each card or person if a line claims for several, such as "bingo 7 and 8".

    It need not be a claim: the lines are to be read as claims.
    """
    word, _, rest = said.strip(" .!").partition(" ")
    if len(several := [one for one in re.split(_AND, rest) if one.strip()]) > 1:
        each = [one.removeprefix(f"{word} ") for one in several]
        if not re.search(rf" {_HAS} ", rest):
            return [f"{word} {one}" for one in each]
    found = _CLAIMS.fullmatch(said.strip(" .!"))
    who = [] if found is None else [one for one in re.split(_AND, found["who"]) if one.strip()]
    if found is None or len(who) < 2:
        return [said]
    return [f"{one} has {found['what']}" for one in who]


def _after_word(word: str, rest: str, find_person: Callable[[str], str]) -> ClaimCard:
    """Parse what follows the word for a claim."""
    wanted, _, more = rest.partition(" ")
    if more and not _digits(wanted) and (card := _NUMBER.match(rest)):
        wanted, more = card[0], rest[card.end() :].strip()
    number = _digits(wanted) or ((found := _NUMBER.fullmatch(wanted)) and found[1]) or ""
    if number and len(number) <= 6:
        person = re.sub(r"^(?:for|by|of|from) ", "", more.strip())
        return ClaimCard(int(number), find_person(person) if person else "")
    if rest and not number:
        for name in dict.fromkeys((re.sub(r"^(?:for|by|of|from) ", "", rest), _OF.match(rest)[1])):  # type: ignore[index]
            with suppress(TangyError):
                return ClaimCard(0, find_person(name))
        if with_card := _WITH_CARD.fullmatch(rest):
            with suppress(TangyError):
                return ClaimCard(int(with_card[2]), find_person(with_card[1]))
        if _NOBODY_NAMED.match(re.sub(r"^(?:for|by|of|from|at|on|in) ", "", rest)):
            raise _whose_card(word)
    wrong = f"'{rest[:60]}'" if rest else f"'{word}' alone"
    raise TangyError(plain(f"{wrong} is no number of a card. Say it as in: {word} 17."))


def _digits(wanted: str) -> str:
    """Return the digits of a number such as "#17,"; "" if it is none."""
    digits = wanted.strip("#,:")
    return digits if digits.isascii() and digits.isdecimal() else ""


def _sentence(said: str, find_person: Callable[[str], str], rules: GameRules) -> ClaimCard | None:
    """Parse a sentence such as "Emil says he has bingo"."""
    if _ASKS.match(said) or _NOT.search(said):
        return None
    if (there := _THERE_IS.fullmatch(said)) and _is_claimed(there["what"] or there["only"], rules):
        raise _whose_card(rules.claim)
    if (wins := _WINS.fullmatch(said)) and (card := _NUMBER.fullmatch(wins["who"])):
        return ClaimCard(int(card[1]))
    found = _CLAIMS.fullmatch(said)
    if found is None or not _is_claimed(found["what"], rules):
        return None
    who, number = found["who"], int(found["card"] or 0)
    if card := _NUMBER.fullmatch(who):
        return ClaimCard(int(card[1]))
    if with_card := _WITH_CARD.fullmatch(who):
        with suppress(TangyError):
            return ClaimCard(int(with_card[2]), find_person(with_card[1]))
    try:
        return ClaimCard(number, find_person(_OF.match(who)[1]))  # type: ignore[index]
    except TangyError:
        if _NOBODY_NAMED.match(who):
            if number and not re.search(r"\b(?:table|row) ", said):
                return ClaimCard(number)
            raise _whose_card(rules.claim) from None
        if who.count(" ") < _LONGEST_NAME:
            raise
    return None


def _is_claimed(what: str, rules: GameRules) -> bool:
    """Return whether words name a claim of the activity, or a pattern of it."""
    if what.casefold() == rules.claim.casefold():
        return True
    with suppress(TangyError):
        return bool(rules.pattern(what))
    return False


def _whose_card(word: str) -> TangyError:
    return TangyError(
        f"Whose card is it? Type {word} and the number of the card, as in: {word} 17."
    )
