"""Records of what staff, or the program beside its behaviours, did in a game."""

from __future__ import annotations

from typing import Any, Literal

from tangy_profiles.codec import Count, Sparse
from tangy_profiles.records import EventRecord, kind

StaffActionKind = Literal[
    "paused",
    "went on",
    "stopped",
    "let go on",
    "took over",
    "gave back",
    "answered",
    "ended",
    "autonomy",
    "drove",
    "called again",
    "asked for",
    "told",
    "heard",
    "pace",
    "time planned",
    "took back",
    "claim made",
    "claim right",
    "claim late",
    "claim wrong",
    "patterns",
    "rules",
    "came",
    "left",
    "response voided",
    "card given",
    "cards dealt",
    "card learnt",
    "card doubted",
    "robot frozen",
    "program frozen",
    "fault injected",
    "fault lifted",
    "faults planned",
    "noted",
]
"""What staff, or the program beside its behaviours, did in a game."""


CLAIM_CHECKS: tuple[StaffActionKind, ...] = ("claim right", "claim late", "claim wrong")
"""The results of a claim that was checked."""


BEGINNINGS: dict[str, StaffActionKind] = {
    "a fault was brought about: ": "fault injected",
    "a fault was lifted: ": "fault lifted",
    "faults are to be brought about: ": "faults planned",
}
"""How sentences of the first version began that reports have to know; others are notes."""


def _staff_action(version: int, body: dict[str, Any]) -> dict[str, Any]:
    """Convert the sentence of the first version: an injected fault, or else a note."""
    kept = {key: value for key, value in body.items() if key != "what"}
    what = body.get("what")
    for beginning, did in BEGINNINGS.items():
        if isinstance(what, str) and what.startswith(beginning):
            return {**kept, "did": did, "detail": what.removeprefix(beginning)}
    return {**kept, "did": "noted", "detail": what}


@kind("staff action", version=2, older=_staff_action)
class StaffAction(EventRecord):
    """An action of staff other than behaviours and recoveries: a stop, an injected fault.

    `person` is whom it concerns. `detail` depends on `did`: the pace in s, until when the session
    is planned (ISO 8601; "": without a limit), a card's number, the
    label of a call, the names of patterns or rules, the kinds of faults, the level of autonomy, the
    words that a person said, the seconds of a freeze, the behaviour that staff chose
    after they took over, or a note in words. `seconds` is the time in
    the game, `taken_back` the number of a call that no longer counts, and `seat` (from 1) the seat
    of a new person who came. `calls` is how many numbers Tangy had called when a claim was made or
    checked, with the one it was just saying; 0: none, or an older log.
    """

    game: str
    did: StaffActionKind
    by: str
    person: Sparse[str] = ""
    detail: Sparse[str] = ""
    seconds: float | None = None
    taken_back: Sparse[Count] = 0
    seat: Sparse[Count] = 0
    calls: Sparse[Count] = 0
