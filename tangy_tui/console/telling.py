"""Writes the events of games, and the results of staff's commands, line by line."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from tangy_tui.app.claim_controls import ClaimNow
from tangy_tui.app.game_commands import ClaimCard, GameCommand
from tangy_tui.app.game_controller import ControllerOutput, GameController
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.console.in_progress import ProgressLines
from tangy_tui.interaction.game_events import (
    Acted,
    DoneOnce,
    GameChanged,
    GameEnded,
    ResumedGame,
    Taught,
)
from tangy_tui.learning.verification import NotUnderstood, Verification
from tangy_tui.monitoring.supervision import Event
from tangy_tui.text import staff_lines
from tangy_tui.text.control import claimed_words, noted_words, waits_words
from tangy_tui.text.games import game_lines
from tangy_tui.text.messages import timed_message
from tangy_tui.text.situations import Name
from tangy_tui.text.times import local_now

MOST_TOLD = 20
"""The lines that are told again, if staff ask for the last messages."""
SOON_SECONDS = 0.7
"""For a command, before staff are told that it has to wait."""


class GameTelling:
    """Writes what happens in the games of a controller. Any thread may call it."""

    def __init__(
        self,
        controller: GameController,
        name: Name,
        write: Callable[[str], None],
        progress: ProgressLines,
        also: Callable[[Sequence[Event]], Sequence[str]],
    ) -> None:
        """Write with `write`; see `StaffLines`. `progress` knows what was told before its step."""
        self._controller, self._name = controller, name
        self._progress, self._also = progress, also
        self._writing = threading.Lock()
        self._last: deque[str] = deque(maxlen=MOST_TOLD)
        self._write_line = write
        self.verify: Callable[[Verification], object] = lambda said: None
        """Asks staff about what they said that Tangy should do."""
        self.stopped = False
        """Whether a game stopped early."""
        self.ended = False
        """Whether staff ended a game."""

    def last(self) -> list[str]:
        """Return what was told last about the game, each with the time of day."""
        return list(self._last)

    def tell_lines(self, lines: Iterable[str]) -> None:
        """Write lines about the game, and keep them, to be told again."""
        for line in lines:
            self._last.append(timed_message(local_now(), line.strip()))
            self.write(line)

    def tell(self, told: Sequence[ControllerOutput]) -> None:
        """Write the lines about some events and results."""
        answered = next((e.teacher for e in told if isinstance(e, Taught | DoneOnce)), "")
        game = self._controller.supervision
        events: list[Event] = []
        taken_back = any(isinstance(e, StaffNote) and e.kind == "call taken back" for e in told)
        for one in told:
            if isinstance(one, StaffNote):
                self.tell_lines([noted_words(one, self._name)])
            elif isinstance(one, Verification):
                self.verify(one)
                if isinstance(one, NotUnderstood):
                    self.write(staff_lines.ANSWER_IN_WORDS)
            else:
                events.append(one)
                broken_off = isinstance(one, GameEnded) and one.stopped is not None
                self.stopped |= broken_off and not self.ended
                on = self._controller.goes_on
                lines = game_lines(
                    one, game, self._name, answered,
                    goes_on=on, stopped=self._controller.stopped, ends=self._controller.ending,
                    played=self._controller.view().seconds,
                )  # fmt: skip
                if isinstance(one, GameChanged) and one.what == "taken back" and taken_back:
                    lines = lines[1:]  # staff were told so
                elif isinstance(one, Acted):
                    lines = self._progress.step(one, lines)
                elif isinstance(one, ResumedGame):
                    lines = [*lines, *self._progress.resumed()]
                self.tell_lines(lines)
        self.tell_lines(filter(None, self._also(events)))

    def queue(self, command: GameCommand) -> Callable[[], Sequence[ControllerOutput]]:
        """Answer a command that has to wait for its turn; return what carries it out then.

        The result of a claim is told at once: the robot needs a while to tell the group. Of other
        commands, staff are told if they wait for long, also behind earlier ones.
        """
        controller = self._controller
        judged = self._judged(command) if controller.robot.there else None
        if judged is not None:
            self.tell_lines([claimed_words(judged, self._name, controller.plan.calling)])
        begun, done = threading.Event(), threading.Event()

        def tell_that_it_waits() -> None:
            if not done.is_set() and (controller.stepping or not begun.is_set()):
                self.write(waits_words(command, self._name))

        soon = threading.Timer(SOON_SECONDS, tell_that_it_waits)
        soon.daemon = True
        if judged is None and controller.robot.there:
            soon.start()

        def in_turn() -> Sequence[ControllerOutput]:
            begun.set()
            try:
                return _not_told(controller.apply(command), judged)
            finally:
                done.set()
                soon.cancel()

        return in_turn

    def _judged(self, command: GameCommand) -> ClaimNow | None:
        """Return a claim with its result by the numbers called so far, None if it is none."""
        plan = self._controller.plan
        claimed = plan.judged(command) if isinstance(command, ClaimCard) else None
        if claimed is None:
            return None
        if claimed.kind is not None and not self._controller.stepping:
            claimed = replace(claimed, told=0.0)  # nothing comes before it
        return claimed

    def write(self, line: str) -> None:
        """Write a line."""
        with self._writing:
            self._write_line(line)

    def write_all(self, lines: Iterable[str]) -> None:
        """Write lines."""
        for line in lines:
            self.write(line)


def _not_told(
    results: Iterable[ControllerOutput], judged: ClaimNow | None
) -> Sequence[ControllerOutput]:
    """Leave out of the results of a claim what staff were told when they made it."""
    told = list[ControllerOutput]()
    for one in results:
        if judged is None or not isinstance(one, StaffNote) or one.kind != judged.kind:
            told.append(one)
        elif one.words:
            told.append(StaffNote("claims told", words=one.words))
        elif not judged.later:
            told.append(one)
    return told
