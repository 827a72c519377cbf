"""A behaviour of an activity, and an action: one way to execute it.

Each action is ac = f(theta, sp, im, l, ps) of Section III-A-3-i: posture, speech, image, place and
persuasive strategy.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import cast

from tangy_profiles import effects
from tangy_profiles.effects import EFFECTS, Effect
from tangy_profiles.reading import Table

CLOSINGS = ("never", "always", "when correct")
PLACES = ("front", "attended", "here")
SLOTS = ("name", "call", "numbers")
"""Slots in texts for speech and screen: {name}, {call}, {numbers}."""


@dataclass(frozen=True)
class Behaviour:
    """A primitive behaviour b that the robot has from the start (Section III-A-3-i).

    `posture` is the name of theta (the robot's profile has the joint angles), `speech` maps each
    persuasive strategy to sp, `image` is the text of the chest screen (im), and `place` is l.
    `persuades` marks behaviours that need a person to comply; `closes` says when the attended
    person's request is closed; `needs` lists the user states in which it can succeed (empty: all).
    """

    name: str
    question: str
    effect: Effect
    place: str
    posture: str
    image: str
    speech: Mapping[str, str]
    persuades: bool
    closes: str
    needs: tuple[str, ...]
    phrases: tuple[str, ...]
    keywords: tuple[tuple[str, ...], ...]
    wordings: tuple[str, ...] = ()
    """Other wordings: training data for understanding, but not for speech recognition."""
    to: tuple[str, ...] = ()
    """In activities declared by facts: the selectors of its possible persons."""

    @property
    def attends(self) -> bool:
        """Whether it is directed at one person rather than at the group."""
        return self.place == "attended" or bool(self.to)

    @property
    def calls(self) -> bool:
        """Whether it calls the next number."""
        return self.effect in effects.CALLS

    @property
    def visits(self) -> bool:
        """Whether the robot goes to a person."""
        return self.effect in effects.VISITS

    @property
    def returns(self) -> bool:
        """Whether the robot goes back to its place before the group."""
        return self.effect in effects.RETURNS

    @property
    def drives(self) -> bool:
        """Whether the robot drives."""
        return self.effect in effects.DRIVES

    @property
    def clears_marks(self) -> bool:
        """Whether the attended person is asked to take markers off."""
        return self.effect in effects.CLEARS_MARKS

    @property
    def sets_marks(self) -> bool:
        """Whether the attended person is asked to mark numbers."""
        return self.effect in effects.SETS_MARKS

    @property
    def corrects(self) -> bool:
        """Whether the attended person is asked to correct the card."""
        return self.effect in effects.CORRECTS

    @property
    def shows_card(self) -> bool:
        """Whether the attended person is asked to move the card into view."""
        return self.effect in effects.SHOWS_CARD

    @property
    def about_card(self) -> bool:
        """Whether the attended person is asked to do something with the card."""
        return self.effect in effects.ABOUT_CARD

    @property
    def ends(self) -> bool:
        """Whether it ends the game."""
        return self.effect in effects.ENDS

    @property
    def only_talks(self) -> bool:
        """Whether nothing changes but what was said and shown."""
        return self.effect in effects.ONLY_TALKS


def calling(behaviours: Mapping[str, Behaviour]) -> set[str]:
    """Return the names of the behaviours that call a number."""
    return {name for name, behaviour in behaviours.items() if behaviour.calls}


@dataclass(frozen=True)
class Action:
    """One way to execute a behaviour: ac = f(theta, sp, im, l, ps), with its target.

    `speech` and `image` still have their slots, as only the world that executes the action knows
    which number it calls. `Activity.fill` fills them in.
    """

    behaviour: Behaviour
    target: str | None
    strategy: str
    posture: str
    speech: str
    image: str
    place: str


def read_behaviour(entry: Table, strategies: dict[str, str], states: list[str]) -> Behaviour:
    """Read one [[behaviours]] entry.

    Raises:
        ProfileError: one line with file, key, value and the nearest valid word.
    """
    name = entry.text("name")
    spoken = entry.table("speech")
    speech = {s: _template(spoken, s) for s in strategies if s in spoken or len(strategies) == 1}
    spoken.close(also=strategies)
    persuades = entry.flag("persuades", False)
    if persuades and len(speech) < len(strategies):
        missing = next(s for s in strategies if s not in speech)
        raise entry.wrong("speech", f"has no words for the strategy {missing!r}.")
    if not speech:
        raise entry.wrong("speech", "must say something in at least one strategy.")
    first = next(iter(speech.values()))
    phrases = tuple(_spoken(entry, "phrases", p) for p in entry.words("phrases"))
    if not phrases:
        raise entry.wrong("phrases", "must hold at least one phrase to ask for it with.")
    return Behaviour(
        name=name,
        question=entry.text("question", name),
        effect=cast(Effect, entry.choice("effect", EFFECTS)),
        place=entry.choice("place", PLACES),
        posture=entry.text("posture"),
        image=_template(entry, "image"),
        speech=MappingProxyType({s: speech.get(s, first) for s in strategies}),
        persuades=persuades,
        closes=entry.choice("closes", CLOSINGS, "never"),
        needs=entry.words("needs", states, ()),
        phrases=phrases,
        keywords=tuple(
            tuple(_spoken(entry, "keywords", k).split()) for k in entry.words("keywords")
        ),
        wordings=tuple(_spoken(entry, "wordings", w) for w in entry.words("wordings", None, ())),
    )


def _template(table: Table, key: str) -> str:
    text = table.text(key)
    table.check_slots(key, text, SLOTS)
    return text


def _spoken(table: Table, key: str, phrase: str) -> str:
    if not re.fullmatch(r"[a-z']+( [a-z']+)*", phrase):
        raise table.wrong(key, f"{phrase!r} must be lower-case words, as they are spoken.")
    return phrase
