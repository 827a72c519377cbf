"""What a teacher may say or type, and which behaviour is meant by it (III-A-1).

The identified words are matched to the phrases and keywords that the activity lists for each
behaviour. Typed and spoken words come through this one door, so both are understood alike.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.person import Person
from tangy_tui.learning.words import (
    FILLERS,
    Words,
    bare,
    clean,
    in_order,
    likeness,
    run_together,
    spoken,
    stem,
    words_of,
)

MOST_ALTERNATIVES = 3

KEYWORDS_AT_BEST = 0.95  # confidence of keywords in a text that is almost a phrase of theirs
KEYWORDS_AT_LEAST = 0.55  # and in one that is quite unlike
NEAREST_AT_BEST = 0.79  # confidence of a phrase that is nearly the one that was said
NEAREST_AT_LEAST = 0.45  # what is less like any phrase is not understood
MENDED = 0.9  # what is left of the confidence when words were mended, besides their likeness
CLEAR_LEAD = 0.2  # a lead over the next behaviour that takes nothing off the confidence
ALTERNATIVE_AT_LEAST = 0.25
UNKNOWN_WORD = 0.5  # weight of a word that no phrase has; those of the phrases weigh up to 1
SAME_WORD = 0.7  # likeness from which a word is taken for a slip of another

ARTICLES = frozenset(("a", "an", "the"))
REFUSALS = frozenset(("don't", "dont", "never", "no", "nobody", "not", "without"))


@dataclass(frozen=True, slots=True)
class Command:
    """A behaviour as it was asked for, to be verified before it is executed.

    `arguments` is empty or names the person to go to ({"user": id}); `confidence` runs from 0 to
    1; `heard` is the text it was understood from; `alternatives` are up to three other
    behaviours, likeliest first.
    """

    behaviour: str
    arguments: Mapping[str, str]
    confidence: float
    heard: str
    alternatives: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _Phrase:
    """One way to ask for a behaviour, or the keywords of one; numbers stand as digits.

    `bare` are the words without fillers; `rank` orders what is equally good.
    """

    words: Words
    bare: Words
    behaviour: str
    user: str | None
    rank: tuple[int, int]

    @property
    def shown(self) -> str:
        return " ".join(self.words)


class Phrasebook:
    """Every phrase and keyword of an activity, with the people who take part in it.

    Behaviours that go to a person can be asked for with that person's number or name ("go to user
    2", "go to user two", "go to rosa"). The number is the one their id ends with, or their place
    in the list where the ids have none.
    """

    phrases: Mapping[str, str]
    people: tuple[str, ...]
    """The ids of those who can be gone to."""

    def __init__(self, activity: Activity, people: Sequence[Person]) -> None:
        self._behaviours = tuple(activity.behaviours)
        self._to_people = {b.name for b in activity.behaviours.values() if b.effect == "go to user"}
        self.people = tuple(person.id for person in people)
        self._numbers = _numbers_of(people)
        self._names = _names_of(people)
        self._nouns = {
            name: (*words_of(name), *words_of(" ".join(activity.behaviours[name].phrases[:1])))[-1]
            for name in self._to_people
        }
        self._phrases: dict[Words, _Phrase] = {}
        self._keywords: list[_Phrase] = []
        for behaviour in activity.behaviours.values():
            self._add_phrases(behaviour)
        self._untold = len(self._phrases)
        for behaviour in activity.behaviours.values():
            self._add(words_of(behaviour.name), behaviour.name, None, len(behaviour.phrases) + 1)
        for behaviour in activity.behaviours.values():
            self._add_keywords(behaviour)
            if behaviour.effect == "go to user":
                self._add_people(behaviour)
        self.phrases = MappingProxyType(
            {
                form: phrase.behaviour
                for phrase in self._phrases.values()
                for form in (phrase.shown, spoken(phrase.words))
            }
        )
        self._bare = _of_one_meaning(self._phrases.values(), lambda p: " ".join(p.bare))
        self._joined = _of_one_meaning(self._phrases.values(), lambda p: run_together(p.bare))
        self._weights = self._word_weights()

    def understand(self, text: str) -> Command | None:
        """Find the behaviour that a text asks for.

        An exact phrase counts 1. Keywords that point to one behaviour count less, by how unlike
        its phrases the rest of the text is; then comes the nearest phrase, if it is near enough.
        Words that look like typing slips of known ones are mended, which costs confidence too.
        """
        heard = clean(text)
        words = words_of(heard)
        if (exact := self._exact(words)) is not None:
            return self._command(exact, 1.0, heard, words)
        if self._refuses(words) or self._stranger(words) is not None:
            return None
        mended, trust = self._mend(words)
        found, confidence = self._find(words, mended)
        confidence *= trust
        if found is None or confidence < NEAREST_AT_LEAST or not self._numbers_fit(words, found):
            return None
        return self._command(found, confidence, heard, mended)

    def stranger(self, text: str) -> str | None:
        """Return whom a text goes to if that is nobody here: "user 7", or a name alone."""
        words = words_of(clean(text))
        if self._exact(words) is not None or self._refuses(words):
            return None
        return self._stranger(words)

    def suggestions(self, text: str) -> tuple[str, ...]:
        """Return up to three phrases that a text comes nearest to, of different behaviours."""
        words, _ = self._mend(words_of(clean(text)))
        near = [phrase.shown for likeness, phrase in self._ranking(words) if likeness > 0]
        return tuple(near[:MOST_ALTERNATIVES])

    def complete(self, prefix: str) -> tuple[str, ...]:
        """Return the phrases that begin with what has been typed, the most usual ones first.

        Case and spaces are of no account. Numbers are completed as digits, unless the prefix
        already has a part of a number in words.
        """
        begun = re.sub(r"\s+", " ", clean(prefix, strip=False).lstrip()).casefold()
        ranked = sorted(self._phrases.values(), key=lambda phrase: phrase.rank)
        shown = dict.fromkeys(p.shown for p in ranked if p.shown.startswith(begun))
        if not shown:
            written = (spoken(phrase.words) for phrase in ranked)
            shown = dict.fromkeys(form for form in written if form.startswith(begun))
        return tuple(shown)

    def spoken(self) -> tuple[str, ...]:
        """Return the phrases as they are said, numbers in words: what a recogniser listens for.

        The plain name of a behaviour is not among them unless the activity lists it as a phrase.
        """
        listed = list(self._phrases.values())
        said = [p for place, p in enumerate(listed) if place < self._untold or p.user is not None]
        return tuple(dict.fromkeys(spoken(phrase.words) for phrase in said))

    def _add(self, words: Words, behaviour: str, user: str | None, place: int) -> None:
        """Enter a phrase; what was entered first keeps its meaning."""
        if words and words not in self._phrases:
            self._phrases[words] = self._entry(words, behaviour, user, place)

    def _entry(self, words: Words, behaviour: str, user: str | None, place: int) -> _Phrase:
        rank = (place, self._behaviours.index(behaviour))
        return _Phrase(words, bare(words), behaviour, user, rank)

    def _add_phrases(self, behaviour: Behaviour) -> None:
        for place, text in enumerate(behaviour.phrases):
            self._add(words_of(text), behaviour.name, None, place)
        self._add(words_of(behaviour.question), behaviour.name, None, len(behaviour.phrases))

    def _add_people(self, behaviour: Behaviour) -> None:
        """Put people in the place of the last word of each phrase: "go to [the] user"."""
        for place, text in enumerate(behaviour.phrases):
            *verb, noun = words_of(text)
            while verb and verb[-1] in ARTICLES:
                verb.pop()
            for number, user in self._numbers.items():
                self._add((*verb, noun, number), behaviour.name, user, place)
            for name, user in self._names.items():
                self._add((*verb, *name), behaviour.name, user, place)

    def _add_keywords(self, behaviour: Behaviour) -> None:
        for place, entry in enumerate(behaviour.keywords):
            words = words_of(" ".join(entry))
            forms: list[tuple[Words, str | None]] = [(words, None)]
            if behaviour.effect == "go to user":
                forms += [((*words, number), user) for number, user in self._numbers.items()]
                forms += [((*words[:-1], *name), user) for name, user in self._names.items()]
            self._keywords += [self._entry(w, behaviour.name, user, place) for w, user in forms]

    def _exact(self, words: Words) -> _Phrase | None:
        return self._phrases.get(words) or self._bare.get(" ".join(bare(words)))

    def _refuses(self, words: Words) -> bool:
        return any(word in REFUSALS and word not in self._weights for word in words)

    def _stranger(self, words: Words) -> str | None:
        """Find a number that is nobody's, or one unknown word in the place of a person."""
        if not self.people:
            return None
        mended, _ = self._mend(words)
        numbers = [word for word in words if word.isdigit()]
        if numbers:
            found, confidence = self._find(words, mended)
            if (
                found is None
                or found.behaviour not in self._to_people
                or confidence < ALTERNATIVE_AT_LEAST
                or any(number in self._numbers for number in numbers)
            ):
                return None
            return f"{self._nouns[found.behaviour]} {numbers[0]}"
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

    def _word_weights(self) -> dict[str, float]:
        """Weigh every word of the phrasebook: the more behaviours share it, the less it tells."""
        users: dict[str, set[str]] = defaultdict(set)
        for phrase in (*self._phrases.values(), *self._keywords):
            for word in phrase.words:
                users[word].add(phrase.behaviour)
        return {word: 1 / len(behaviours) for word, behaviours in users.items()}

    def _weight(self, word: str) -> float:
        return self._weights.get(word, UNKNOWN_WORD)

    def _mend(self, words: Words) -> tuple[Words, float]:
        """Put the known word for each typing slip; return the words and how far to trust them."""
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

    def _find(self, words: Words, mended: Words) -> tuple[_Phrase | None, float]:
        """Return what words mean that are no phrase as they stand, and how sure that is."""
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

    def _point(self, words: Words) -> _Phrase | None:
        """Return the keywords that were heard, if they all mean the same."""
        found = [entry for entry in self._keywords if in_order(entry.words, words)]
        kept = [
            entry
            for entry in found
            if not any(o.words != entry.words and in_order(entry.words, o.words) for o in found)
        ]
        return kept[0] if len({(e.behaviour, e.user) for e in kept}) == 1 else None

    def _numbers_fit(self, words: Words, found: _Phrase) -> bool:
        """Refuse to go to anybody when a number was said that is not that person's."""
        if found.behaviour not in self._to_people:
            return True
        own = {number for number, id in self._numbers.items() if id == found.user}
        own |= {word for name, id in self._names.items() if id == found.user for word in name}
        return own.issuperset(word for word in words if word.isdigit())

    def _command(self, found: _Phrase, confidence: float, heard: str, words: Words) -> Command:
        others = [
            phrase.behaviour
            for likeness, phrase in self._ranking(words)
            if phrase.behaviour != found.behaviour and likeness >= ALTERNATIVE_AT_LEAST
        ]
        arguments = MappingProxyType({} if found.user is None else {"user": found.user})
        alternatives = tuple(others[:MOST_ALTERNATIVES])
        return Command(found.behaviour, arguments, round(confidence, 3), heard, alternatives)

    def _ranking(self, words: Words) -> list[tuple[float, _Phrase]]:
        """Return each behaviour's phrase that is most like the words, the likest first."""
        said = bare(words)
        best: dict[str, tuple[float, _Phrase]] = {}
        for phrase in self._phrases.values():
            likeness = self._phrase_likeness(said, phrase.bare) if said else 0.0
            if likeness > best.get(phrase.behaviour, (0.0, phrase))[0]:
                best[phrase.behaviour] = (likeness, phrase)
        return sorted(best.values(), key=lambda found: (-found[0], found[1].rank))

    def _phrase_likeness(self, said: Words, phrase: Words) -> float:
        """Compare by an edit distance over words, each weighed by how much it tells."""
        told = [self._weight(word) for word in phrase]
        spent = [self._weight(word) for word in said]
        row = [0.0]
        for weight in told:
            row.append(row[-1] + weight)
        for word, cost in zip(said, spent, strict=True):
            last, row = row, [row[0] + cost]
            for place, (known, weight) in enumerate(zip(phrase, told, strict=True)):
                swap = 0.0 if stem(word) == stem(known) else cost + weight
                row.append(min(last[place + 1] + cost, row[-1] + weight, last[place] + swap))
        return max(0.0, 1 - row[-1] / (sum(told) + sum(spent)))


