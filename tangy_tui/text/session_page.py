"""Words of a session's report beside its drawings and tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tangy_tui.monitoring.fault import OVER
from tangy_tui.text.fault_moves import RECOVERY_WORDS
from tangy_tui.text.report import how_long_words

if TYPE_CHECKING:
    from tangy_tui.monitoring.fault import Fault
    from tangy_tui.monitoring.session import Session

VISIT = "Tangy is with them"
WAITS = "waits for help"
TICKS = "number called, anything else"
FAULT, CRITICAL_FAULT = "fault", "critical fault"
STOOD_STILL = "Tangy stood still"
FROM_TO, WHERE, HOW_LONG, FAULTS_HEAD = "When", "Games", "How long", "Faults"
WHO = "Who took part"
NOBODY_NAMED = "nobody is named in the log"
NO_TIMES = "not known: an older Tangy kept no times within a game"
ENDED = "How it ended"
ALL_ENDED = "How they ended"
CARE = "What to look after"
NOTHING_LEFT = "Nothing is left to do: every fault is over."
WHEN = "What happened when"
RESPONDED = "How people responded"
NOBODY_ASKED = "Tangy did not ask anybody to do anything."
BELIEFS = (
    "The drawings show how likely each person is to do what Tangy asks, for each way of asking "
    "that was used: before the session (ring) and after it (dot), with the 90% interval."
)
FAULTS = "Faults, and what was done about them"
TO_DRAW_MORE = ", to save paper. With --full, tangy report session --html draws up to 24"
NO_FAULTS = "There were no faults."
UNSURE = "Where Tangy did not know what to do"
UNSURE_COLUMNS = ("game", "step", "what came of it")
BEHAVIOURS = "What Tangy did where"
SUMS = "Faults by criticality and recovery"


def fault_sum(faults: Sequence[Fault]) -> str:
    """Tell how many faults there were, and how many were still there at the end."""
    if not faults:
        return "none"
    there = sum(fault.status != OVER for fault in faults)
    words = f"{len(faults)}, of which {sum(fault.critical for fault in faults)} critical"
    return f"{words}; {f'{there} still there at the end' if there else 'all over at the end'}"


def how_long(session: Session) -> str:
    """Tell how long the games lasted, and how long they were paused."""
    if not session.timed:
        return NO_TIMES
    return f"{how_long_words(session)}."


def drawn_words(drawn: int, games: int, *, full: bool) -> str:
    """Tell how many of the games are drawn."""
    if not drawn:
        return f"The {games} games are not drawn{'' if full else TO_DRAW_MORE}."
    last = (
        f"The last of {games} games is" if drawn == 1 else f"The last {drawn} of {games} games are"
    )
    return f"{last} drawn{'' if full else TO_DRAW_MORE}."


def game_caption(number: int, *, timed: bool) -> str:
    """Caption the timeline of a game."""
    return f"Game {number}, {'by minutes in the game' if timed else 'step by step'}."


def fault_facts(fault: Fault, game: int | None) -> str:
    """Tell when a fault was noticed, and its first recovery; the game, if there are several."""
    where = "Step" if game is None else f"Game {game}, step"
    facts = f"{where} {fault.step}; first recovery: {RECOVERY_WORDS[fault.recovery]}."
    return f"{facts} Noticed after: {fault.behaviour}." if fault.behaviour else facts
