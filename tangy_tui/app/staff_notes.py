"""The notes that staff get back for their commands in a game, and what Tangy proposes to them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

DoneKind = Literal[
    "paused",
    "goes on",
    "one step",
    "stopped",
    "takes over",
    "given back",
    "autonomy",
    "call again",
    "call taken back",
    "pace",
    "time planned",
    "claim kept",
    "claim right",
    "claim late",
    "claim wrong",
    "claim with others",
    "claims told",
    "card given",
    "patterns",
    "several",
    "one winner",
    "visits",
    "no visits",
    "comes",
    "joins",
    "goes",
    "asked for",
    "asked to help",
    "asked already",
    "told",
    "told right",
    "told wrong",
    "told unclear",
    "voided",
    "driven",
    "ended",
    "reached",
]
"""What became of a command that was carried out."""

RefusalKind = Literal[
    "calls again soon",
    "here before",
    "away before",
    "is away",
    "last one",
    "not playing",
    "seen before",
    "stopped first",
    "asks first",
    "halted first",
    "still halted",
    "ends",
    "no game",
    "not in a simulation",
    "joining",
    "no robot",
    "nothing called",
    "not told",
    "not asked",
    "whose",
    "nothing to tell",
    "no cards",
    "no such card",
    "whose card",
    "which card",
    "not called",
    "nothing to void",
    "not halted",
    "nobody named",
    "not seen yet",
    "nothing asked",
    "no name",
    "nobody joins",
    "teams play",
    "known already",
    "which person",
    "most people",
    "no seat",
    "no seat there",
    "not at front",
    "not acceptable",
    "cannot",
]
"""Why a command was refused."""
REFUSALS: frozenset[RefusalKind] = frozenset(get_args(RefusalKind))

NoteKind = Literal[DoneKind, RefusalKind]
"""The reply to a command."""


@dataclass(frozen=True, slots=True)
class StaffNote:
    """The result of a command that is not an event of the game; `about` names its subject."""

    kind: NoteKind
    about: str = ""
    words: str = ""
    """Words of the activity that the note quotes."""
    people: tuple[str, ...] = ()
    """The ids of people it names."""
    before: str = ""
    """The number of another card that a person had until now."""


@dataclass(frozen=True, slots=True)
class Proposal:
    """Tangy's next action, its target and its share of the votes, for staff to approve."""

    behaviour: str
    target: str | None
    share: float
    seen: int = 0
    """How often it was demonstrated in this situation."""
