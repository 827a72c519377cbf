"""The phrasebook for people: the phrases of each behaviour, and pronunciations."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tangy_profiles.activity import Activity
from tangy_profiles.person import Person
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.lexicon import Lexicon, PronouncedWord
from tangy_tui.language.name_pronunciation import HowSaid, how_said


@dataclass(frozen=True, slots=True)
class BehaviourPhrases:
    """The phrases of a behaviour; `to_people`: any of them can be combined with a person."""

    behaviour: str
    question: str
    phrases: tuple[str, ...]
    keywords: tuple[str, ...]
    to_people: bool


@dataclass(frozen=True, slots=True)
class PersonNames:
    """The ways to refer to a person in a command, and the name's pronunciation."""

    person: Person
    ways: tuple[str, ...]
    said: HowSaid


@dataclass(frozen=True)
class PhraseList:
    """Everything that can be said in an activity with these people."""

    title: str
    behaviours: tuple[BehaviourPhrases, ...]
    people: tuple[PersonNames, ...]
    words: tuple[PronouncedWord, ...]
    left_out: Mapping[str, str]
    """Phrases that can only be typed, with the reason."""
    own: Mapping[str, str]
    """A teacher's own phrases, with their behaviours."""

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON."""
        return {
            "title": self.title,
            "behaviours": [
                {
                    "behaviour": ways.behaviour,
                    "question": ways.question,
                    "phrases": list(ways.phrases),
                    "keywords": list(ways.keywords),
                    "to_people": ways.to_people,
                }
                for ways in self.behaviours
            ],
            "people": [
                {
                    "id": called.person.id,
                    "name": called.person.name,
                    "ways": list(called.ways),
                    **called.said.to_json(),
                }
                for called in self.people
            ],
            "words": [
                {"word": said.word, "phones": list(said.phones), "source": said.source or None}
                for said in self.words
            ],
            "left_out": dict(self.left_out),
            "own": dict(self.own),
        }


def list_phrases(
    activity: Activity, people: Sequence[Person], own: Mapping[str, str] | None = None
) -> PhraseList:
    """List the phrases; looking up every word takes some 50 ms.

    Args:
        activity: the activity with all phrases.
        people: the participants.
        own: the phrases that are a teacher's own.
    """
    phrasebook = Phrasebook(activity, people)
    lexicon = Lexicon(phrasebook)
    return PhraseList(
        activity.title,
        tuple(_ways(phrasebook, activity)),
        tuple(_called(phrasebook, people)),
        tuple(sorted(lexicon.words.values(), key=lambda said: said.word)),
        lexicon.left_out(),
        own or {},
    )


def _ways(phrasebook: Phrasebook, activity: Activity) -> Iterator[BehaviourPhrases]:
    own = [p for p in phrasebook.table.all() if p.user is None and p.heard]
    for behaviour in activity.behaviours.values():
        yield BehaviourPhrases(
            behaviour.name,
            behaviour.question,
            tuple(p.shown for p in own if p.behaviour == behaviour.name),
            tuple(" ".join(words) for words in behaviour.keywords),
            behaviour.visits,
        )


def _called(phrasebook: Phrasebook, people: Sequence[Person]) -> Iterator[PersonNames]:
    table = phrasebook.table
    nouns = dict.fromkeys(phrasebook.nouns.values())
    for person in people:
        number = next((n for n, id in table.numbers.items() if id == person.id), "")
        name = next((" ".join(words) for words, id in table.names.items() if id == person.id), "")
        ways = (*(f"{noun} {number}" for noun in nouns if number), name, *person.seats)
        yield PersonNames(person, tuple(dict.fromkeys(filter(None, ways))), how_said(person))
