"""The report of Scenario 3: faults by game, times to recover, faults by kind."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from tangy_tui.experiments import figures
from tangy_tui.pages.page import figure, heading, paragraph, table
from tangy_tui.text import experiments as words
from tangy_tui.text.comparison import RECOVERIES, TO_ITS_END
from tangy_tui.text.numbers import number, percent

Document = Mapping[str, Any]

MOST_DRAWN = 20
"""Games that are drawn individually."""

WHO = {"expert": "expert", "continue": "goes on", "user": "user", "teacher": "teacher"}
"""Short names of the recoveries, for figures."""


def recovery(document: Document) -> Iterator[str]:
    """Yield the parts of the page."""
    games = document["each_game"]
    drawn = games[:MOST_DRAWN]
    yield heading(words.BY_GAME)
    yield figure(
        figures.faults_by_game(drawn, WHO),
        words.by_game_caption(len(drawn), len(games)),
    )
    yield table(
        ("", "induced", "instances", "recovered", "again", "missed", "escalated",
         "median s", "95% within s"),
        [
            (
                RECOVERIES[row["recovery"]],
                row["induced"],
                row["instances"],
                percent(row["success"]),
                row["again"],
                row["missed"],
                row["escalated"],
                number(row["seconds_to_recover"]["median"], 0),
                number(row["seconds_to_recover"]["p95"], 0),
            )
            for row in document["faults"]
        ],
    )  # fmt: skip
    yield paragraph(words.instances_words(document["false_alarms"]))
    yield from _others(document)
    yield heading(words.TIMES)
    yield figure(
        figures.times_to_recover(games, WHO),
        words.TIMES_CAPTION,
    )
    yield heading(words.BY_KIND)
    yield table(
        ("kind", "what happened", "recovery", "induced", "noticed at once", "right class",
         "right cause"),
        [
            (
                row["kind"], row["words"], WHO[row["recovery"]], row["induced"], row["at_once"],
                row["right_class"], row["right_cause"],
            )
            for row in document["kinds"]
        ],
    )  # fmt: skip
    yield paragraph(words.limits_words(document))
    yield from _behaviours(document)


def _others(document: Document) -> Iterator[str]:
    """Yield the faults that did not occur, and the games that were stopped."""
    if left := document["did_not_come_about"]:
        yield paragraph(words.left_words(left))
    for reason, count in document["ended"].items():
        if reason != TO_ITS_END:
            yield paragraph(words.stopped_words(reason, count))


def _behaviours(document: Document) -> Iterator[str]:
    paper = document["paper"]
    scale = document["games"] / paper["games"]
    here = {
        (row["stage"], row["request"], row["user_state"]): row for row in document["rows"]
    }  # fmt: skip
    yield heading("Behaviours")
    rows = []
    for there in paper["rows"]:
        key = tuple(there[name].lower() for name in ("stage", "user_state"))
        mine = [
            row for (stage, request, state), row in here.items()
            if (stage, state) == key and request == there["request"]
        ]  # fmt: skip
        rows.append(
            (
                there["behaviour"],
                there["instances"],
                number(there["instances"] * scale, 0),
                sum(row["instances"] for row in mine),
                ", ".join(percent(row["success"]) for row in mine),
            )
        )
    yield table(
        ("the paper's behaviour", f"in its {paper['games']} games", "in as many games as here",
         "here", "carried out, and right"),
        rows,
    )  # fmt: skip
    yield paragraph(words.behaviours_words(document))
