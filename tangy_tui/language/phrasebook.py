"""The phrasebook: every phrase of an activity, including those with people and seats.

Matching, completion, speech recognition and the help page all use this table; `commands`
understands other text.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from random import Random
from typing import Literal

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.person import Person
from tangy_profiles.state import EVERYBODY
from tangy_tui.language.examples import spoken_examples, templates, wordings_of
from tangy_tui.language.words import Words, bare, clean, spoken, words_of

ARTICLES = frozenset(("a", "an", "the"))
LINKS = ("to", "for", "with")
"""Words between a behaviour and its person."""
USER = ("user",)
SEED = 1


@dataclass(frozen=True, slots=True)
class Phrase:
    """A phrase or the keywords of a behaviour, with numbers as digits.

    `bare` are the words without fillers; `rank` orders equally good matches; `user` is the person
    to go to, if any; `heard`: it is in the vocabulary of speech recognition.
    """

    words: Words
    bare: Words
    behaviour: str
    user: str | None
    rank: tuple[int, int]
    heard: bool

    @property
    def shown(self) -> str:
        """The phrase with numbers as digits."""
        return " ".join(self.words)

    @property
    def said(self) -> str:
        """The phrase with numbers in words."""
        return spoken(self.words)


class Phrases:
    """Every phrase and the keywords of an activity, with its participants.

    A behaviour that goes to a person can be combined with the person's number, name or seat ("go to
    user 2", "go to user two", "go to rosa", "go to seat two", "go to the window seat"). The number
    is the one at the end of their id, or else their place in the list.
    """

    def __init__(self, activity: Activity, people: Sequence[Person]) -> None:
        """Add the phrases, then their forms with people; the first entry of a phrase wins."""
        self.activity = activity
        self._order = tuple(activity.behaviours)
        self.questions = tuple(spoken(words_of(b.question)) for b in activity.behaviours.values())
        """The questions about the behaviours, as they are spoken."""
        self.wordings = tuple(
            spoken(words_of(text)) for b in activity.behaviours.values() for text in wordings_of(b)
        )
        """Other wordings of the behaviours, as they are spoken."""
        self.answers = _answers_in(activity)
        """The possible answers of people in a game, by spoken form."""
        self.numbers = _numbers_of(people)
        self.names = _names_of(people)
        self.seats = _seats_of(people)
        self.seat_nouns = tuple(dict.fromkeys(s[:-1] for s in self.seats if s[-1].isdigit()))
        self.by_words: dict[Words, Phrase] = {}
        self.keywords: list[Phrase] = []
        behaviours = activity.behaviours.values()
        for behaviour in behaviours:
            for place, text in enumerate((*behaviour.phrases, behaviour.question)):
                self._add(words_of(text), behaviour.name, None, place)
        self.own_words = frozenset(word for words in self.by_words for word in words)
        """The words of the activity's own phrases, without people."""
        for behaviour in behaviours:
            place = len(behaviour.phrases) + 1
            self._add(words_of(behaviour.name), behaviour.name, None, place, heard=False)
        for behaviour in behaviours:
            self._add_keywords(behaviour)
            if behaviour.to:
                self._add_addressees(behaviour)
            elif behaviour.visits:
                self._add_people(behaviour)
        self.pronunciations = self._read_pronunciations(activity, people)
        self.sources: dict[str, Literal["activity", "person"]]
        self.sources = dict.fromkeys(self.pronunciations, "person")
        """The source of each pronunciation: "activity" or "person"."""
        self.sources |= dict.fromkeys(activity.pronunciations, "activity")

    @cached_property
    def sentences(self) -> tuple[str, ...]:
        """Requests and talk with the activity's words and these people, as they are spoken."""
        numbered = product(templates()["people"], self.numbers)
        ways = [*map(spoken, (*numbered, *self.seats)), *map(" ".join, self.names)]
        Random(SEED).shuffle(ways)
        return tuple(spoken_examples(self.activity, ways))

    def all(self) -> Iterable[Phrase]:
        """Return the phrases in the order in which they were added."""
        return self.by_words.values()

    def complete(self, begun: str) -> tuple[str, ...]:
        """Return the phrases with a prefix, most usual first (see `Phrasebook`)."""
        ranked = sorted(self.all(), key=lambda phrase: phrase.rank)
        shown = dict.fromkeys(p.shown for p in ranked if p.shown.startswith(begun))
        if not shown:
            shown = dict.fromkeys(p.said for p in ranked if p.said.startswith(begun))
        return tuple(shown)

    def word_weights(self) -> dict[str, float]:
        """Return a weight for every word: the more behaviours share it, the lower."""
        users: dict[str, set[str]] = defaultdict(set)
        for phrase in (*self.all(), *self.keywords):
            for word in phrase.words:
                users[word].add(phrase.behaviour)
        return {word: 1 / len(behaviours) for word, behaviours in users.items()}

    def _add(
        self, words: Words, behaviour: str, user: str | None, place: int, *, heard: bool = True
    ) -> None:
        if words and words not in self.by_words:
            self.by_words[words] = self._entry(words, behaviour, user, place, heard=heard)

    def _entry(
        self, words: Words, behaviour: str, user: str | None, place: int, *, heard: bool
    ) -> Phrase:
        rank = (place, self._order.index(behaviour))
        return Phrase(words, bare(words), behaviour, user, rank, heard)

    def _add_people(self, behaviour: Behaviour) -> None:
        """Replace the last word of each phrase with people: "go to [the] user"."""
        for place, text in enumerate(behaviour.phrases):
            *verb, noun = words_of(text)
            while verb and verb[-1] in ARTICLES:
                verb.pop()
            for number, user in self.numbers.items():
                self._add((*verb, noun, number), behaviour.name, user, place)
            for name, user in self.names.items():
                self._add((*verb, *name), behaviour.name, user, place)
            for seat, user in self.seats.items():
                the = () if seat[-1].isdigit() else ("the",)
                self._add((*verb, *the, *seat), behaviour.name, user, place)
            for seat_noun in self.seat_nouns:  # else "go to seat" would mean the first one
                self._add((*verb, *seat_noun), behaviour.name, None, place, heard=False)

    def _add_addressees(self, behaviour: Behaviour) -> None:
        """Append people to each phrase: "give a hint to rosa", "give a hint to everybody"."""
        called: list[tuple[Words, str]] = [*self.names.items(), *self.seats.items()]
        called += [((noun, number), user) for number, user in self.numbers.items() for noun in USER]
        if EVERYBODY in behaviour.to:
            called.append(((EVERYBODY,), EVERYBODY))
        for place, text in enumerate(behaviour.phrases):
            for (name, user), link in product(called, LINKS):
                self._add((*words_of(text), link, *name), behaviour.name, user, place)

    def _add_keywords(self, behaviour: Behaviour) -> None:
        for place, entry in enumerate(behaviour.keywords):
            words = words_of(" ".join(entry))
            forms: list[tuple[Words, str | None]] = [(words, None)]
            if behaviour.visits:
                forms += [((*words, number), user) for number, user in self.numbers.items()]
                called = (self.names | self.seats).items()
                forms += [((*words[:-1], *name), user) for name, user in called]
                forms += [((*words[:-1], *noun), None) for noun in self.seat_nouns]
            self.keywords += [
                self._entry(form, behaviour.name, user, place, heard=False) for form, user in forms
            ]

    def _read_pronunciations(
        self, activity: Activity, people: Sequence[Person]
    ) -> dict[str, tuple[str, ...]]:
        """Collect pronunciations from the activity, and from people's names.

        A word of the phrases that is also a name keeps its usual pronunciation too.
        """
        said: dict[str, list[str]] = defaultdict(list)
        for person in people:
            for word, phones in name_phones(person).items():
                said[word].append(phones)
        for word in said:
            if word in self.own_words and word not in activity.pronunciations:
                from tangy_tui.language.pronunciation import pronounce

                said[word] = [*pronounce(word), *said[word]]
        for word, listed in activity.pronunciations.items():
            said[word] = [*listed, *said[word]]
        return {word: tuple(dict.fromkeys(ways)) for word, ways in said.items()}


