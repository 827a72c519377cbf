"""Words of a session's report beside its drawings and tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_tui.text.faults import RECOVERY_WORDS

if TYPE_CHECKING:
    from tangy_tui.monitoring.fault import Fault

VISIT = "Tangy is with them"
STOOD_STILL = "Tangy stood still"
WHO = "Who took part"
ENDED = "How it ended"
ALL_ENDED = "How they ended"
CARE = "What to look after"
NOTHING_LEFT = "Nothing is left to do: every fault is over."
WHEN = "What happened when"
RESPONDED = "How people responded"
NOBODY_ASKED = "Nobody was asked for anything."
BELIEFS = (
    "Drawn is how likely each person is to comply with each strategy that was used: before "
    "the session (ring) and after it (dot), with its 90% interval."
)
FAULTS = "Faults, and what was done about them"
NO_FAULTS = "There were no faults."
UNSURE = "Where Tangy did not know what to do"
BEHAVIOURS = "What Tangy did where"
SUMS = "Faults by criticality and recovery"


def drawn_words(drawn: int, games: int) -> str:
    """Tell how many of the games are drawn."""
    if drawn == 1:
        return f"The last of {games} games is drawn."
    return f"The last {drawn} of {games} games are drawn."


def game_caption(number: int, *, timed: bool) -> str:
    """Caption the timeline of a game."""
    return f"Game {number}, {'by minutes in the game' if timed else 'step by step'}."


def fault_facts(fault: Fault, game: int | None) -> str:
    """Tell when a fault was noticed, and its first recovery; the game, if there are several."""
    where = "Step" if game is None else f"Game {game}, step"
    facts = f"{where} {fault.step}; first recovery: {RECOVERY_WORDS[fault.recovery]}."
    return f"{facts} Noticed after: {fault.behaviour}." if fault.behaviour else facts
