"""Effects, methods, faults and device states are closed sets: a place that lacks one is named."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator
from functools import cache
from pathlib import Path
from typing import get_args

import pytest

from tangy_profiles import effects
from tangy_profiles.effects import EFFECTS
from tangy_profiles.health import STATES, DeviceState
from tangy_profiles.persuading import PERSUASION_METHODS, PersuasionConfig
from tangy_sim.worlds.injection import KINDS
from tangy_tui.interaction.methods import method_of
from tangy_tui.monitoring import evidence
from tangy_tui.text import people

ROOT = Path(__file__).parents[2]
WORLDS = (
    "sim/tangy_sim/worlds/world.py",
    "sim/tangy_sim/device_simulator/people.py",
    "hw/tangy_hw/robot_client/live_world.py",
)
"""The modules that define an effect's result in a world."""


def places(attribute: str) -> Iterator[tuple[str, int, set[str]]]:
    """Yield the places where the program matches an attribute, and the words of the cases."""
    tops = [ROOT / top for top in ("hw", "profiles", "sim", "tangy_tui")]
    for path in sorted(path for top in tops for path in top.rglob("*.py")):
        source = path.read_text(encoding="utf-8")
        if not re.search(rf"\bmatch\b.*\b{attribute}\b", source, re.DOTALL):
            continue  # most files: parsing all takes seconds
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.Match) and getattr(node.subject, "attr", "") == attribute:
                parts = [part for case in node.cases for part in ast.walk(case.pattern)]
                words = [part.value for part in parts if isinstance(part, ast.MatchValue)]
                found = {word.value for word in words if isinstance(word, ast.Constant)}
                yield path.relative_to(ROOT).as_posix(), node.lineno, set(map(str, found))


def comparisons(attributes: Collection[str]) -> Iterator[tuple[str, int, str]]:
    """Yield the places where the program compares one of some attributes."""
    tops = [ROOT / top for top in ("hw", "profiles", "sim", "tangy_tui")]
    for path in sorted(path for top in tops for path in top.rglob("*.py")):
        source = path.read_text(encoding="utf-8")
        if not re.search(rf"\.({'|'.join(attributes)})\b", source):
            continue
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.Compare):
                for one in (node.left, *node.comparators):
                    if isinstance(one, ast.Attribute) and one.attr in attributes:
                        yield one.attr, node.lineno, path.relative_to(ROOT).as_posix()


@cache
def matches() -> list[tuple[str, int, set[str]]]:
    """Return the places that match an effect; lazily, so that not every worker searches."""
    return list(places("effect"))


BENCH = ("sim/tangy_sim/device_simulator", "tangy_tui/app/simulated_devices_world.py")
"""Where the bench simulates faults: each part asks for its own kinds by name."""


@cache
def bench_words() -> set[str]:
    """Return the words in quotes that look like kinds of faults in the bench's modules."""
    paths = [*(ROOT / BENCH[0]).rglob("*.py"), ROOT / BENCH[1]]
    found = (re.findall(r'"([a-z-]+)"', path.read_text(encoding="utf-8")) for path in paths)
    return {word for words in found for word in words}


def missing(place: str, known: Collection[str], told: Collection[str]) -> str:
    return ", ".join(f"{place} says nothing of {one!r}" for one in known if one not in told)


@pytest.mark.parametrize("effect", EFFECTS)
def test_every_effect_is_implemented_by_both_worlds_and_the_bench(effect: str) -> None:
    assert {path for path, _, _ in matches()} >= set(WORLDS)
    forgotten = [missing(f"{path}:{line}", [effect], told) for path, line, told in matches()]
    assert not any(forgotten), "; ".join(filter(None, forgotten))


def test_no_world_implements_an_unknown_effect() -> None:
    assert {word for _, _, told in matches() for word in told} == set(EFFECTS)


def test_every_effect_answers_a_question_of_a_behaviour() -> None:
    groups = (value for name, value in vars(effects).items() if name.isupper())
    questions = [set(group) for group in groups if group is not EFFECTS]
    assert set().union(*questions) == set(EFFECTS)


DECLARED_IN = {
    "effect": ("profiles/tangy_profiles/behaviour.py",),
    "does": ("profiles/tangy_profiles/declared/",),
}
"""Where effects may be compared, of activities with cards and of those by facts."""


def test_effects_are_compared_only_where_they_are_declared() -> None:
    found = [
        f"{path}:{line} asks for {attribute!r}"
        for attribute, line, path in comparisons(tuple(DECLARED_IN))
        if not path.startswith(DECLARED_IN[attribute])
    ]
    assert found == []


@pytest.mark.parametrize("name", PERSUASION_METHODS)
def test_every_method_of_persuasion_has_an_implementation_and_words(name: str) -> None:
    assert method_of(PersuasionConfig(name)).words
    assert name in people.METHOD_TITLES, (
        f"METHOD_TITLES of {people.__name__} has no words for {name!r}"
    )


@pytest.mark.parametrize("kind", KINDS)
def test_the_bench_simulates_every_kind_of_fault(kind: str) -> None:
    words = bench_words()
    assert kind in words, f"no part of {BENCH[0]} simulates {kind!r}, nor does {BENCH[1]}"


def test_every_device_state_has_a_rank_and_words() -> None:
    states = get_args(DeviceState)
    told: dict[str, Collection[str]] = {
        "STATES of tangy_profiles.health": STATES,
        "STATES of tangy_tui.monitoring.evidence": evidence.STATES,
    }
    forgotten = [missing(place, states, words) for place, words in told.items()]
    assert not any(forgotten), "; ".join(filter(None, forgotten))
