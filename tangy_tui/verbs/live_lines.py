"""Live games with staff at the lines: when a person joins, the robot is switched on again."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from tangy_tui.text.interruptions import kept_words
from tangy_tui.verbs.common import print_line

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tangy_hw.robot_client.live_world import LiveWorld
    from tangy_profiles.past_game import PastGame
    from tangy_tui.app.game_controller import GameController
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.console.staff import StaffLines
    from tangy_tui.console.typed_lines import TypedLines
    from tangy_tui.learning.policy import Policy
    from tangy_tui.monitoring.supervision import Supervision


class LiveLines:
    """The live games of a session; `play` them, again after each person who `joined`."""

    def __init__(self, workspace: Workspace, games: int, by: str, typed: TypedLines | None) -> None:
        """Connect the terminal to the games of a workspace.

        Args:
            workspace: the workspace of the games.
            games: the number of games.
            by: who is on duty.
            typed: the lines of a terminal; None: standard input is none.
        """
        from tangy_tui.app.command_grammar import command_reader
        from tangy_tui.console.inputs import ReadAhead, line_reader
        from tangy_tui.console.switching_on import SwitchingOnLines

        self._workspace, self._by, self._typed = workspace, by, typed
        self._write = print_line if typed is None else typed.write
        self._left = games
        self._ahead = ReadAhead(line_reader(None) if typed is None else typed.read)
        if typed is not None:
            self._ahead.begin()
        command = command_reader(workspace.activity, lambda who: workspace.find_person(who).id)
        self.early = SwitchingOnLines(self._ahead, command, workspace.name, self._write)
        """The lines that come while the robot is switched on."""
        self._control: GameController | None = None
        self._lines: StaffLines | None = None
        self._world: LiveWorld | None = None

    def read(self) -> str | None:
        """Return the next line; None at the end."""
        return self._ahead.lines.get()

    @property
    def typed(self) -> bool:
        """Whether a person types the lines."""
        return self._typed is not None

    def write(self, line: str) -> None:
        """Write a line."""
        self._write(line)

    def meanwhile(self) -> None:
        """Take lines while the robot is switched on; those of a file wait for the first game."""
        if self._typed is not None or self._control is not None:
            self.early.take(self._control)

    @property
    def joined(self) -> bool:
        """Whether a game was interrupted for a new person, and is to be played on."""
        return self._control is not None and self._control.joined

    @contextmanager
    def keeping(self, command: str) -> Iterator[None]:
        """Tell how to go on with a joined game if the robot does not come on again.

        Nobody else joins meanwhile.

        Args:
            command: the command that resumes it.
        """
        if self._control is not None:
            self._control.admit_no_more()
        try:
            yield
        except BaseException:
            if self.joined:
                self._write(kept_words(command))
            raise

    @property
    def policy(self) -> Policy:
        """The policy of the last game, which staff may have taught.

        Raises:
            ValueError: no game has begun.
        """
        if self._control is None:
            raise ValueError("no game has begun")
        return self._control.supervision.policy

    def play(
        self, supervision: Supervision, world: LiveWorld, past: PastGame | None = None
    ) -> bool:
        """Play, up to a game that a person joins; return whether none stopped early.

        Args:
            supervision: runs the games.
            world: the robot's world, switched on.
            past: an interrupted game to resume first.
        """
        from tangy_tui.app.game_commands import StopRobot
        from tangy_tui.app.joining import Admission, carry_over, resume_joined
        from tangy_tui.verbs.playing import staff_lines

        before = self._control
        if before is not None and self._world is not None:
            past = resume_joined(self._workspace, world.played_in)
            carry_over(self._world, world)
        control, lines = staff_lines(
            self._workspace,
            supervision,
            self._by,
            robot=world,
            past=past,
            typed=self._typed,
            before=self._lines,
            ahead=self._ahead,
        )
        if before is not None:
            control.follow(before)
        elif self.early.stopped:
            control.apply(StopRobot())
        self.early.stopped = False
        control.admission = Admission(self._workspace, world)
        self._control, self._lines, self._world = control, lines, world
        fine = lines.run(self._left)
        self._left -= lines.played
        return fine
