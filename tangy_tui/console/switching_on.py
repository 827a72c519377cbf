"""Lines that staff type while the robot is switched on: a STOP is heard, and holds."""

from __future__ import annotations

from collections.abc import Callable
from queue import Empty

from tangy_profiles.errors import TangyError
from tangy_tui.app.game_commands import EndGame, GameCommand, GoOn, Pause, StopRobot
from tangy_tui.app.game_controller import ControllerOutput, GameController
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.console.inputs import ReadAhead, any_waits
from tangy_tui.text.control import noted_words
from tangy_tui.text.live_games import ON_FIRST, STOPPED_BEFORE, WAITS_UNTIL_ON
from tangy_tui.text.situations import Name


class SwitchingOnLines:
    """Takes the lines that come while the robot is switched on; call `take` again and again."""

    def __init__(
        self,
        ahead: ReadAhead,
        command: Callable[[str], GameCommand | None],
        name: Name,
        write: Callable[[str], None],
    ) -> None:
        """Take lines.

        Args:
            ahead: the lines that are being read.
            command: parses a line as a command of games.
            name: returns a person's name for an id.
            write: writes a line.
        """
        self._ahead, self._command, self._name, self._write = ahead, command, name, write
        self.stopped = self.leaves = False
        """Whether staff stopped the robot, or left, before the first game."""

    def take(self, before: GameController | None) -> None:
        """Take one line, if one has come. Lines that need the game wait for it.

        Args:
            before: the controller of a game that is interrupted, and is to go on with somebody
                who has joined; None: no game has begun.
        """
        try:
            line = self._ahead.lines.get_nowait()
        except Empty:
            return
        if line is None:
            self._ahead.lines.put(None)
            return
        try:
            command = None if any_waits(self._ahead.early) else self._command(line)
        except TangyError:  # the game will tell what is wrong with it
            command = None
        match command:
            case StopRobot():
                self.stopped = True
                self._write(STOPPED_BEFORE)
                self._apply(before, command)
            case Pause() if before is not None and not before.stopped:
                self._apply(before, command)
            case GoOn() if self.stopped:
                self._write(ON_FIRST)
            case EndGame() if before is None:
                self.leaves = True
            case _ if line.strip():
                self._ahead.early.append(line.strip())
                self._write(WAITS_UNTIL_ON)

    def _apply(self, control: GameController | None, command: GameCommand) -> None:
        told: list[ControllerOutput] = [] if control is None else [*control.apply(command)]
        for note in told:
            if isinstance(note, StaffNote) and note.kind != "stopped":
                self._write(noted_words(note, self._name))