def _of_one_meaning(
    phrases: Iterable[_Phrase], key: Callable[[_Phrase], str]
) -> dict[str, _Phrase]:
    """Return the phrases by a key, where all phrases with that key mean the same."""
    found: dict[str, list[_Phrase]] = defaultdict(list)
    for phrase in phrases:
        found[key(phrase)].append(phrase)
    return {
        form: same[0]
        for form, same in found.items()
        if form and len({(phrase.behaviour, phrase.user) for phrase in same}) == 1
    }


def _numbers_of(people: Sequence[Person]) -> dict[str, str]:
    """Return ids by number: the number that the ids end with, else the place in the list."""
    ends = [re.search("[0-9]{1,2}$", person.id) for person in people]
    numbers = [str(int(end.group())) for end in ends if end]
    if len(set(numbers)) < len(people):
        numbers = [str(place) for place in range(1, len(people) + 1)]
    return {number: person.id for number, person in zip(numbers, people, strict=True)}


def _names_of(people: Sequence[Person]) -> dict[Words, str]:
    """Return ids by name; a name that two people share, or that has no word, is left out."""
    named: dict[Words, list[str]] = defaultdict(list)
    for person in people:
        named[words_of(clean(person.name))].append(person.id)
    return {name: ids[0] for name, ids in named.items() if bare(name) and len(ids) == 1}
