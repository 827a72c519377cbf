"""Commands that a teacher may say or type, and the behaviours they mean (III-A-1).

The words are matched to the phrases and keywords that the activity lists for each behaviour. Typed
and spoken words are understood in the same way.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import TypeAlias

from tangy_profiles.activity import Activity
from tangy_profiles.person import Person
from tangy_tui.language.intent_model import IntentModel
from tangy_tui.language.mentions import Mentions
from tangy_tui.language.paraphrases import SURE, TALK, Meaning, Paraphrases
from tangy_tui.language.phrasebook import Phrase, Phrases, of_one_meaning
from tangy_tui.language.words import (
    FILLERS,
    Words,
    bare,
    clean,
    in_order,
    likeness,
    run_together,
    stem,
    words_of,
)

MOST_ALTERNATIVES = 3

KEYWORDS_AT_BEST = 0.95  # confidence of keywords in a text that is almost one of their phrases
KEYWORDS_AT_LEAST = 0.55  # and in one that is very different
NEAREST_AT_BEST = 0.79  # confidence of a near phrase
NEAREST_AT_LEAST = 0.45  # lowest similarity to a phrase to be understood
NEARLY_A_PHRASE = 0.9  # confidence that suffices even for words that are probably other talk
MENDED = 0.9  # factor of the confidence after corrected words, besides their similarity
CLEAR_LEAD = 0.2  # lead over the next behaviour from which confidence is not reduced
ALTERNATIVE_AT_LEAST = 0.25
UNKNOWN_WORD = 0.5  # weight of a word outside all phrases; words of phrases weigh up to 1
SAME_WORD = 0.7  # similarity from which a word counts as a misspelling

Learnt: TypeAlias = Callable[[Activity], IntentModel]

LINKS = frozenset(("of", "to"))
LINK_ENDS = frozenset((link,) for link in LINKS)
REFUSALS = frozenset(("don't", "dont", "never", "no", "nobody", "not", "without"))


@dataclass(frozen=True, slots=True)
class Command:
    """A requested behaviour, to be verified before it is executed.

    `arguments` is empty or names the person to go to ({"user": id}). `confidence` is from 0 to 1.
    `heard` is the text. `alternatives` are up to three other behaviours, likeliest first; none for
    an exact phrase.
    """

    behaviour: str
    arguments: Mapping[str, str]
    confidence: float
    heard: str
    alternatives: tuple[str, ...]


class Phrasebook:
    """Matches text to the phrases and keywords of an activity.

    `phrases` maps each phrase, with numbers as digits and in words, to its behaviour; `people` are
    the ids of the participants; `table` has all details of the phrases; `game` are the words of the
    activity's title.
    """

    phrases: Mapping[str, str]
    people: tuple[str, ...]
    table: Phrases
    game: frozenset[str]

    def __init__(
        self,
        activity: Activity,
        people: Sequence[Person],
        learnt: Learnt | None = None,
    ) -> None:
        """Make the phrasebook of an activity and its participants.

        `learnt` returns the intent model of the activity; it is called for the first text that is
        not a phrase. Without it, only phrases and keywords are understood.
        """
        self._to_people = {b.name for b in activity.behaviours.values() if b.visits}
        self.people = tuple(person.id for person in people)
        self.game = frozenset(words_of(activity.title))
        self.nouns = {
            name: (*words_of(name), *words_of(" ".join(activity.behaviours[name].phrases[:1])))[-1]
            for name in self._to_people
        }
        self.table = Phrases(activity, people)
        self._phrases, self._keywords = self.table.by_words, self.table.keywords
        self.phrases = MappingProxyType(
            {
                form: phrase.behaviour
                for phrase in self.table.all()
                for form in (phrase.shown, phrase.said)
            }
        )
        self._bare = of_one_meaning(self._phrases.values(), lambda p: " ".join(p.bare))
        self._joined = of_one_meaning(self._phrases.values(), lambda p: run_together(p.bare))
        self._weights = self.table.word_weights()
        self._learnt: Paraphrases | None = None
        if learnt is not None:
            mentions = Mentions(self.table, self.nouns)
            for_people = self._to_people | {b.name for b in activity.behaviours.values() if b.to}
            self._learnt = Paraphrases(cache(lambda: learnt(activity)), mentions, for_people)

    def understand(self, text: str) -> Command | None:
        """Find the behaviour that a text asks for.

        An exact phrase has confidence 1. Next comes the intent model, if its probability is high
        enough. Keywords of a single behaviour have less confidence the more the rest of the text
        differs from its phrases. Last comes the nearest phrase, if it is near enough. Misspelt
        words are corrected, which also reduces the confidence.
        """
        heard = clean(text)
        words = words_of(heard)
        if words not in self._phrases and self._breaks_off(words):
            return None
        if (exact := self._exact(words)) is not None:
            return _command(exact, 1.0, heard)  # exact, so without alternatives
        mended, trust = self._mend(words)
        learnt = () if self._is_mistyped(words, mended) else self.paraphrased(text)
        if learnt and learnt[0].confidence >= SURE:
            return learnt[0]
        near = self._nearest(heard, words, mended, trust)
        if near is not None and near.confidence < NEARLY_A_PHRASE and self._is_talk(words):
            return None
        return near or (learnt[0] if learnt else None)

    def prepare(self) -> None:
        """Load the intent model, or train it, before the first text has to wait."""
        if self._learnt is not None:
            self._learnt.prepare()

    @property
    def learns(self) -> bool:
        """Whether it also uses the intent model."""
        return self._learnt is not None

    def paraphrased(self, text: str, *others: str) -> tuple[Command, ...]:
        """Return up to three commands by the intent model, likeliest first.

        `others` are further guesses at the same words.
        """
        heard = clean(text)
        if self._learnt is None:
            return ()
        guesses = [words_of(clean(guess)) for guess in (text, *others)]
        found = self._learnt.meanings(*(w if self._stranger(w) is None else () for w in guesses))
        return tuple(
            _meant(meaning, heard, [other.behaviour for other in found if other is not meaning])
            for meaning in found
        )

    def _nearest(self, heard: str, words: Words, mended: Words, trust: float) -> Command | None:
        """Return the behaviour with the nearest phrase or keywords."""
        if self._refuses(words) or self._stranger(words) is not None:
            return None
        found, confidence = self._find(words, mended)
        confidence *= trust
        if found is None or confidence < NEAREST_AT_LEAST or not self._numbers_fit(mended, found):
            return None
        return _command(found, confidence, heard, self._others(found, mended))

    def choices(self, text: str) -> tuple[Command, ...]:
        """Return up to three commands that a text may mean, likeliest first."""
        command = self.understand(text)
        if command is None:
            return ()
        words, _ = self._mend(words_of(clean(text)))
        others = [
            _command(
                phrase, command.confidence * likeness, command.heard, self._others(phrase, words)
            )
            for likeness, phrase in self._ranking(words)
            if phrase.behaviour != command.behaviour and likeness >= ALTERNATIVE_AT_LEAST
        ]
        return (command, *others)[:MOST_ALTERNATIVES]

    def known(self, text: str) -> int:
        """Count the words of a text that occur in phrases and are not fillers."""
        told = (word for word in bare(words_of(clean(text))) if word not in LINKS)
        return sum(word in self._weights for word in told)

    def stranger(self, text: str) -> str | None:
        """Return the unknown person that a text names: "user 7", or an unknown name."""
        words = words_of(clean(text))
        if self._exact(words) is not None or self._refuses(words):
            return None
        return self._stranger(words)

    def suggestions(self, text: str) -> tuple[str, ...]:
        """Return up to three phrases nearest to a text, of different behaviours."""
        words, _ = self._mend(words_of(clean(text)))
        near = [phrase.shown for likeness, phrase in self._ranking(words) if likeness > 0]
        return tuple(near[:MOST_ALTERNATIVES])

    def complete(self, prefix: str) -> tuple[str, ...]:
        """Complete typed text to phrases, most usual first.

        Case and spaces are ignored. Numbers are completed as digits, unless the prefix has part of
        a number in words.
        """
        begun = re.sub(r"\s+", " ", clean(prefix, strip=False).lstrip()).casefold()
        return self.table.complete(begun)

    def spoken(self) -> tuple[str, ...]:
        """Return the spoken phrases, with numbers in words: the vocabulary of speech recognition.

        The name of a behaviour is only included if the activity lists it as a phrase.
        """
        return tuple(dict.fromkeys(phrase.said for phrase in self.table.all() if phrase.heard))

    def pronunciations(self) -> dict[str, tuple[str, ...]]:
        """Return pronunciations (ARPAbet) that replace those of the dictionary.

        They come from the activity and from people's names. A name that is also a word of the
        phrases keeps the pronunciations of the activity or dictionary too.
        """
        return dict(self.table.pronunciations)

    def _is_talk(self, words: Words) -> bool:
        return self._learnt is not None and self._learnt.talk(words) >= TALK

    def _is_mistyped(self, words: Words, mended: Words) -> bool:
        """Return whether words are a misspelt phrase, or one with missing spaces."""
        return self._exact(mended) is not None or run_together(bare(words)) in self._joined

    def _exact(self, words: Words) -> Phrase | None:
        return self._phrases.get(words) or self._bare.get(" ".join(bare(words)))

    def _refuses(self, words: Words) -> bool:
        return any(word in REFUSALS and word not in self._weights for word in words)

    def _breaks_off(self, words: Words) -> bool:
        """Return whether a person's number was misheard: "go to seat you", "go to user to"."""
        said = bare(words)
        if said[-1:] == words[-1:] and said[-1:] not in LINK_ENDS:
            return False
        seat = any(said[-len(noun) :] == noun for noun in self.table.seat_nouns)
        named = self._bare.get(" ".join(said))
        if seat and (named is None or named.user is None):
            return True
        phrase = self._bare.get(" ".join(said[:-1]))
        goes = phrase is not None and phrase.behaviour in self._to_people
        return goes and said[-1:] in LINK_ENDS

    def _stranger(self, words: Words) -> str | None:
        """Return the unknown person: a number without a person, or one unknown word."""
        if not self.people:
            return None
        mended, _ = self._mend(words)
        numbers = [word for word in words if word.isdigit()]
        if numbers:
            found, confidence = self._find(words, mended)
            seat = self._seat_in(mended)
            if (
                found is None
                or found.behaviour not in self._to_people
                or confidence < ALTERNATIVE_AT_LEAST
                or any(
                    (*seat, n) in self.table.seats if seat else n in self.table.numbers
                    for n in numbers
                )
            ):
                return None
            return f"{' '.join(seat) or self.nouns[found.behaviour]} {numbers[0]}"
        said = bare(mended)
        if not said or said[-1] in self._weights or said[-1] not in words:
            return None
        *way, name = said
        for phrase in self._phrases.values():
            if phrase.behaviour in self._to_people and phrase.user is None:
                if tuple(way) == phrase.bare:
                    return f"{phrase.bare[-1]} {name}"
                if len(way) > 1 and tuple(way) == phrase.bare[:-1]:
                    return name
        return None

    def _weight(self, word: str) -> float:
        return self._weights.get(word, UNKNOWN_WORD)

    def _mend(self, words: Words) -> tuple[Words, float]:
        """Correct misspelt words; return the words and a factor of the confidence."""
        mended: list[str] = []
        trust = 1.0
        for word in words:
            if word not in self._weights and word not in FILLERS:
                like, known = max((likeness(word, known), known) for known in self._weights)
                if like >= SAME_WORD:
                    trust = min(trust, MENDED * like)
                    word = known
            mended.append(word)
        return tuple(mended), trust

    def _find(self, words: Words, mended: Words) -> tuple[Phrase | None, float]:
        """Return the best match for words that are no exact phrase, and its confidence."""
        mistyped = self._exact(mended) or self._joined.get(run_together(bare(words)))
        if mistyped is not None:
            return mistyped, 1.0 if mended != words else MENDED
        ranked = self._ranking(mended)
        pointed = self._point(mended)
        if pointed is not None:
            like = max(
                (share for share, p in ranked if p.behaviour == pointed.behaviour), default=0.0
            )
            return pointed, KEYWORDS_AT_LEAST + (KEYWORDS_AT_BEST - KEYWORDS_AT_LEAST) * like
        if not ranked:
            return None, 0.0
        likeness, best = ranked[0]
        lead = likeness - (ranked[1][0] if len(ranked) > 1 else 0.0)
        return best, NEAREST_AT_BEST * likeness * (0.7 + 0.3 * min(1.0, lead / CLEAR_LEAD))

    def _point(self, words: Words) -> Phrase | None:
        """Return the matching keywords, if they all mean the same."""
        found = [entry for entry in self._keywords if in_order(entry.words, words)]
        kept = [
            entry
            for entry in found
            if not any(o.words != entry.words and in_order(entry.words, o.words) for o in found)
        ]
        return kept[0] if len({(e.behaviour, e.user) for e in kept}) == 1 else None

    def _numbers_fit(self, words: Words, found: Phrase) -> bool:
        """Return whether the numbers in a text are those of the matched person."""
        if found.behaviour not in self._to_people:
            return True
        table = self.table
        own = {word for name, id in table.names.items() if id == found.user for word in name}
        if self._seat_in(words):
            own |= {word for seat, id in table.seats.items() if id == found.user for word in seat}
        else:
            own |= {number for number, id in table.numbers.items() if id == found.user}
        return own.issuperset(word for word in words if word.isdigit())

    def _seat_in(self, words: Words) -> Words:
        """Return the word for a seat in a text, if any; its number is then not a person's."""
        return next((noun for noun in self.table.seat_nouns if in_order(noun, words)), ())

    def _others(self, found: Phrase, words: Words) -> tuple[str, ...]:
        """Return up to three other behaviours that words may mean, likeliest first."""
        others = [
            phrase.behaviour
            for likeness, phrase in self._ranking(words)
            if phrase.behaviour != found.behaviour and likeness >= ALTERNATIVE_AT_LEAST
        ]
        return tuple(others[:MOST_ALTERNATIVES])

    def _ranking(self, words: Words) -> list[tuple[float, Phrase]]:
        """Return the most similar phrase of each behaviour, most similar first."""
        said = bare(words)
        best: dict[str, tuple[float, Phrase]] = {}
        for phrase in self._phrases.values():
            likeness = self._phrase_likeness(said, phrase.bare) if said else 0.0
            if likeness > best.get(phrase.behaviour, (0.0, phrase))[0]:
                best[phrase.behaviour] = (likeness, phrase)
        return sorted(best.values(), key=lambda found: (-found[0], found[1].rank))

    def _phrase_likeness(self, said: Words, phrase: Words) -> float:
        """Return a similarity by the word edit distance, weighted by how distinctive words are."""
        told = [self._weight(word) for word in phrase]
        spent = [self._weight(word) for word in said]
        wanted = list(enumerate(zip([stem(word) for word in phrase], told, strict=True)))
        row = [0.0]
        for weight in told:
            row.append(row[-1] + weight)
        for word, cost in zip([stem(word) for word in said], spent, strict=True):
            last, row = row, [row[0] + cost]
            for place, (known, weight) in wanted:
                swap = 0.0 if word == known else cost + weight
                row.append(min(last[place + 1] + cost, row[-1] + weight, last[place] + swap))
        return max(0.0, 1 - row[-1] / (sum(told) + sum(spent)))


def _meant(meaning: Meaning, heard: str, others: Sequence[str]) -> Command:
    arguments = MappingProxyType({} if meaning.user is None else {"user": meaning.user})
    likelihood = round(meaning.likelihood, 3)
    return Command(meaning.behaviour, arguments, likelihood, heard, tuple(others))


def _command(
    found: Phrase, confidence: float, heard: str, alternatives: tuple[str, ...] = ()
) -> Command:
    arguments = MappingProxyType({} if found.user is None else {"user": found.user})
    return Command(found.behaviour, arguments, round(confidence, 3), heard, alternatives)
