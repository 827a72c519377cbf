"""The claims that a card wins, in a game: who made each, at which call, and what came of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from tangy_profiles.staff_records import CLAIM_CHECKS, StaffActionKind
from tangy_tui.monitoring.replay import GameReplay, Noted


@dataclass(frozen=True, slots=True)
class Claim:
    """A claim that staff made, and its check; older logs have only the check.

    `calls` are how many numbers had been called by then; 0: not known, or none.
    """

    by: str
    card: str
    person: str
    at: str
    """When it was made (ISO 8601, UTC)."""
    calls: int = 0
    checked_at: str = ""
    """When Tangy checked it; "" if it did not."""
    checked_calls: int = 0
    result: StaffActionKind | None = None

    def to_json(self) -> dict[str, Any]:
        """Return the claim as `--json` prints it."""
        return {
            "at": self.at,
            "by": self.by,
            "person": self.person,
            "card": int(self.card) if self.card.isdecimal() else None,
            "calls": self.calls or None,
            "checked_at": self.checked_at or None,
            "checked_calls": self.checked_calls or None,
            "result": self.result,
        }


def claims_in(replay: GameReplay) -> list[Claim]:
    """Return the claims of a game in the order in which they were made.

    A card that was claimed again before Tangy checked it counts once.
    """
    claims, waiting = list[Claim](), dict[str, int]()
    for moment in replay.moments:
        note = moment.what
        if not isinstance(note, Noted) or note.did not in ("claim made", *CLAIM_CHECKS):
            continue
        if note.detail not in waiting:
            waiting[note.detail] = len(claims)
            claims.append(Claim(note.by, note.detail, note.person, moment.at, note.calls))
        made = claims[at := waiting[note.detail]]
        made = replace(made, person=note.person or made.person)
        if note.did in CLAIM_CHECKS:
            del waiting[note.detail]
            made = replace(made, checked_at=moment.at, checked_calls=note.calls, result=note.did)
        claims[at] = made
    return claims
