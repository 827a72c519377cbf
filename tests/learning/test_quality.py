"""Notes on demonstrations: short, and only if there is something to note."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.codec import encode
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import (
    DemonstrationBegun,
    DemonstrationStep,
    DemonstrationStepUndone,
    Merger,
)
from tangy_tui.learning.demonstration_rows import heard_words, list_rows
from tangy_tui.learning.editing import Editor
from tangy_tui.learning.library import read_library
from tangy_tui.learning.library_entries import Library
from tangy_tui.learning.quality import quality_notes
from tangy_tui.text.quality import quality_words
from tests.shown import answering, log_demonstration
from tests.support.append_body import append_body

Demonstrate = Callable[[str, int, int], Demonstration]
WRONG = "incorrectly marked"


@pytest.fixture
def good(demonstrate: Demonstrate) -> list[Demonstration]:
    """Four games with the same correct steps."""
    games = (demonstrate("bingo", seed, 4) for seed in range(40))
    wanted = [g for g in games if any(s.state.situation.user_state == WRONG for s in g.steps)]
    return wanted[:4]


def library_of(store: Store, *shown: Demonstration) -> Library:
    for one in shown:
        log_demonstration(store, one)
    return read_library(store, "bingo")


def notes(activity: Activity, library: Library, number: int) -> list[str]:
    return quality_words(quality_notes(activity, library.find(str(number)), library))


def test_a_good_demonstration_gets_no_note(
    activity: Activity, store: Store, good: list[Demonstration]
) -> None:
    assert notes(activity, library_of(store, *good), 1) == []


def test_an_unfinished_demonstration_is_noted(
    activity: Activity, store: Store, good: list[Demonstration]
) -> None:
    begun = replace(good[0], steps=good[0].steps[:5], finished=False)
    assert notes(activity, library_of(store, begun), 1) == ["not finished"]


def test_undone_steps_are_counted(
    activity: Activity, store: Store, good: list[Demonstration]
) -> None:
    log_demonstration(store, replace(good[0], steps=good[0].steps[:3], finished=False))
    for _ in range(2):
        append_body(store, DemonstrationStepUndone, {"demonstration": good[0].id, "step": 3})
    library = read_library(store, "bingo")
    assert notes(activity, library, 1) == ["not finished", "2 steps taken back"]


def test_failed_steps_are_counted(
    activity: Activity, store: Store, good: list[Demonstration]
) -> None:
    failed = (replace(good[0].steps[1], completed=False), *good[0].steps[2:])
    shown = replace(good[0], steps=(good[0].steps[0], *failed))
    assert notes(activity, library_of(store, shown), 1) == ["1 step that could not be carried out"]


def test_a_game_that_never_came_to_its_end_is_noted(
    activity: Activity, store: Store, good: list[Demonstration]
) -> None:
    short = replace(good[0], steps=good[0].steps[:4])
    assert notes(activity, library_of(store, short), 1) == ["ended before “celebrate the win”"]


def test_a_conflict_names_the_other_demonstration_until_it_is_resolved(
    activity: Activity, store: Store, good: list[Demonstration]
) -> None:
    library = library_of(store, good[0], answering(good[1], WRONG, "encourage"))
    assert notes(activity, library, 1) == ["disagrees with demonstration 2 in 1 situation"]
    assert notes(activity, library, 2) == ["disagrees with demonstration 1 in 1 situation"]
    Editor(store, activity).resolve(library.conflicts[0], "remove markers")
    library = read_library(store, "bingo")
    assert notes(activity, library, 1) == []
    wrong = sum(s.state.situation.user_state == WRONG for s in good[1].steps)
    plural = "" if wrong == 1 else "s"
    assert notes(activity, library, 2) == [f"{wrong} step{plural} called wrong by a teacher"]


def test_a_demonstration_with_two_answers_contradicts_itself(
    activity: Activity, store: Store, good: list[Demonstration]
) -> None:
    calls = [n for n, s in enumerate(good[0].steps) if s.behaviour == "call number"]
    steps = list(good[0].steps)
    steps[calls[0]] = replace(steps[calls[0]], behaviour="joke")
    library = library_of(store, replace(good[0], steps=tuple(steps)))
    assert notes(activity, library, 1) == ["contradicts itself in 1 situation"]


def test_an_unfinished_demonstration_is_compared_too(
    activity: Activity, store: Store, good: list[Demonstration]
) -> None:
    other = replace(answering(good[1], WRONG, "encourage"), finished=False)
    library = library_of(store, good[0], other)
    assert "disagrees with demonstration 1 in 1 situation" in notes(activity, library, 2)
    assert notes(activity, library, 1) == []


@pytest.mark.slow
def test_an_unusually_long_demonstration_is_noted(
    activity: Activity, store: Store, good: list[Demonstration]
) -> None:
    first, *others = good
    calls = [s for s in first.steps if s.behaviour == "call number"] * 30
    long = replace(first, steps=(first.steps[0], *calls, *first.steps[1:]))
    said = notes(activity, library_of(store, long, *others), 1)
    assert len(said) == 1 and said[0].startswith("much longer than usual")


def test_the_origin_of_a_demonstration_is_noted(
    activity: Activity, store: Store, good: list[Demonstration]
) -> None:
    library_of(store, *good[:3])
    editor = Editor(store, activity)
    editor.merge("1", "2")
    editor.split("3", 4)
    log_demonstration(store, replace(good[3], id="asked", steps=good[3].steps[:1], origin="asked"))
    library = read_library(store, "bingo")
    said = [(*quality_words(row.notes),) for row in list_rows(activity, library)]
    assert "merged from demonstrations 1 and 2" in said[3]
    assert "a part of demonstration 3" in said[4]
    assert said[6] == ("answered in a game",)


def test_a_new_version_names_its_first_new_step(
    activity: Activity, store: Store, good: list[Demonstration]
) -> None:
    log_demonstration(store, good[0])
    append_body(
        store,
        DemonstrationBegun,
        {
            "demonstration": "again",
            "activity": "bingo",
            "teacher": "Ada",
            "seed": good[0].seed,
            "people": list(good[0].people),
            "origin": "again",
            "of": [good[0].id],
            "kept": 6,
        },
    )
    append_body(store, DemonstrationStep, {"demonstration": "again", **encode(good[0].steps[6])})
    said = notes(activity, read_library(store, "bingo"), 2)
    assert "shown again from step 7 of demonstration 1" in said


def test_the_number_of_a_demonstration_never_changes(
    activity: Activity, store: Store, good: list[Demonstration]
) -> None:
    library_of(store, *good[:2])
    merged = Editor(store, activity).merge("1", "2").done
    assert isinstance(merged, Merger)
    (made,) = merged.made
    assert read_library(store, "bingo").number(made) == 3
    library = library_of(store, good[2])
    assert library.number(made) == 3
    assert library.number(good[2].id) == 4


def test_rows_list_every_demonstration(
    activity: Activity, store: Store, good: list[Demonstration]
) -> None:
    library_of(store, *good[:2])
    Editor(store, activity).delete("2")
    rows = list_rows(activity, read_library(store, "bingo"))
    assert [(row.number, row.state, row.in_use) for row in rows] == [
        (1, "in use", True),
        (2, "deleted", False),
    ]
    assert rows[0].steps == len(good[0].steps)
    assert rows[0].situations == len(activity.situations)
    assert 0 < rows[0].seen <= rows[0].situations
    document = json.loads(json.dumps(rows[0].to_json()))
    assert document["coverage"] == {"seen": rows[0].seen, "situations": rows[0].situations}


def test_heard_words_are_listed_by_step(store: Store, good: list[Demonstration]) -> None:
    log_demonstration(store, replace(good[0], steps=good[0].steps[:1], finished=False))
    second = encode(good[0].steps[1])
    append_body(
        store, DemonstrationStep, {"demonstration": good[0].id, **second, "heard": "next number"}
    )
    shown = read_library(store, "bingo").find("1").demonstration
    assert heard_words(store, shown) == {2: "next number"}
