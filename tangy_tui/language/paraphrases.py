"""Understanding of sentences outside the phrases of an activity, by its intent model.

There are three tiers: *sure* (one behaviour is asked about), *unsure* (up to three are offered),
and nothing. `SURE` is the lowest in steps of .05 at which no near sentence of the tuning half of
`tests/bench/sentences.py` was sure as typed. The other thresholds were chosen by hand and checked
on that half. No figure is quoted for these sentences.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass

from tangy_tui.language.intent_model import IntentModel
from tangy_tui.language.mentions import Mentions
from tangy_tui.language.words import FILLERS, Words, bare

SURE = 0.85
UNSURE = 0.25
"""The lowest probability of any command for the likeliest ones to be offered."""
TALK = 0.9
"""Probability of other talk above which only near phrases count."""
WORTH_OFFERING = 0.08
MOST = 3

FORBIDDING = frozenset(("don't", "dont", "not", "never", "no", "nobody", "without"))
OPENINGS = frozenset(("do", "i", "we", "let's", "lets", "let", "us", "should", "must", "better"))
"""Words that may precede a negation at the beginning of a sentence."""
FORBIDS_WITHIN = 4  # words from the beginning


@dataclass(frozen=True, slots=True)
class Meaning:
    """A behaviour that a sentence may ask for, its person (`user`), and its probability."""

    behaviour: str
    user: str | None
    likelihood: float


class Paraphrases:
    """Understands sentences that are not phrases."""

    def __init__(
        self, model: Callable[[], IntentModel], mentions: Mentions, to_people: Collection[str]
    ) -> None:
        """Use an intent model, which is loaded when first needed.

        Behaviours `to_people` are for the person mentioned.
        """
        self._model = model
        self._mentions = mentions
        self._to_people = to_people

    def prepare(self) -> None:
        """Load the model."""
        self._model()

    def talk(self, words: Words) -> float:
        """Return the probability, from 0 to 1, that words ask for nothing."""
        mentioned = self._mentions.find(words)
        return 1.0 if forbids(mentioned.words) else self._likely(mentioned.words).get("", 0.0)

    def meanings(self, *guesses: Words) -> tuple[Meaning, ...]:
        """Return up to three meanings, likeliest first; none if words ask for nothing.

        Of several guesses at what was said, best first, the n-th one counts 1/n. If the best one
        forbids something, the others are probably misheard, and there is no meaning.
        """
        if guesses and forbids(self._mentions.find(guesses[0]).words):
            return ()
        likely: defaultdict[str, float] = defaultdict(float)
        users: defaultdict[tuple[str, str | None], float] = defaultdict(float)
        shares = [1 / place for place in range(1, len(guesses) + 1)]
        for words, share in zip(guesses, shares, strict=True):
            for name, user, likelihood in self._meanings(words):
                likely[name] += likelihood * share / sum(shares)
                users[name, user] += likelihood * share
        if sum(likely.values()) < UNSURE:
            return ()
        whose = dict(sorted(users, key=users.__getitem__))
        ranked = sorted(likely, key=lambda name: (-likely[name], name))[:MOST]
        return tuple(
            Meaning(name, whose[name], likely[name])
            for name in ranked
            if name == ranked[0] or likely[name] >= WORTH_OFFERING
        )

    def _meanings(self, words: Words) -> Iterator[tuple[str, str | None, float]]:
        """Yield each behaviour that words may ask for, its person, and its probability."""
        mentioned = self._mentions.find(words)
        if not bare(mentioned.words) or forbids(mentioned.words):
            return
        users = mentioned.users
        for name, likelihood in self._likely(mentioned.words).items():
            goes = name in self._to_people
            if name and not (goes and (mentioned.strangers or len(users) > 1)):
                yield name, next(iter(users)) if goes and users else None, likelihood

    def _likely(self, words: Words) -> dict[str, float]:
        return self._model().probabilities(words)


def forbids(words: Words) -> bool:
    """Return whether a sentence begins with a negation."""
    for word in words[: FORBIDS_WITHIN + 2]:
        if word in FORBIDDING:
            return True
        if word not in OPENINGS and word not in FILLERS:
            return False
    return False
