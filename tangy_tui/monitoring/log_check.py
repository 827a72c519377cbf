"""What is wrong with a log: its file, its rows, and what makes no sense where it stands."""

from __future__ import annotations

from tangy_profiles.events import KINDS
from tangy_profiles.game_records import GameBeginning
from tangy_profiles.reading import plain
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import DemonstrationBegun, DemonstrationsEdited, PolicyLearnt
from tangy_tui.learning import library


def log_problems(store: Store) -> list[str]:
    """Read a whole log and return what is wrong with it, a sentence each ([]: nothing)."""
    wrong = store.check()
    known = set(store.aside)
    for activity in _activities(store):
        library.read_library(store, activity)
    out_of_place = sorted(store.aside.keys() - known)
    return wrong + [store.aside[seq] for seq in out_of_place] + unknown_kinds(store)


def unknown_kinds(store: Store) -> list[str]:
    """Say which kinds of event in a log this Tangy does not know, a sentence each."""
    return [
        plain(f"tangy.db: events of the kind {kind[:60]!r} are not known and left out.")
        for kind in store.kinds()
        if kind not in KINDS
    ]


def _activities(store: Store) -> list[str]:
    """Return the activities that a log tells of."""
    events = store.events(DemonstrationBegun, DemonstrationsEdited, GameBeginning, PolicyLearnt)
    return sorted({getattr(event.record, "activity", "") for event in events} - {""})
