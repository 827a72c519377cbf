"""Log entries about faults and calls, for screens that show games."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from textual.screen import Screen

from tangy_profiles.game_records import CallMade, CallStage
from tangy_tui.monitoring.fault import ENDINGS, Diagnosed, FaultEvent, Moved
from tangy_tui.text.calls import logged_words
from tangy_tui.text.faults import kind_words, move_words
from tangy_tui.ui.widgets.log_view import Kind, LogView
from tangy_tui.ui.widgets.room_view import RoomView

CALLS: Mapping[CallStage, Kind] = {"answered": "good", "reached": "good", "failed": "bad"}


def write_call(screen: Screen[Any], made: CallMade) -> None:
    """Write the outcome of a call to the log."""
    words = logged_words(made.role, made.way, made.stage, made.said)
    screen.query_one(LogView).write(words, CALLS.get(made.stage, "warn"))


def write_fault(screen: Screen[Any], event: FaultEvent) -> None:
    """Write a fault or a recovery event to the log, with Tangy's speech."""
    fault, log = event.fault, screen.query_one(LogView)
    if isinstance(event, Moved) and event.move.speech:
        screen.query_one(RoomView).say(event.move.speech)
    if fault.asks_only:
        return  # Tangy's question tells all of it
    kind: Kind = "bad" if fault.critical else "warn"
    if isinstance(event, Diagnosed):
        log.write(f"Fault, {kind_words(fault)}: {fault.name}. {fault.console}", kind)
        return
    move = event.move
    if move.kind in ENDINGS:
        kind = "good"
    elif move.kind not in ("halted", "still there", "escalated", "given up"):
        kind = "dim"
    log.write(f"{fault.name}: {move_words(move)}.", kind)
    if move.speech:
        log.write(move.speech)