def of_one_meaning(phrases: Iterable[Phrase], key: Callable[[Phrase], str]) -> dict[str, Phrase]:
    """Return the phrases by a key, without keys of phrases with different meanings."""
    found: dict[str, list[Phrase]] = defaultdict(list)
    for phrase in phrases:
        found[key(phrase)].append(phrase)
    return {
        form: same[0]
        for form, same in found.items()
        if form and len({(phrase.behaviour, phrase.user) for phrase in same}) == 1
    }


def name_phones(person: Person) -> dict[str, str]:
    """Return the pronunciation of each word of a name, if the person's has all of them."""
    words = words_of(clean(person.name))
    phones = person.pronunciation.split(", ") if person.pronunciation else []
    if len(words) != len(phones):
        return {}
    return {word: said for word, said in zip(words, phones, strict=True) if not word.isdigit()}


def _numbers_of(people: Sequence[Person]) -> dict[str, str]:
    """Return ids by number: the number at the end of the ids, or else the place in the list."""
    ends = [re.search("[0-9]{1,2}$", person.id) for person in people]
    numbers = [str(int(end.group())) for end in ends if end]
    if len(set(numbers)) < len(people):
        numbers = [str(place) for place in range(1, len(people) + 1)]
    return {number: person.id for number, person in zip(numbers, people, strict=True)}


def _names_of(people: Sequence[Person]) -> dict[Words, str]:
    """Return ids by name, without names that two people share or that have no word."""
    named: dict[Words, list[str]] = defaultdict(list)
    for person in people:
        named[words_of(clean(person.name))].append(person.id)
    return {name: ids[0] for name, ids in named.items() if bare(name) and len(ids) == 1}


def _seats_of(people: Sequence[Person]) -> dict[Words, str]:
    """Return ids by the names of their seats."""
    return {words_of(seat): person.id for person in people for seat in person.seats}


def _answers_in(activity: Activity) -> dict[str, str]:
    """Return all possible answers of people: spoken form -> text of the item.

    They are the options of each item and the right answers, without single letters: B, C and D
    sound too similar.
    """
    if not isinstance(activity, DeclaredActivity):
        return {}
    items = activity.declaration.items
    asked = [f for f in activity.declaration.facts.values() if f.checks and "speech" in f.sources]
    columns = dict.fromkeys(c for fact in asked for c in (*fact.options, fact.checks))
    texts = (
        (spoken(words_of(clean(way))), way)
        for row in range(len(items.rows))
        for column in columns
        for way in items.value(row, column).split("|")
    )
    return {said: way for said, way in texts if len(said) > 1}
