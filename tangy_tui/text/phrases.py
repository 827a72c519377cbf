"""Words for the phrasebook: what can be said or typed, and how to search it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from tangy_tui.text.names import said_words

if TYPE_CHECKING:
    from tangy_tui.language.lexicon import WordSource
    from tangy_tui.language.phrase_list import PhraseList

LIST_TITLE = "What you can say or type"
LIST_HELP = (
    "Up and down choose an entry, {filter} searches, {hear} says it aloud. Tangy does not hear a "
    "name yet if it only guesses how it sounds: choose the person and press {pronounce}."
)
CHOOSE_SAYABLE = "Choose something you can say: a word, a person or a behaviour."
CHOOSE_PERSON = "Choose a person: the activity's words are changed in its file."
NONE_FOUND = "Nothing found: esc shows everything again."
LOOKING_UP = "Looking up the words ..."

SOURCES: dict[WordSource, str] = {
    "activity": "the activity says so",
    "person": "noted for the person",
    "dictionary": "dictionary",
    "suggested": "guessed, not heard yet",
    "": "unknown, cannot be heard",
}
"""Words for the source of a pronunciation."""


class PhraseItem(NamedTuple):
    """One entry of the page: heading, subject, and text.

    `phones` are those to speak (a comma between words; "" for none), `person` the id of a person if
    the entry is a name.
    """

    heading: str
    about: str
    texts: tuple[str, ...]
    phones: str = ""
    person: str | None = None

    def has(self, wanted: str) -> bool:
        """Whether it contains all words of a search."""
        text = " ".join((self.about, *self.texts)).casefold()
        return all(word in text for word in wanted.casefold().split())


def items(listed: PhraseList) -> Iterator[PhraseItem]:
    """Yield the page entry by entry."""
    phones = {said.word: said.phones[0] for said in listed.words if said.phones}
    for ways in listed.behaviours:
        texts = [", ".join(ways.phrases) + ("; or with a person" if ways.to_people else "")]
        texts += [f"keywords: {', '.join(ways.keywords)}"] if ways.keywords else []
        own = [text for text, behaviour in listed.own.items() if behaviour == ways.behaviour]
        texts += [f"your own: {', '.join(own)}"] if own else []
        first = ways.phrases[0].split() if ways.phrases else []
        aloud = ", ".join(phones[word] for word in first) if phones.keys() >= set(first) else ""
        yield PhraseItem("What to say", ways.question, tuple(texts), aloud)
    for called in listed.people:
        texts = [", ".join(called.ways), said_words(called.said)]
        aloud, id = called.said.phones, called.person.id
        yield PhraseItem("People and seats", called.person.name, tuple(texts), aloud, id)
    reasons = listed.left_out.values()
    for reason in dict.fromkeys(reasons):
        out = [phrase for phrase, why in listed.left_out.items() if why == reason]
        yield PhraseItem("Cannot be heard, only typed", reason, (", ".join(out),))
    for said in listed.words:
        text = f"{' or '.join(said.phones) or '?'} ({SOURCES[said.source]})"
        yield PhraseItem("How words are said", said.word, (text,), phones.get(said.word, ""))
