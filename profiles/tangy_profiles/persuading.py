"""The configuration of persuasion: the method of choosing and learning strategies."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal, cast, get_args

from tangy_profiles.codec import InvalidValue, one_of
from tangy_profiles.errors import ProfileError
from tangy_profiles.extensions import extensions
from tangy_profiles.reading import Table, nearest, plain

MethodName = Literal["thompson", "bayes-ucb"]
PERSUASION_METHODS: tuple[MethodName, ...] = get_args(MethodName)


def known_methods() -> tuple[str, ...]:
    """Return the names of the built-in methods, and of those of other packages."""
    return tuple(dict.fromkeys((*PERSUASION_METHODS, *extensions("methods"))))


def is_method(name: str) -> bool:
    """Return whether there is a method of that name."""
    return name in PERSUASION_METHODS or name in extensions("methods")


PRIORS = ("uniform", "people")
PERIODS = ("interaction", "day")
DEFAULT = "default"
"""The word for the activity's own method."""

LEAST_KEPT = 0.5
"""The lowest share to keep; below a half nothing would be learnt."""


def _method(name: str) -> str:
    return name if is_method(name) else cast(str, one_of(*PERSUASION_METHODS)(name))


def _share(value: float) -> float:
    if not LEAST_KEPT <= value <= 1:
        raise InvalidValue("is not a share that can be kept")
    return value


@dataclass(frozen=True)
class PersuasionConfig:
    """A choice of method; the defaults are the paper's.

    `method` chooses by the beliefs, `prior` is their start ("people": fitted to earlier people),
    and `forgetting` is the share of the evidence that is kept from one interaction, or one day, to
    the next (1: everything).
    """

    method: Annotated[str, _method] = "thompson"
    prior: Annotated[str, one_of(*PRIORS)] = "uniform"
    forgetting: Annotated[float, _share] = 1.0
    forgetting_per: Annotated[str, one_of(*PERIODS)] = "interaction"


PAPER = PersuasionConfig()


def read_persuading(table: Table) -> PersuasionConfig:
    """Read an activity's [persuasion]; the defaults are the paper's.

    Raises:
        ProfileError: one line with file, key, value and the nearest valid word.
    """
    method = table.text("method", PAPER.method)
    if not is_method(method):
        table.choice("method", known_methods())  # raises the error
    chosen = PersuasionConfig(
        method,
        table.choice("prior", PRIORS, PAPER.prior),
        table.number("forgetting", LEAST_KEPT, 1, PAPER.forgetting),
        table.choice("forgetting_per", PERIODS, PAPER.forgetting_per),
    )
    table.close()
    return chosen


def spoken_persuading(words: Iterable[str]) -> PersuasionConfig:
    """Parse a choice from words in any order: "bayes-ucb people 0.98 day".

    Raises:
        ProfileError: a word is unknown, or repeats a setting.
    """
    chosen, said = PAPER, set[str]()
    for word in words:
        key, value = _meant(word)
        if key in said:
            raise ProfileError(plain(f"{word!r} says again what another word has said."))
        said.add(key)
        chosen = replace(chosen, **{key: value})
    if "forgetting_per" in said and "forgetting" not in said:
        raise ProfileError(
            f"{chosen.forgetting_per!r} needs the share that is kept, for example 0.98."
        )
    return chosen


def _meant(word: str) -> tuple[str, Any]:
    """Return the setting that a word is for, and its value."""
    for key, known in (("method", known_methods()), ("prior", PRIORS), ("forgetting_per", PERIODS)):
        if word.casefold() in known:
            return key, word.casefold()
    try:
        share = float(word)
    except ValueError:
        known_words = (*known_methods(), *PRIORS, *PERIODS, DEFAULT)
        raise ProfileError(
            plain(f"There is no method {word!r}: {nearest(word, known_words)}")
        ) from None
    if not LEAST_KEPT <= share <= 1 or math.isnan(share):
        raise ProfileError(
            f"The share that is kept must be from {LEAST_KEPT:g} to 1, not {share:g}."
        )
    return "forgetting", share
