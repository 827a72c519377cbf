"""Names that can be confused with other names or commands, as words or by sound."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice, product

from tangy_profiles.activity import Activity
from tangy_profiles.errors import TangyError
from tangy_profiles.person import Person
from tangy_profiles.reading import plain
from tangy_tui.language.answers import PLAIN
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.lexicon import MOST_WAYS, Lexicon
from tangy_tui.language.name_pronunciation import how_said
from tangy_tui.language.phrasebook import name_phones
from tangy_tui.language.pronunciation import pronounce
from tangy_tui.language.stop_sentence import STOPS, stops
from tangy_tui.language.words import Words, bare, clean, spoken, words_of


@dataclass(frozen=True, slots=True)
class NameConflict:
    """A conflict: `like` is what a name sounds like; `lost` is not recognised ("": both are).

    `guessed` are the phones, if they are only a suggestion.
    """

    person: Person
    like: str
    lost: str
    guessed: str = ""


def find_clash(activity: Activity, people: Sequence[Person], person: Person) -> NameConflict | None:
    """Find a conflict of a person's name, by its pronunciation or else the suggested one."""
    said, guessed = person, ""
    how = how_said(person)
    if how.source == "suggested":
        guessed = how.phones
        said = replace(person, pronunciation=guessed)
    among = [said if other.id == person.id else other for other in people]
    for like, lost in _alike(activity, among, said):
        return NameConflict(person, like, lost, guessed)
    return None


def check_said(activity: Activity, people: Sequence[Person], person: Person, phones: str) -> None:
    """Check that a name with this pronunciation is distinguishable.

    Raises:
        TangyError: it sounds like another name, or like a phrase.
    """
    clash = find_clash(activity, people, replace(person, pronunciation=phones))
    if clash is not None:
        raise TangyError(
            plain(
                f"Said {phones}, {person.name} sounds like {clash.like}, and could not be told "
                "from it: give another pronunciation, or another name."
            )
        )


def check_new_name(activity: Activity, people: Sequence[Person], person: Person) -> None:
    """Check that a name has no other meaning, typed or spoken.

    Args:
        activity: the activity with its phrases.
        people: everybody, with their current names.
        person: the person with the new name.

    Raises:
        TangyError: it stops the robot, is an answer, a whole phrase, or refers to another person.
    """
    words = words_of(clean(person.name))
    if not words:
        return
    others = [other for other in people if other.id != person.id]
    named = next((other for other in others if words_of(clean(other.name)) == words), None)
    seated = (o.id for o in others if words in {words_of(seat) for seat in o.seats})
    seat = next(seated, None)
    table = Phrasebook(activity, [*others, person]).table
    own = {bare(phrase.words): phrase for phrase in table.all() if phrase.user is None}
    ways = [p for p in table.all() if p.user is not None and p.words[-len(words) :] == words]
    why = ""
    if stops(person.name):
        why = "stops the robot when it is said"
    elif words in {words_of(text) for text in PLAIN}:
        why = "is an answer to Tangy's questions"
    elif named is not None:
        why = f"is what {named.id} is called"
    elif seat is not None:
        why = f"is where {seat} sits"
    elif bare(words) in own and bare(words):
        why = f"is a command ({own[bare(words)].behaviour})"
    elif ways and all(phrase.user != person.id for phrase in ways):
        why = f"is another way to call {ways[0].user}"
    if why:
        raise TangyError(plain(f"{person.name!r} {why}: choose another name."))


def _alike(
    activity: Activity, people: Sequence[Person], person: Person
) -> Iterator[tuple[str, str]]:
    """Yield what a name sounds like, and which of both is not recognised."""
    name = words_of(clean(person.name))
    if not name:
        return
    lexicon = Lexicon(Phrasebook(activity, people), suggest=lambda word: "")
    names = {other.id: other.name for other in people}
    for one in lexicon.alike:
        for own, other in ((one.phrase, one.other), (one.other, one.phrase)):
            if own.user != person.id or own.words[-len(name) :] != name:
                continue
            like = lost = repr(other.said)
            if other.user is not None:
                like, lost = f"{names[other.user]} ({other.user})", names[other.user]
            yield like, person.name if own is one.phrase else lost
    ways = set(_ways(activity, name, name_phones(person)))
    phrases = (p.words for p in lexicon.phrases if p.user is None)
    for words in (*map(words_of, (*STOPS, *PLAIN)), *phrases):
        if words != name and not ways.isdisjoint(_ways(activity, words, {})):
            yield repr(spoken(words)), ""


def _ways(activity: Activity, words: Words, own: dict[str, str]) -> Iterator[str]:
    """Yield the pronunciations of words, as phones without word boundaries."""
    choices = [
        (own[word],) if word in own else (*activity.pronunciations.get(word, ()), *pronounce(word))
        for word in spoken(words).split()
    ]
    return (" ".join(way) for way in islice(product(*choices), MOST_WAYS))
