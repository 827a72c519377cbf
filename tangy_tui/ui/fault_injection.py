"""Faults that staff inject into a simulated world, or lift again."""

from __future__ import annotations

from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_sim.worlds.injection import KINDS
from tangy_tui.app.fault_commands import possible_kinds
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.monitoring.supervision import Supervision
from tangy_tui.text import injections
from tangy_tui.ui.dialogs.inject import InjectDialog, comes_later


class FaultInjection:
    """Injects the faults that staff choose in a dialog, and logs each of them."""

    def __init__(self, supervision: Supervision, by: str) -> None:
        """Inject faults into the games of a supervision; `by` is who does it, for the log."""
        self._supervision, self._by = supervision, by
        self._asked_for: dict[str, int] = {}
        self._game = 0

    def refuses(self) -> str:
        """Return why no fault can be injected now, "" if one can."""
        if self._faulty is None:
            return injections.NOT_SIMULATED
        return injections.NO_GAME if self._supervision.over else ""

    def dialog(self) -> InjectDialog:
        """Make the dialog in which staff choose a fault to inject or to lift."""
        book = self._supervision.book
        possible = possible_kinds(rule.code for rule in book.rules)
        called = {name: book.rule(KINDS[name].code).name for name in possible}
        world = self._faulty
        return InjectDialog(() if world is None else world.present, self._to_come(), called)

    @property
    def _faulty(self) -> FaultyWorld | BenchedWorld | None:
        """The world, if faults can be injected into it."""
        world = self._supervision.world
        return world if isinstance(world, FaultyWorld | BenchedWorld) else None

    def _to_come(self) -> list[str]:
        """Return the kinds of fault that were injected in this game and cannot be seen yet."""
        world = self._faulty
        if self._game != self._supervision.games:
            self._game = self._supervision.games
            self._asked_for.clear()
        if world is None:
            return []
        return [
            kind
            for kind, came in self._asked_for.items()
            if kind not in world.present and all(kind != late for _, late in world.came[came:])
        ]

    def inject(self, kind: str | None) -> tuple[str, bool]:
        """Inject a fault, or lift it if it is there or to come.

        Returns:
            The result in words ("": nothing was done), and whether it is visible at once.
        """
        world = self._faulty
        if world is None or kind is None or self.refuses():
            return "", False
        if kind in world.present or kind in self._to_come():
            there = kind in world.present
            world.lift(kind)
            self._supervision.note("fault lifted", self._by, detail=kind)
            self._asked_for.pop(kind, None)
            return injections.lifted_words(kind), there
        self._asked_for[kind] = len(world.came)
        self._supervision.note("fault injected", self._by, detail=kind)
        world.inject(kind)
        if comes_later(kind):
            return injections.comes_later_words(kind), False
        return injections.injected_words(kind), True
