"""The report's part on Scenario 3: faults game by game, how long they took, kind by kind."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from tangy_tui.experiments import figures
from tangy_tui.experiments.comparison import RECOVERIES, TO_ITS_END
from tangy_tui.pages.page import figure, heading, paragraph, table
from tangy_tui.text.numbers import counted, number, percent

Document = Mapping[str, Any]

MOST_DRAWN = 20
"""Games that are drawn one by one."""

WHO = {"expert": "expert", "continue": "goes on", "user": "user", "teacher": "teacher"}
"""The recoveries in a word, for figures."""

SIMULATED = (
    "What devices report when something is wrong is simulated, so that a right cause proves the "
    "rules, and no sensor. "
)
BENCHED = (
    "The devices are those of a bench: cards, faces and signs are rendered, scans are computed, "
    "and all of it goes through the drivers and the perception of a real robot. "
)
LIMITS = (
    "Simulated people at the table help with a probability of "
    "{help:g}, experts always mend what was diagnosed, and a scripted teacher answers at once and "
    "rightly: how long a real one takes is not in these times. One fault is induced at a time; "
    "none comes with the behaviour that ends a game, or while a teacher is asked. It takes three "
    "requests to tell that somebody never complies, so that is not noticed at once; and it "
    "may be diagnosed again in each visit: each is an instance, as in the paper's count of "
    "recoveries, and no false alarm."
)


def recovery(document: Document) -> Iterator[str]:
    """Yield the parts of the page."""
    games = document["each_game"]
    drawn = games[:MOST_DRAWN]
    yield heading("Faults, game by game")
    words = f"the first {len(drawn)} of " if len(drawn) < len(games) else ""
    yield figure(
        figures.faults_by_game(drawn, WHO),
        f"A line for each game ({words}{counted(len(games), 'game')}), as long as it had "
        "behaviours; a mark where a fault was diagnosed, by the recovery that was chosen first.",
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
    yield paragraph(
        "An instance is a diagnosis of something that was induced; it is recovered from if the "
        "right class of recovery was chosen for it, and it was over in the end, or borne where "
        f"that was planned. There were {counted(document['false_alarms'], 'false alarm')}: "
        "diagnoses of something that was not induced."
    )
    yield from _others(document)
    yield heading("Time to recover")
    yield figure(
        figures.times_to_recover(games, WHO),
        "A mark for each fault; the axis is even up to 1 s, and logarithmic from there on.",
    )
    yield heading("Kind by kind")
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
    where = SIMULATED if document["simulated"] else BENCHED
    yield paragraph(where + LIMITS.format(help=document["settings"]["P(people at the table help)"]))
    yield from _behaviours(document)


def _others(document: Document) -> Iterator[str]:
    """Say what did not come about, and of games that were stopped."""
    if left := document["did_not_come_about"]:
        yield paragraph(
            f"Planned, but did not come about before its games ended: {', '.join(left)}."
        )
    for reason, count in document["ended"].items():
        if reason != TO_ITS_END:
            yield paragraph(f"Stopped before the end, {counted(count, 'game')}: {reason}")


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
    yield paragraph(
        f"{number(document['behaviours_per_game'])} behaviours and "
        f"{number(document['interactions_per_user_game'])} interactions of each user in a game. "
        "What was not carried out is what a fault prevented; it was done again afterwards."
    )
