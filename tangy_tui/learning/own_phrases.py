"""A teacher's own phrases: spoken, not understood or uncertain, and then typed or chosen.

If the teacher agrees, they become personal phrases for the behaviour that was meant. Speech
recognition and understanding then treat them like the phrases of the activity.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.person import Person
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import OwnPhraseNoted
from tangy_tui.language.answers import yes_or_no
from tangy_tui.language.commands import Learnt, Phrasebook
from tangy_tui.language.intent_model import IntentModel
from tangy_tui.language.steering import steering_of
from tangy_tui.language.stop_sentence import stops
from tangy_tui.language.words import bare, words_of
from tangy_tui.learning.verification import (
    Asked,
    NotUnderstood,
    Offered,
    Refused,
    Say,
    Verification,
)

MOST_WORDS = 12
"""Longer sentences are unlikely to be repeated."""
_SPOKEN = re.compile(r"[a-z']+( [a-z']+)*")  # as the phrases of activities are written


def own_phrases(store: Store, activity: str, teacher: str) -> dict[str, str]:
    """Return the phrases that a teacher has kept for an activity, with their behaviours.

    Without those from which a forgotten person's name was erased: nobody says them any more.
    """
    noted = _noted(store, activity, teacher)
    kept = {text: one.behaviour for text, one in noted.items() if one.kept}
    return {text: behaviour for text, behaviour in kept.items() if _SPOKEN.fullmatch(text)}


def forget_phrase(store: Store, activity: str, teacher: str, text: str) -> bool:
    """Remove a teacher's phrase, never to be offered again; return whether it existed."""
    said = " ".join(text.split()).casefold()
    behaviour = own_phrases(store, activity, teacher).get(said)
    if behaviour is None:
        return False
    _note(store, activity, teacher, said, behaviour, kept=False)
    return True


def personal_activity(activity: Activity, own: Mapping[str, str]) -> Activity:
    """Return an activity with more phrases; phrases of unknown behaviours are ignored."""
    behaviours = {
        name: replace(behaviour, phrases=(*behaviour.phrases, *_more(behaviour, own)))
        for name, behaviour in activity.behaviours.items()
    }
    return replace(activity, behaviours=behaviours)


def personal_phrasebook(
    activity: Activity,
    people: Sequence[Person],
    own: Mapping[str, str],
    learnt: Learnt | None,
) -> Phrasebook:
    """Make a phrasebook with more phrases; `learnt` is the intent model of the plain activity."""

    def by_activity(_: Activity) -> IntentModel:
        assert learnt is not None  # noqa: S101 - else it is never called
        return learnt(activity)

    more = personal_activity(activity, own)
    return Phrasebook(more, people, None if learnt is None else by_activity)


def _more(behaviour: Behaviour, own: Mapping[str, str]) -> Iterator[str]:
    for text, meant in own.items():
        if meant == behaviour.name and text not in behaviour.phrases:
            yield text


class OwnPhrases:
    """Tracks a teacher's words and the behaviours that they turn out to mean."""

    def __init__(self, store: Store, activity: Activity, teacher: str) -> None:
        """Track a teacher."""
        self._store = store
        self._activity = activity
        self._teacher = teacher
        self._unclear = ""  # the last words that were not understood
        self._asked = False  # whether a later command has been understood

    def phrasebook(self, people: Sequence[Person], learnt: Learnt | None) -> Phrasebook:
        """Build the phrasebook for the participants, with the teacher's own phrases."""
        own = own_phrases(self._store, self._activity.name, self._teacher)
        return personal_phrasebook(self._activity, people, own, learnt)

    def followed(self, said: Say, came: Verification) -> Verification:
        """Remember words that were not understood or uncertain; return the verification.

        Only the next command that is understood can be what they mean.
        """
        if isinstance(came, NotUnderstood | Offered):
            self._unclear = "" if said.commands is None else _plain(came.heard)
            self._asked = False
        elif isinstance(came, Asked | Refused):
            self._unclear = "" if self._asked else self._unclear
            self._asked = True
        return came

    def wording(self, behaviour: str) -> str:
        """Return the unclear words that led to this behaviour; "" if there are none to keep."""
        words, self._unclear = self._unclear, ""
        goes = self._activity.behaviour(behaviour).visits  # it names one person
        if goes or not _can_be_kept(words):
            return ""
        known = {*_noted(self._store, self._activity.name, self._teacher)}
        listed = {p for b in self._activity.behaviours.values() for p in b.phrases}
        return "" if words in known | listed else words

    def note(self, text: str, behaviour: str, *, kept: bool) -> None:
        """Store words for a behaviour, or that they are not to be offered again."""
        _note(self._store, self._activity.name, self._teacher, text, behaviour, kept=kept)


def _can_be_kept(words: str) -> bool:
    """Return whether words can be a phrase: no other meaning, and not too many."""
    split = words_of(words)
    if not _SPOKEN.fullmatch(words) or not bare(split) or len(split) > MOST_WORDS:
        return False
    return not stops(words) and yes_or_no(words) is None and steering_of(words) is None


def _plain(text: str) -> str:
    return " ".join(text.split()).strip(" .!?").casefold()


def _note(
    store: Store, activity: str, teacher: str, text: str, behaviour: str, *, kept: bool
) -> None:
    store.append(
        OwnPhraseNoted(
            activity=activity, teacher=teacher, text=text, behaviour=behaviour, kept=kept
        )
    )


def _noted(store: Store, activity: str, teacher: str) -> dict[str, OwnPhraseNoted]:
    """Return the latest note on each of a teacher's phrases."""
    found: dict[str, OwnPhraseNoted] = {}
    for event in store.events(OwnPhraseNoted):
        one = event.record
        if (one.activity, one.teacher) == (activity, teacher):
            found[one.text] = one
    return found
