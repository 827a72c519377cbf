"""The pronunciation of each word of a phrasebook, and phrases that sound the same."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, product
from typing import Literal, TypeAlias

from tangy_profiles.activity import Activity
from tangy_profiles.errors import ProfileError
from tangy_profiles.phones import PHONES, read_name_phones
from tangy_profiles.reading import plain
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.phrasebook import Phrase
from tangy_tui.language.pronunciation import pronounce, suggest
from tangy_tui.language.stop_sentence import stops
from tangy_tui.language.words import Words, clean, spoken, words_of

MOST_WAYS = 64  # pronunciations of one phrase; the first ones of most words come first

WordSource: TypeAlias = Literal["activity", "person", "dictionary", "suggested", ""]
"""The source of a pronunciation; "" if unknown."""


@dataclass(frozen=True, slots=True)
class PronouncedWord:
    """A word with its pronunciations and their source.

    `source` is "activity", "person", "dictionary", "suggested" (a guess, which is not recognised),
    or "" if not even a guess is possible.
    """

    word: str
    phones: tuple[str, ...]
    source: WordSource

    @property
    def heard(self) -> bool:
        """Whether speech recognition knows the word."""
        return self.source not in ("suggested", "")


@dataclass(frozen=True, slots=True)
class SoundAlike:
    """A phrase that sounds (nearly) like an earlier one with another meaning."""

    phrase: Phrase
    other: Phrase


class Lexicon:
    """The words of a phrasebook with their pronunciations.

    It reads the pronouncing dictionary: some 30 ms for the words of an activity.
    """

    words: Mapping[str, PronouncedWord]
    """Every word that can be spoken or typed, with its pronunciations."""
    alike: tuple[SoundAlike, ...]
    """Phrases that sound like earlier ones and are not recognised; the earlier ones are."""
    phrases: tuple[Phrase, ...]
    """The phrases to recognise, if possible."""
    whose: Mapping[str, str]
    """The person of each word of a name."""

    def __init__(
        self,
        phrasebook: Phrasebook,
        *,
        pronounce: Callable[[str], tuple[str, ...]] = pronounce,
        suggest: Callable[[str], str] = suggest,
    ) -> None:
        """Look up every word; `suggest` guesses the pronunciation of unknown ones."""
        self.phrases = tuple(p for p in phrasebook.table.all() if p.heard)
        self._pronounce, self._suggest = pronounce, suggest
        self._table = phrasebook.table
        self.whose = {word: id for words, id in self._table.names.items() for word in words}
        spoken = (word for p in phrasebook.table.all() for word in p.said.split())
        self.words = {word: self._look_up(word) for word in dict.fromkeys(spoken)}
        self.alike = tuple(self._find_alike())

    @property
    def unknown(self) -> tuple[PronouncedWord, ...]:
        """The words of phrases without a pronunciation, with suggestions."""
        words = dict.fromkeys(word for phrase in self.phrases for word in phrase.said.split())
        return tuple(self.words[word] for word in words if not self.words[word].heard)

    def heard(self) -> tuple[str, ...]:
        """Return the phrases that can be recognised, in spoken form."""
        out = {one.phrase.said for one in self.alike}
        return tuple(
            dict.fromkeys(p.said for p in self.phrases if self._known(p) and p.said not in out)
        )

    def confusable_phrases(self) -> tuple[SoundAlike, ...]:
        """Return phrases of different behaviours that differ in one phone.

        They can be recognised, but are easily confused; all pronunciations are compared.
        """
        out = {one.phrase.said for one in self.alike}
        first: dict[Words, list[Phrase]] = defaultdict(list)
        found: dict[tuple[str, str], SoundAlike] = {}
        for phrase in self.phrases:
            if phrase.said in out or not self._known(phrase):
                continue
            forms = {form for way in self._ways(phrase) for form in _one_less(way.split())}
            for other in (other for form in forms for other in first[form]):
                if other.behaviour != phrase.behaviour:
                    found.setdefault((phrase.said, other.said), SoundAlike(phrase, other))
            for form in forms:
                first[form].append(phrase)
        return tuple(found.values())

    def left_out(self) -> dict[str, str]:
        """Return the phrases that can only be typed, each with the reason in words."""
        reasons = {one.phrase.said: f"sounds like {one.other.said!r}" for one in self.alike}
        for phrase in self.phrases:
            lacks = [word for word in phrase.said.split() if not self.words[word].heard]
            if lacks:
                reasons[phrase.said] = f"no pronunciation of {', '.join(map(repr, lacks))}"
        return reasons

    def _look_up(self, word: str) -> PronouncedWord:
        if word in self._table.pronunciations:
            return PronouncedWord(word, self._table.pronunciations[word], self._table.sources[word])
        known = self._pronounce(word)
        if known:
            return PronouncedWord(word, known, "dictionary")
        guessed = self._suggest(word)
        return (
            PronouncedWord(word, (guessed,), "suggested")
            if guessed
            else PronouncedWord(word, (), "")
        )

    def _known(self, phrase: Phrase) -> bool:
        return all(self.words[word].heard for word in phrase.said.split())

    def _find_alike(self) -> Iterator[SoundAlike]:
        """Yield phrases with different meanings and the same phones."""
        first: dict[str, Phrase] = {}
        for phrase in filter(self._known, self.phrases):
            ways = set(self._ways(phrase))
            other = next((first[way] for way in ways if _differ(first.get(way), phrase)), None)
            if other is not None:
                yield SoundAlike(phrase, other)
            else:
                for way in ways:
                    first.setdefault(way, phrase)

    def _ways(self, phrase: Phrase) -> Iterator[str]:
        """Yield the pronunciations of a phrase, as phones without word boundaries."""
        choices = [self.words[word].phones for word in phrase.said.split()]
        return (" ".join(way) for way in islice(product(*choices), MOST_WAYS))


def _one_less(phones: Sequence[str]) -> Iterator[Words]:
    """Yield keys that two phrases share if they differ in one phone."""
    for place in range(len(phones)):
        yield (*phones[:place], "", *phones[place + 1 :])  # one phone replaced
    for place in range(len(phones) + 1):
        yield (*phones[:place], "", *phones[place:])  # or inserted


def _differ(other: Phrase | None, phrase: Phrase) -> bool:
    return other is not None and (other.behaviour, other.user) != (phrase.behaviour, phrase.user)


def distinct_word(phrasebook: Phrasebook, behaviour: str, phrase: Phrase) -> str:
    """Return a word used only for one behaviour and missing in a phrase; "" if none.

    The phrase with the word before it does not stop the robot.
    """
    users: dict[str, set[str]] = defaultdict(set)
    for entry in (*phrasebook.table.all(), *phrasebook.table.keywords):
        for word in entry.bare:
            users[word].add(entry.behaviour)
    own = (word for entry in phrasebook.table.all() for word in entry.bare
           if entry.behaviour == behaviour and entry.user is None)  # fmt: skip
    for word in own:
        fits = users[word] == {behaviour} and word not in phrase.words
        if fits and not stops(f"{word} {phrase.said}"):
            return word
    return ""


def phones_of(text: str, activity: Activity) -> str:
    """Return the phones to speak: given in capitals, or those of words.

    Raises:
        ProfileError: a phone is invalid, or a word has no pronunciation.
    """
    if text.isupper() and (" " in text.strip() or text.strip() in PHONES):
        return read_name_phones(text)
    words = spoken(words_of(clean(text))).split()
    found = [
        [*activity.pronunciations.get(word, ()), *pronounce(word)] or [suggest(word)]
        for word in words
    ]
    if not words or not all(ways[0] for ways in found):
        raise ProfileError(plain(f"Nobody knows how {clean(text)!r} is said: give the phones."))
    return ", ".join(ways[0] for ways in found)
