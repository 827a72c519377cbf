"""Understand sentences that are no phrase of an activity, with a model learnt for it.

Three tiers come of it: *sure* (one behaviour is asked about), *unsure* (up to three are offered),
and nothing. The limits were chosen by hand and looked at on the tuned half of
`tests/bench/sentences.py`, which no figure is quoted for.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass

from tangy_tui.language.intent_model import IntentModel
from tangy_tui.language.mentions import Mentions
from tangy_tui.language.words import FILLERS, Words, bare

SURE = 0.6
UNSURE = 0.35
"""How likely any command has to be for the likeliest to be offered."""
TALK = 0.9
"""Probability of other talk above which only near phrases count."""
WORTH_OFFERING = 0.08
MOST = 3

FORBIDDING = frozenset(("don't", "dont", "not", "never", "no", "nobody", "without"))
OPENINGS = frozenset(("do", "i", "we", "let's", "lets", "let", "us", "should", "must", "better"))
"""Words that can stand before the one that forbids."""
FORBIDS_WITHIN = 4  # words from the beginning


@dataclass(frozen=True, slots=True)
class Meaning:
    """A behaviour that a sentence may ask for, for whom (`user`), and how likely that is."""

    behaviour: str
    user: str | None
    likelihood: float


class Paraphrases:
    """Understands what nobody has written down as a phrase."""

    def __init__(
        self, model: Callable[[], IntentModel], mentions: Mentions, to_people: Collection[str]
    ) -> None:
        """Understand by a model, which is made when it is first needed.

        Behaviours `to_people` are done for the person who is mentioned.
        """
        self._model = model
        self._mentions = mentions
        self._to_people = to_people

    def talk(self, words: Words) -> float:
        """Return the probability, from 0 to 1, that words request nothing."""
        mentioned = self._mentions.find(words)
        return 1.0 if forbids(mentioned.words) else self._likely(mentioned.words).get("", 0.0)

    def meanings(self, words: Words) -> tuple[Meaning, ...]:
        """Return up to three meanings, the likeliest first; none if words ask for nothing."""
        mentioned = self._mentions.find(words)
        if not bare(mentioned.words) or forbids(mentioned.words):
            return ()
        likely = self._likely(mentioned.words)
        if 1 - likely.get("", 0.0) < UNSURE:
            return ()
        ranked = sorted((p, name) for name, p in likely.items() if name)[::-1][:MOST]
        users = mentioned.users
        found: list[Meaning] = []
        for likelihood, name in ranked:
            if found and likelihood < WORTH_OFFERING:
                break
            goes = name in self._to_people
            if goes and (mentioned.strangers or len(users) > 1):
                continue  # nobody knows whom to go to
            user = next(iter(users)) if goes and users else None
            found.append(Meaning(name, user, likelihood))
        return tuple(found)

    def _likely(self, words: Words) -> dict[str, float]:
        return self._model().probabilities(words)


def forbids(words: Words) -> bool:
    """Say whether a sentence begins by asking for something not to be done."""
    for word in words[: FORBIDS_WITHIN + 2]:
        if word in FORBIDDING:
            return True
        if word not in OPENINGS and word not in FILLERS:
            return False
    return False
