"""Answers to a question: yes, no, or the number of a choice.

Only a whole sentence is an answer: "right" is a yes, "the right shoe" is none. A sentence with a no
in it is no yes, and one with both ("yes and no") is neither.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from functools import cache

from tangy_tui.language.words import NUMBERS, bare, words_of

PLAIN = (
    *("yes", "yes please", "yes do it", "yes that is right"),
    *("no", "no thank you", "no do not", "no that is wrong"),
)
"""Unambiguous answers: no phrases of an activity, and no names."""
YES = (
    *("yes", "yes please", "yes do it", "yes that is right", "yes that's right", "yeah", "yep"),
    *("yup", "that's right", "that is right", "correct", "that's correct", "exactly", "sure"),
    *("of course", "go ahead", "do it", "do that", "please do", "that's it", "that is it", "right"),
    *("absolutely", "definitely", "certainly", "okay", "all right", "i did", "yes i did"),
    *("that's what i said", "that's the one", "yeah that's it", "go for it", "quite right"),
)
"""Utterances recognised as a yes."""
NO = (
    *("no", "no thank you", "no thanks", "no do not", "no don't", "no that is wrong", "nope"),
    *("no that's wrong", "that's wrong", "that is wrong", "wrong", "not that", "nah", "never mind"),
    *("that's not right", "that's not it", "that's not what i said", "i didn't say that"),
    *("please don't", "forget it", "not now", "no way", "certainly not", "incorrect", "cancel"),
    *("cancel that", "none of them", "none of these", "i did not say that", "something else"),
)
"""Utterances recognised as a no."""

_IS = "(?:(?:that|this|it|you)(?:s| is|re| are| was) )?"
_YES = (
    "yes|yeah|yep|yup|yea|aye|uh huh|mm hmm|mhm|indeed|affirmative|certainly|definitely|absolutely"
    "|exactly|precisely|of course|by all means|sure(?: thing)?|naturally|ok|okay|o k|all right"
    "|alright|agreed|very well|fine(?: by me| with me)?|perfect|wonderful|great|lovely"
    f"|{_IS}(?:quite |exactly |absolutely |all )?(?:right|correct|it|true|the 1|fine|good|perfect)"
    "|(?:thats|that is|it is|its) (?:exactly )?what i (?:said|meant|want|wanted)"
    "|go ahead|go for it|go on then|(?:just |please )?do (?:it|that|so)|please do|make it so"
    "|i (?:did|do|said that|meant that|want that)|you (?:got|have) it"
    "|that (?:works|will do)|sounds (?:good|right)|why not"
)
_NO = (
    "no|nope|nah|nay|no way|no thanks|no thank you|negative|never(?: mind)?|forget (?:it|that)"
    "|(?:certainly|definitely|absolutely|of course|please|surely) not|not at all"
    "|not (?:that|this) 1|not (?:that|this|now|yet|right|it|correct|so|really)"
    "|(?:please )?(?:dont|do not)(?: do (?:it|that))?"
    f"|{_IS}(?:not (?:quite |at all )?(?:right|correct|it|true|what i (?:said|meant|want|wanted))"
    "|wrong|incorrect|false|a mistake)"
    "|(?:that|this|it) (?:isnt|wasnt) (?:right|correct|it|true|what i (?:said|meant|want|wanted))"
    "|i (?:didnt|did not) (?:say|mean|want) (?:that|it|this)|i (?:said|meant) something else"
    "|something else|none(?: of (?:them|these|those|it))?|neither|cancel(?: (?:that|it))?"
    "|(?:leave|drop|skip) (?:it|that)|rather not|better not|i dont (?:want|mean) (?:that|it)"
)
_TAIL = "please|thanks|thank you|tangy|robot|dear|now|then|oh|well|um|uh|er|ah|just|so|i think|hm"
_NUMBERED = re.compile(
    r"(?:(?:i (?:mean|meant|want)|take|choose|it is|its|thats|that is|please) )?(?:the )?"
    r"(?:(?:number|option|choice|answer) )?"
    r"(?P<which>\d{1,2}|first|second|third|last)(?: 1)?(?: please)?"
)
_ORDINALS = ("first", "second", "third")


@cache
def _whole() -> re.Pattern[str]:
    piece = f"(?:{_YES}|{_NO}|{_TAIL})"
    return re.compile(f"{piece}(?: {piece})*")


def yes_or_no(text: str) -> bool | None:
    """Return whether a text answers yes or no; None for neither."""
    said = _plain(words_of(text))
    if not _whole().fullmatch(said):
        return None
    rest = re.sub(rf"\b(?:{_NO})\b", "|", said)
    denies = rest != said
    agrees = re.search(rf"\b(?:{_YES})\b", rest) is not None
    if denies and agrees:
        return None if _both(said) else False
    return False if denies else True if agrees else None


def choice_in(text: str, choices: Sequence[str]) -> int | None:
    """Return the choice that a text names, by number or words, counted from 1."""
    words = words_of(text)
    for number, choice in enumerate(choices, 1):
        if bare(words) and bare(words) == bare(words_of(choice)):
            return number
    found = _NUMBERED.fullmatch(_plain(words))
    if found is None:
        return None
    which = found["which"]
    if which == "last":
        return len(choices) or None
    number = _ORDINALS.index(which) + 1 if which in _ORDINALS else int(which)
    return number if 1 <= number <= len(choices) else None


def choice_phrases(most: int) -> tuple[str, ...]:
    """Return the utterances recognised as the number of a choice."""
    numbers = NUMBERS[1 : most + 1]
    named = (form for n in numbers for form in (n, f"number {n}"))
    return (*named, *(f"the {name} one" for name in (*_ORDINALS[:most], "last")))


def _plain(words: Iterable[str]) -> str:
    return " ".join(word.replace("'", "") for word in words)


def _both(said: str) -> bool:
    """Return whether an answer is both yes and no ("yes and no"), and not a polite no."""
    return re.match(r"(?:yes|yeah|yep)\b", said) is not None
