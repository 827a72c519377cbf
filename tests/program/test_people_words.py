"""The sentences about a person with few data and with disabled strategies."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.beliefs import Beta
from tangy_profiles.person import Person
from tangy_profiles.store import Store
from tangy_tui.interaction.memory import PersonModel, PersonModels
from tangy_tui.interaction.methods import Thompson
from tangy_tui.interaction.record import (
    PersonSummary,
    best_of_those_on,
    on_of,
    read_records,
    settled_of,
)
from tangy_tui.text.people import sentence
from tests.support.append_body import append_body

NAMES = ("neutral", "praise", "suggestion", "scarcity")
NOW = datetime(2026, 5, 22, 15, tzinfo=UTC)
Counts = Mapping[str, tuple[int, int]]


@pytest.fixture
def noted(tmp_path: Path) -> Callable[..., PersonSummary]:
    """Read Rosa's record from a log with these counts and switches."""

    def note(
        counts: Counts, off: tuple[str, ...] = (), strategies: tuple[str, ...] = NAMES
    ) -> PersonSummary:
        with Store.open(tmp_path / "data") as store:
            for strategy, (yes, no) in counts.items():
                for complied in [True] * yes + [False] * no:
                    append_body(
                        store, "response", {}, person="user1", strategy=strategy, complied=complied
                    )
            memory = PersonModels(store, strategies)
            for strategy in off:
                memory.feedback.switch("user1", strategy, False, strategies)
            (record,) = read_records(store, memory, [Person("user1", "Rosa")])
            return record

    return note


def test_a_single_enabled_strategy_is_not_called_best(
    noted: Callable[..., PersonSummary],
) -> None:
    record = noted({"suggestion": (0, 1)}, ("neutral", "praise", "scarcity"))
    assert sentence(record).startswith("only suggestion is switched on for Rosa: 0 of 1, last seen")
    assert record.settled is record.leading is None


def test_the_only_strategy_of_an_activity_is_never_settled(
    noted: Callable[..., PersonSummary],
) -> None:
    record = noted({"quiet": (8, 1)}, strategies=("quiet",))
    assert sentence(record).startswith(
        "Tangy has only one way of asking Rosa: it worked 8 of 9 times, last seen"
    )
    assert record.settled is None


@pytest.mark.parametrize(
    ("counts", "said"),
    [
        ({"praise": (0, 1)}, "nothing has worked with Rosa yet: 0 of 1"),
        (dict.fromkeys(NAMES[1:], (0, 40)) | {"neutral": (0, 1)}, "nothing has worked"),
        (dict.fromkeys(NAMES[1:], (1, 60)) | {"neutral": (0, 1)}, "not clear yet what works"),
        ({"praise": (9, 1), "neutral": (0, 4), "suggestion": (0, 4), "scarcity": (0, 4)},
         "praise works with Rosa: 9 of 10"),
    ],
)  # fmt: skip
def test_an_unsuccessful_strategy_is_not_said_to_work(
    counts: Counts, said: str, noted: Callable[..., PersonSummary]
) -> None:
    record = noted(counts)
    assert sentence(record).startswith(said)
    assert (record.settled is not None) == ("praise works" in said)


@given(
    st.lists(st.tuples(st.integers(0, 12), st.integers(0, 12)), min_size=1, max_size=4),
    st.sets(st.sampled_from(NAMES)),
)
def test_a_strategy_works_only_after_compliance_and_with_a_choice(
    counts: list[tuple[int, int]], off: set[str]
) -> None:
    beliefs = {n: Beta(1 + yes, 1 + no) for n, (yes, no) in zip(NAMES, counts, strict=False)}
    known = PersonModel(Thompson(), beliefs, beliefs, frozenset(off & set(beliefs)))
    best, on = best_of_those_on(beliefs, known.off), on_of(beliefs, known.off)
    settled = settled_of(on, best)
    record = PersonSummary(Person("user1", "Rosa"), known, best, settled, (), (), None, NOW)
    words = sentence(record)
    if re.search(r"^\w+ (works|may work)", words):
        strategy = words.split()[0]
        assert beliefs[strategy].complied and strategy in on and len(on) > 1
    if not any(yes for yes, _ in counts):
        assert not re.search(r"\bworks?\b", words)
